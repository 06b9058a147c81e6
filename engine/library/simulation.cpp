#include "engine/library/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <new>
#include <type_traits>
#include <variant>

#include "engine/errors.hpp"
#include "engine/output/output.hpp"
#include "engine/run/make_row.hpp"
#include "engine/run/pause.hpp"
#include "engine/run/run.hpp"
#include "engine/run/threads.hpp"
#include "engine/scene/read_scene.hpp"
#include "engine/step/step.hpp"
#include "mpmfast_version.hpp"

namespace mpmfast {

namespace {

/// Runs f; what it throws becomes an Error.
template <class F>
decltype(auto) said(F f) {
  try {
    return f();
  } catch (const SceneError& error) {
    throw Error(Error::Kind::scene, error.what());
  } catch (const RunFailure& error) {
    throw Error(Error::Kind::failure, error.what());
  } catch (const FileError& error) {
    throw Error(Error::Kind::file, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    throw Error(Error::Kind::file, error.what());
  } catch (const std::bad_alloc&) {
    throw Error(Error::Kind::failure, "out of memory");
  }
}

[[noreturn]] void refuse(const std::string& what) { throw Error(Error::Kind::misuse, what); }

int checked_threads(int threads) {
  if (threads < 0 || threads > kMostThreads)
    refuse(fmt::format("not a number of threads (1 to {}, or 0: OMP_NUM_THREADS or the cores), got {}",
                       kMostThreads, threads));
  return threads;
}

std::vector<std::string> texts_of(const std::vector<Diagnostic>& found) {
  std::vector<std::string> out;
  for (const Diagnostic& warning : found) out.push_back(warning.warning());
  return out;
}

/// The components of a quantity in the order of its columns.
std::vector<std::string_view> component_names(int components) {
  switch (components) {
    case 1:
      return {""};
    case 2:
      return {"x", "y"};
    case 3:
      return {"x", "y", "z"};
    case 6:
      return {"xx", "yy", "zz", "xy", "yz", "xz"};
    default:
      return {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
  }
}

/// Four numbers are a tensor in the plane, which is not the same for a symmetric one with its zz.
template <int Dim>
std::vector<std::string_view> component_names(Quantity quantity) {
  const int components = Particles<Dim>::components(quantity);
  if (components != 4) return component_names(components);
  const bool symmetric = quantity == Quantity::kirchhoff_stress || quantity == Quantity::elastic_strain;
  if (symmetric) return {"xx", "yy", "zz", "xy"};
  return {"xx", "xy", "yx", "yy"};
}

struct NamedColumn {
  std::string name;
  Quantity quantity;
  int component;
};

template <int Dim>
std::vector<NamedColumn> named_columns(const Particles<Dim>& particles) {
  std::vector<NamedColumn> out;
  for (const Quantity quantity : particles.quantities()) {
    const std::string_view name = kQuantityTable[static_cast<std::size_t>(quantity)].name;
    int k = 0;
    for (const std::string_view component : component_names<Dim>(quantity))
      out.push_back(
          {component.empty() ? std::string(name) : fmt::format("{}.{}", name, component), quantity, k++});
  }
  return out;
}

}  // namespace

class Simulation::Implementation {
 public:
  template <class F>
  decltype(auto) visit(F f) {
    return std::visit([&](auto& s) -> decltype(auto) { return f(*s); }, step);
  }
  template <class F>
  decltype(auto) visit(F f) const {
    return std::visit([&](const auto& s) -> decltype(auto) { return f(std::as_const(*s)); }, step);
  }

  Implementation(Scene read, const std::vector<Diagnostic>& found, int thread_count)
      : scene(std::move(read)), warnings(texts_of(found)), threads(thread_count) {
    const ThreadCount count(threads);
    if (scene.dimension() == 2) {
      step.emplace<std::unique_ptr<Step<2>>>(std::make_unique<Step<2>>(scene));
    } else {
      step.emplace<std::unique_ptr<Step<3>>>(std::make_unique<Step<3>>(scene));
    }
    first_dt = visit([](auto& s) { return s.stable_dt(); });
    visit([&]<int Dim>(Step<Dim>& s) {
      names = named_columns(s.state().particles);
      counters.emplace<RunCounters<Dim>>(scene).last_sums = s.sums();
    });
  }

  const NamedColumn& find(std::string_view name) const {
    const auto found =
        std::find_if(names.begin(), names.end(), [&](const auto& column) { return column.name == name; });
    if (found == names.end()) refuse(fmt::format("no column '{}' in this scene", name));
    return *found;
  }

  void advance(double dt, bool stresses = true) {
    try {
      visit([&](auto& s) { s.advance(dt, stresses); });
    } catch (...) {
      find_stresses();  // of the half-made step that its caller may read
      throw;
    }
    last_dt = dt;
  }

  void find_stresses() {
    visit([](auto& s) { s.find_stresses(); });
  }

  /// A step as the run takes it.
  void advance_towards(double time, bool stresses = true) {
    advance(visit([&](auto& s) { return s.dt_towards(time, first_dt); }), stresses);
  }

  Scene scene;  ///< stays where it is: the step points to it
  std::variant<std::unique_ptr<Step<2>>, std::unique_ptr<Step<3>>> step;
  std::variant<std::monostate, RunCounters<2>, RunCounters<3>> counters;  ///< of the history's last row
  std::vector<NamedColumn> names;
  std::vector<std::string> warnings;
  int threads = 0;
  double first_dt = 0;  ///< s
  double last_dt = 0;   ///< s
};

Simulation::Simulation(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Simulation::Simulation(const std::filesystem::path& scene, const Settings& settings, int threads)
    : implementation_(said([&] {
        std::vector<Diagnostic> found;
        Scene read = read_scene(scene, settings, &found);
        return std::make_unique<Implementation>(std::move(read), found, checked_threads(threads));
      })) {}

Simulation Simulation::from_text(const std::string& yaml, const std::filesystem::path& folder,
                                 const Settings& settings, int threads) {
  return said([&] {
    std::vector<Diagnostic> found;
    Scene read = parse_scene(yaml, folder / "scene.yaml", settings, &found);
    return Simulation(std::make_unique<Implementation>(std::move(read), found, checked_threads(threads)));
  });
}

Simulation::Implementation& Simulation::there() const {
  if (!implementation_) refuse("this simulation was moved to another one");
  return *implementation_;
}

int Simulation::dimension() const { return there().scene.dimension(); }
double Simulation::end() const { return there().scene.time.end; }
bool Simulation::finished() const { return has_ended(time(), end()); }
const std::vector<std::string>& Simulation::warnings() const { return there().warnings; }
const std::string& Simulation::resolved_scene() const { return there().scene.resolved_yaml; }

std::size_t Simulation::particles() const {
  return there().visit([](const auto& s) { return s.state().particles.size(); });
}

double Simulation::time() const {
  return there().visit([](const auto& s) { return s.state().time; });
}

std::uint64_t Simulation::steps() const {
  return there().visit([](const auto& s) { return static_cast<std::uint64_t>(s.state().step); });
}

double Simulation::stable_dt() const {
  return there().visit([](const auto& s) { return s.stable_dt(); });
}

void Simulation::advance(double dt) {
  Implementation& i = there();
  if (!(dt > 0) || !std::isfinite(dt)) refuse(fmt::format("a time step must be positive, got {}", dt));
  const ThreadCount count(i.threads);
  said([&] { i.advance(dt); });
}

double Simulation::step() {
  if (finished()) return 0;
  Implementation& i = there();
  const ThreadCount count(i.threads);
  said([&] { i.advance_towards(end()); });
  return i.last_dt;
}

std::uint64_t Simulation::advance_to(double time, const std::function<bool()>& stop) {
  Implementation& i = there();
  if (!std::isfinite(time)) refuse(fmt::format("a time to advance to must be finite, got {}", time));
  const std::uint64_t before = steps();
  const ThreadCount count(i.threads);
  Pause asking;
  said([&] {
    const auto is_stopped = [&] {
      if (!stop || !asking.due()) return false;
      i.find_stresses();  // for whom it asks
      return stop();
    };
    while (!has_ended(this->time(), time) && !is_stopped()) i.advance_towards(time, false);
    i.find_stresses();
  });
  return steps() - before;
}

std::vector<std::string> Simulation::columns() const {
  std::vector<std::string> out;
  for (const NamedColumn& column : there().names) out.push_back(column.name);
  return out;
}

bool Simulation::has_column(std::string_view name) const {
  const auto& names = there().names;
  return std::any_of(names.begin(), names.end(), [&](const auto& column) { return column.name == name; });
}

std::span<const double> Simulation::column(std::string_view name) const {
  const NamedColumn& column = there().find(name);
  return there().visit([&](const auto& s) {
    const auto& particles = s.state().particles;
    return std::span<const double>(particles.column(column.quantity, column.component), particles.size());
  });
}

std::string Simulation::unit(std::string_view name) const {
  return std::string(kQuantityTable[static_cast<std::size_t>(there().find(name).quantity)].unit);
}

std::span<const std::uint32_t> Simulation::ids() const {
  return there().visit([](const auto& s) {
    return std::span<const std::uint32_t>(s.state().particles.id().data(), s.state().particles.size());
  });
}

std::span<const std::uint16_t> Simulation::bodies() const {
  return there().visit([](const auto& s) {
    return std::span<const std::uint16_t>(s.state().particles.body().data(), s.state().particles.size());
  });
}

std::vector<std::string> Simulation::body_names() const {
  std::vector<std::string> out;
  for (const BodySpec& body : there().scene.bodies) out.push_back(body.name);
  return out;
}

void Simulation::add_velocity(int axis, std::span<const double> change) {
  if (axis < 0 || axis >= dimension()) refuse(fmt::format("no axis {} in {} dimensions", axis, dimension()));
  if (change.size() != particles())
    refuse(fmt::format("{} changes of velocity for {} particles", change.size(), particles()));
  if (!std::all_of(change.begin(), change.end(), [](double v) { return std::isfinite(v); }))
    refuse("a change of velocity is not finite");
  there().visit([&](auto& s) { s.add_velocity(axis, change); });
}

Energies Simulation::energies() {
  Implementation& i = there();
  const ThreadCount count(i.threads);
  return said([&] {
    return i.visit([&](auto& s) {
      HistoryRow row;
      fill_particle_sums(s.state().particles, i.scene, row);
      const auto& sums = s.sums();
      return Energies{row.kinetic,        s.stored_energy(),
                      sums.friction_work, s.dissipated_energy() + sums.interface_loss,
                      sums.boundary_work, sums.body_force_work};
    });
  });
}

std::vector<std::string> Simulation::history_columns() const {
  return mpmfast::history_columns(there().scene);
}

std::vector<double> Simulation::history() {
  Implementation& i = there();
  const ThreadCount count(i.threads);
  return said([&] {
    return i.visit([&]<int Dim>(Step<Dim>& s) {
      return history_numbers(make_row(s, i.scene, i.last_dt, std::get<RunCounters<Dim>>(i.counters)),
                             i.scene);
    });
  });
}

std::string Simulation::checksum() const {
  return there().visit([](const auto& s) { return mpmfast::checksum(s.state().particles); });
}

std::string run(const std::filesystem::path& scene, const std::filesystem::path& folder,
                const Settings& settings, bool force, int threads, const Callbacks& callbacks) {
  return said([&] {
    RunOptions options;
    options.threads = checked_threads(threads);
    std::vector<Diagnostic> found;
    const Scene read = read_scene(scene, settings, &found);
    options.scene_warnings = texts_of(found);
    options.folder = folder;
    options.force = force;
    options.command = "library";
    options.stop = callbacks.stop;
    options.warn = [&](const std::string& text) {
      if (callbacks.warn) callbacks.warn(text);
    };
    for (const auto& [path, text] : settings) options.overrides.push_back(path + "=" + text);
    for (const std::string& warning : options.scene_warnings) options.warn(warning);
    const RunSummary summary = run_scene(read, options);
    for (const RunWarning& warning : run_warnings(summary)) options.warn(warning.text);
    std::ifstream json(folder / "run.json");
    return std::string(std::istreambuf_iterator<char>(json), {});
  });
}

void use_quiet_threads(char** arguments) { wait_quietly(arguments); }

std::string version() { return kVersion; }

}  // namespace mpmfast
