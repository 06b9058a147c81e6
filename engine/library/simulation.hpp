#pragma once

/// @file mpmfast as a library: load a scene, step, read the particles. The one header that is installed; it
/// needs nothing but the standard library, and changes only with the version (before 1.0 the minor one).
///
/// Any number of simulations may live side by side, each used by one thread at a time; results are the same
/// to the bit on any number of threads. What the library throws is an Error.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#define MPMFAST_API __attribute__((visibility("default")))

namespace mpmfast {

/// What goes wrong, with the message that the program would print.
class MPMFAST_API Error : public std::runtime_error {
 public:
  /// As the exit codes of the program; misuse: a call that makes no sense, such as for a column that is not
  /// there.
  enum class Kind { misuse = 1, scene = 2, failure = 3, file = 4 };
  Error(Kind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// Dotted path of a scene and the text that replaces what stands there, as --set PATH=TEXT.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// What a caller hears of a run while it goes on, and may say; each may be empty. They are called by the
/// thread that called the run, and what they throw ends it.
struct Callbacks {
  /// Asked between steps, every 50 ms at most: true stops it.
  std::function<bool()> stop;
  /// Told what in the scene is likely a mistake, and in the end what of the run is worth a second look.
  std::function<void(const std::string&)> warn;
};

/// Where the energy is, J; in 2-D of the scene's thickness. What was dissipated and worked counts from the
/// start.
struct Energies {
  double kinetic{}, stored{};
  double friction{};    ///< heat of contact
  double dissipated{};  ///< plastic work, viscous heat and what bonds of surfaces lost
  double boundary_work{}, body_force_work{};
};

/// A scene that is stepped by its caller and writes no files. Everything is SI. Spans show the memory of the
/// simulation itself; they hold until the next step, which may sort the particles anew, and no longer than
/// the simulation: copy what is to be kept. One thread at a time may use a simulation, also to read it. One
/// that was moved from can be assigned to and destroyed, every other call of it throws.
class MPMFAST_API Simulation {
 public:
  /// Reads the scene and seeds its particles. Throws Error.
  /// @param threads  for its steps; 0: OMP_NUM_THREADS or the cores
  explicit Simulation(const std::filesystem::path& scene, const Settings& settings = {}, int threads = 0);
  /// The same from text; relative paths in it count from `folder`.
  static Simulation from_text(const std::string& yaml, const std::filesystem::path& folder = ".",
                              const Settings& settings = {}, int threads = 0);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  int dimension() const;
  std::size_t particles() const;
  double time() const;  ///< s
  double end() const;   ///< s, of the scene
  std::uint64_t steps() const;
  double stable_dt() const;  ///< s, of the next step
  /// Is the end reached? The last step may miss it by round-off.
  bool finished() const;
  /// What in the scene is likely a mistake, a line each, as `mpmfast check` says it.
  const std::vector<std::string>& warnings() const;

  /// The next step that `mpmfast run` would take towards end(), to the bit; returns its dt, s. Where the
  /// scene is finished() it does nothing and returns 0.
  double step();
  /// One step of dt, at most stable_dt() where it is to stay stable. Throws Error.
  void advance(double dt);
  /// As many steps as it takes to get to `time`, as `mpmfast run --until` would take them; returns how many.
  /// The last one or two are cut to meet it: a way in several parts has other steps than one that goes to the
  /// end.
  /// @param stop  asked between steps, every 50 ms at most: true ends it there; may be empty
  std::uint64_t advance_to(double time, const std::function<bool()>& stop = {});

  /// Names of the columns: velocity.x, kirchhoff_stress.xy, mass … What a scene does not need is not there.
  /// deformation_gradient is that of domains: F times initial_deformation, the angle at which each lay at the
  /// start, where the scene has that column.
  std::vector<std::string> columns() const;
  bool has_column(std::string_view name) const;
  /// One number a particle. Throws for a column that is not there.
  std::span<const double> column(std::string_view name) const;
  /// Unit of a column: m/s, Pa, kg …
  std::string unit(std::string_view name) const;
  /// A particle keeps its number while the columns are sorted.
  std::span<const std::uint32_t> ids() const;
  /// Of each particle, into body_names().
  std::span<const std::uint16_t> bodies() const;
  std::vector<std::string> body_names() const;

  /// For what acts on the particles from outside: adds to their velocities along an axis (0, 1, 2), one
  /// number a particle in the order of the columns. The energy counts as work of body forces; rigid bodies do
  /// not mind. Throws for a wrong axis, length or a number that is not finite.
  void add_velocity(int axis, std::span<const double> change);

  Energies energies();
  /// The columns of history.csv: forces of boundaries, rigid bodies and contact pairs, means of bodies,
  /// energies …
  std::vector<std::string> history_columns() const;
  /// The row of history.csv as it would stand now, a number a column. Forces are means since the last call
  /// (at first since the start), so that they are those of the caller's own interval.
  std::vector<double> history();
  /// Of the particles' state, as `checksum` in run.json.
  std::string checksum() const;
  /// The scene with every default, as scene.yaml.
  const std::string& resolved_scene() const;

  /// Hidden: what a change of it must not touch is compiled elsewhere.
  class Implementation;

 private:
  explicit Simulation(std::unique_ptr<Implementation> implementation);
  Implementation& there() const;
  std::unique_ptr<Implementation> implementation_;
};

/// Runs a scene as `mpmfast run` does and writes its folder. Returns run.json's text. Throws Error.
/// @param force    replaces the run in a folder that is there
/// @param threads  0: OMP_NUM_THREADS or the cores
/// @param callbacks  a run that `stop` ended has a checkpoint, and in run.json the status "stopped"
MPMFAST_API std::string run(const std::filesystem::path& scene, const std::filesystem::path& folder,
                            const Settings& settings = {}, bool force = false, int threads = 0,
                            const Callbacks& callbacks = {});

/// For the first line of main, with its argv. Threads of libgomp that wait spin for long, which makes a
/// program many times slower where others want the cores, and libgomp reads its settings before main: unless
/// OMP_WAIT_POLICY or GOMP_SPINCOUNT is set, this sets a short spin and starts the program again. Whoever
/// cannot call it sets one of the two before the program starts.
MPMFAST_API void use_quiet_threads(char** arguments);

/// "0.2.0"
MPMFAST_API std::string version();

}  // namespace mpmfast
