#pragma once

/// @file Everything a run leaves behind (design §4): history.csv, particle series, pictures, run.json.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/output/descriptor.hpp"
#include "engine/output/folder_lock.hpp"
#include "engine/output/lines.hpp"
#include "engine/output/overlap.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/outflow.hpp"
#include "engine/state/particles.hpp"

namespace mpmfast {

/// Prepares the output folder: refuses an existing one without `force` (SceneError-free; throws FileError),
/// with `force` removes what an earlier run of ours left there, the pictures that `mpmfast plot` made of it
/// and report.html, and nothing else: not the scripts of charts (.gp), which are there to be edited. Writes
/// scene.yaml. What it returns holds the folder: refuses one in which a run goes on, with `force` too.
FolderLock prepare_folder(const std::filesystem::path& folder, const Scene& scene, bool force);

/// The charts of `mpmfast plot`.
inline constexpr std::array<std::string_view, 6> kChartStems{
    "plot_energy", "plot_momentum", "plot_stress", "plot_force", "plot_stress_strain", "plot_columns"};

/// What a run leaves when it ends (run.json) or is killed (files half written) must not stay beside one that
/// goes on. Throws FileError.
void reopen_folder(const std::filesystem::path& folder);

/// What one row of history.csv says. Energies in J, per `thickness` in 2-D.
struct HistoryRow {
  std::uint64_t step{};
  double time{}, dt{};
  double kinetic{}, stored{}, friction{}, boundary_work{}, body_force_work{};
  double dissipated{};   ///< plastic work and viscous heat
  double interface = 0;  ///< J, lost by bonds that soften and break
  double joints{};       ///< J, of `stored`: what springs and bonds between surfaces hold
  Vec3 momentum{};
  std::array<double, 6> mean_stress{};  ///< Pa, as Body::mean_stress, over all bodies that deform
  struct Body {
    std::array<double, 6> mean_stress{};  ///< Pa, Cauchy, xx yy zz xy yz xz, weighted by current volume
    double mass = 0;
    Vec3 position{}, velocity{};  ///< of the centre of mass
    double temperature{};         ///< K, weighted by mass, in scenes with heat
  };
  std::vector<Body> bodies;           ///< as Scene::bodies
  std::vector<Vec3> boundary_force;   ///< N, on the material, mean over the interval; as Scene::boundaries
  std::vector<Vec3> rigid_force;      ///< N, on the rigid body by contact; as Scene::bodies (zero for others)
  std::vector<Vec3> rigid_moment;     ///< N m, likewise, about the body's pivot
  std::vector<Vec3> pair_force;       ///< N, on the first of the two; as ContactSpec::pairs
  std::vector<double> pair_friction;  ///< J; as ContactSpec::pairs
  std::vector<double> pair_area;      ///< m², of surfaces that press, at the time of the row; likewise
  std::optional<Overlap> overlap;     ///< with output.overlap
  std::vector<double> crack_lengths;  ///< m, up to where bonds soften
  std::vector<std::array<double, 5>> tips;  ///< of cracks: place, m, J, J/m², K_I, K_II, Pa √m; as crack_tips
  std::optional<Outflow> outflow;           ///< with grid.leaving: outflow; up to now
  struct Heat {
    double content{};                ///< J, of the bodies that deform above the temperature of the scene
    double in{};                     ///< J, that came in from faces, given nodes and rigid bodies
    double friction{};               ///< J, that friction made in them
    double worked{};                 ///< J, that became elastic energy by thermal expansion
    std::vector<double> conditions;  ///< J, that came in, as HeatSpec::conditions
  };
  std::optional<Heat> heat;  ///< in scenes with heat; up to now
};

/// Sums over particles of one row: kinetic energy, momentum, means (stored energy is the caller's). Bitwise
/// the same for any order of the particles. Rigid bodies have means, but no share in the kinetic energy and
/// momentum.
template <int Dim>
void fill_particle_sums(const Particles<Dim>& particles, const Scene& scene, HistoryRow& row);

/// Do the particles of a body leave each other by its law, as grains and fluids do? F then says nothing about
/// neighbours.
bool flows(const Scene& scene, const BodySpec& body);

/// The largest distance between neighbouring particles of one body, from their F.
struct Spacing {
  double cells{};
  std::uint64_t body{};  ///< into Scene::bodies
};
template <int Dim>
Spacing widest_spacing(const Particles<Dim>& particles, const Scene& scene);

/// The header of history.csv.
std::vector<std::string> history_columns(const Scene& scene);
/// A row of it, as many numbers.
std::vector<double> history_numbers(const HistoryRow& row, const Scene& scene);

/// How far a history has come, and which one it is.
struct HistoryMark {
  std::uint64_t rows{};                         ///< without the header
  std::uint64_t last_step = ~std::uint64_t{0};  ///< of the last row
  std::string hash;                             ///< XXH3-128 of header and rows, as hexadecimal text
};

class Hash128;

/// history.csv: whole up to its last row whenever the run ends, on a full disk too. It belongs to one process
/// at a time. Everything throws FileError.
class HistoryFile {
 public:
  /// With a header and no row yet.
  HistoryFile(const std::filesystem::path& folder, const Scene& scene);
  /// The one that is there, cut to the mark: up to it, it must be to the byte what was written then.
  HistoryFile(const std::filesystem::path& folder, const Scene& scene, const HistoryMark& mark);
  ~HistoryFile();
  void append(const HistoryRow& row);
  HistoryMark mark() const;
  /// Waits until the disk has it.
  void sync() const;

 private:
  void claim() const;
  void check_there() const;
  void append_line(std::string_view line);

  std::filesystem::path path_;
  Descriptor file_;
  const Scene* scene_;
  std::uint64_t size_ = 0;  ///< bytes
  HistoryMark mark_;        ///< without the hash
  std::unique_ptr<Hash128> hash_;
};

/// NAME.pvd and NAME/NNNNNN.vtu: the files of a series, numbered without gaps, and the list that ParaView
/// opens.
class FrameSeries {
 public:
  /// @param times  of the frames that are there already; later ones are removed
  FrameSeries(const std::filesystem::path& folder, std::string name, std::vector<double> times = {});
  /// Where the next frame goes.
  std::filesystem::path next() const;
  /// Lists the frame that has been written there.
  void add(double time);
  const std::vector<double>& times() const { return times_; }

 private:
  std::filesystem::path file(std::size_t number) const;
  void list() const;

  std::filesystem::path folder_;
  std::string name_;
  std::vector<double> times_;  ///< s, of each frame
};

/// particles.pvd and particles/NNNNNN.vtu: appended raw, zlib level 1, vertex cells, TimeValue in each file.
template <int Dim>
class ParticleSeries {
 public:
  ParticleSeries(const std::filesystem::path& folder, const Scene& scene, std::vector<double> times = {})
      : series_(folder, "particles", std::move(times)), scene_(&scene) {}
  /// @param lines  cracks, in the plane: `crack_points` and `crack_lengths` (points of each) of the file
  void append(const Particles<Dim>& particles, double time, const Polylines& lines = {});
  const std::vector<double>& times() const { return series_.times(); }

 private:
  FrameSeries series_;
  const Scene* scene_;
};

/// One VTU file with all that a frame has of the particles around a place. Written aside and renamed.
/// @param places  of the particles, in their order, m: finite, also where a position is not
/// @param reach   m, along each axis
template <int Dim>
void write_neighbourhood(const std::filesystem::path& vtu, const Particles<Dim>& particles,
                         const Scene& scene, const std::vector<Vec<Dim>>& positions, const Vec<Dim>& centre,
                         double reach, double time);

/// Draws the particles (true deformed parallelograms in 2-D; a shaded projection of points in 3-D) coloured
/// by `field` (one of field_names) to a PNG with title, equal axes, and a colour bar with units. Throws
/// std::invalid_argument for a field that there is not.
/// @param lines  drawn over them, in the plane: cracks
template <int Dim>
void draw_particles(const std::filesystem::path& png, const Particles<Dim>& particles, const Scene& scene,
                    const std::string& field, double time, const Polylines& lines = {});

/// XXH3-128 over the particle state (all columns, ordered by id), as hexadecimal text. Independent of sort
/// order.
template <int Dim>
std::string checksum(const Particles<Dim>& particles);

/// XXH3-128 over every column as it lies, before the first sort: what a scene seeded.
template <int Dim>
std::string seeding_hash(const Particles<Dim>& particles);

/// XXH3-128 of a text.
std::string text_hash(const std::string& text);

/// The content of run.json.
struct RunSummary {
  std::string scene_name, status = "finished", reason;
  std::string failed_by;  ///< of a run that failed: physics, files or program
  HistoryMark history;    ///< what history.csv holds
  int dimension = 2, threads = 1;
  std::uint64_t particles{}, fields{}, nodes_active_peak{}, steps{};
  double time{}, dt_min{}, dt_max{}, wall{}, particle_steps_per_second{};
  std::uint64_t peak_memory_bytes{};
  std::vector<std::pair<std::string, double>> seconds;  ///< by pass name
  struct Contact {
    std::uint64_t nodes_peak = 0, regressions = 0, fallbacks = 0, unconverged = 0;
    double mean_iterations = 0;
    std::uint64_t touching{}, doubtful{};          ///< as ContactCounters
    std::uint64_t pair_nodes{}, pair_fallbacks{};  ///< with fields: pairs
    std::uint64_t meetings{}, screened{};          ///< as ContactCounters
    std::uint64_t points_peak{};                   ///< of surfaces that press, with penalty contact
  } contact;
  double energy_error{};
  /// What of the scene decides which remedies are left.
  struct Settings {
    bool averaged_strain = false;  ///< method.strain: average
    bool grid_end = true;          ///< method.position
    bool filtered = false;         ///< method.update: another one than flip
    bool volume_screen = false;    ///< contact.volume_screen drops nodes
    double cfl = 0.5;              ///< time.cfl
    bool follows_shape = false;    ///< method.basis: domains follow F
    bool splits = false;           ///< particles whose domains grow long are split
    std::string flowing_body;      ///< the first whose law flows
  } settings;
  double spacing{};                ///< cells; the widest of the history's rows
  double most_spacing = 1;         ///< cells that the basis bridges
  std::uint64_t third_cracks{};    ///< times that a node was seen behind a third crack
  std::string spacing_body;        ///< where it was
  std::optional<Overlap> overlap;  ///< of the last row of the history, with output.overlap
  std::optional<Outflow> outflow;  ///< with grid.leaving: outflow
  struct Splits {
    std::uint64_t splits = 0;  ///< of particles in two
    std::uint64_t held = 0;    ///< edges that are too long and were halved as often as they may be
  };
  std::optional<Splits> splits;  ///< with method.split
  std::string checksum;
  std::string command;                      ///< the command line
  std::vector<std::string> overrides;       ///< --set arguments
  std::vector<std::string> scene_warnings;  ///< what in the scene is likely a mistake
  std::uint64_t resumes{};                  ///< how often the run went on from a checkpoint
  std::string resolved_yaml;                ///< Scene::resolved_yaml, of which run.json holds the hash
};

// Beyond these a run is worth a second look; the compaction of the ellipses stays below the shares by a
// factor of four.
inline constexpr double kMostUnconverged = 0.01;  ///< of the regressions
/// Of the normals of surfaces that touch or overlap. configs/hard/grains.yaml has 3.9 %, and its stress ends
/// 23 % below that with --set "grid.cell=1/24 mm", which has 0.55 %.
inline constexpr double kMostDoubtful = 0.02;
inline constexpr double kMostPairFallbacks = 0.05;  ///< of the nodes that solve pairs
inline constexpr double kMostScreened = 0.2;        ///< of the nodes where fields meet
inline constexpr double kMostDrift = 0.1;           ///< of the energy at work
inline constexpr double kPartedBy = 1.1;            ///< times what the basis bridges, between particles
/// Fewer normals, pairs or meetings than this say nothing yet: the first touch of two bodies is all edges.
inline constexpr std::uint64_t kEnoughToJudge = 1000;

/// What the figures of a run give reason to doubt: a sentence with the figure and a way out.
struct RunWarning {
  std::string_view about;  ///< the same for all warnings of its kind
  std::string text;
};
std::vector<RunWarning> run_warnings(const RunSummary& summary);
/// Those of the scene and then those of the figures; of a run that failed the likeliest cause first.
std::vector<std::string> all_warnings(const RunSummary& summary);
/// Written aside and renamed.
void write_run_json(const std::filesystem::path& folder, const RunSummary& summary);

/// What this program was built from, as run.json says it: a study's run counts only for the program that made
/// it.
struct ProgramIdentity {
  const char* version;
  const char* git;
  const char* compiler;
  const char* flags;
};
ProgramIdentity program_identity();
/// The same as text.
std::string program_text();

/// The largest resident set of this process since reset_peak_memory(), bytes; where the system forgets
/// nothing, since it began.
std::uint64_t peak_memory_bytes();
void reset_peak_memory();

}  // namespace mpmfast
