// Whole runs, in short, against figures that are recorded in tests/recorded/runs.txt: nothing that moves
// particles may change unnoticed. Every scene of configs/, and small ones of tests/recorded/ for what those
// leave out. Where a result is to change, MPMFAST_RECORD=FILE validation_tests
// --source-file=*/recorded_runs.cpp writes all figures anew, and says which of them hang on round-off. A line
// is a figure and, behind it, the scale that it is compared by.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "engine/contact/pairs/pair_memory.hpp"
#include "engine/run/make_row.hpp"
#include "tests/forged.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Of a figure's scale, which is what it is the sum of by its absolute values, or the round-off of it times
/// 1e9 and more.
constexpr double kTolerance = 1e-9;
/// What round-off at the start of a run may make of it, or the run is too long or hangs on a tie.
constexpr double kSteady = 1e-10;

struct Figure {
  std::string name;
  double value, scale;
};

struct Record {
  std::vector<Figure> figures;
  std::string failure;  ///< what a run that failed says
};

/// A number of [0, 1) that belongs to a whole one.
double weight(std::uint64_t n, std::uint64_t of = 0) {
  std::uint64_t x = (n + 1) * 0x9e3779b97f4a7c15 + of * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 31)) * 0x94d049bb133111eb;
  return static_cast<double>((x ^ (x >> 29)) >> 11) * 0x1p-53;
}

/// Up to about `size` a number as it is, but never more: what a force would do to a node of hardly any mass
/// has as few digits as that mass.
double bounded(double x, double size) { return x / (1 + std::abs(x) / size); }

/// Sizes of a scene, for the scale of what may be zero but for round-off.
struct Sizes {
  double length = 0, cell = 0;  ///< m: of the grid, of a cell
  double mass = 0;              ///< kg, of what deforms
  double wave = 0, speed = 0;   ///< m/s, means by mass
  double modulus = 0;           ///< Pa
  double time = 0;              ///< s
  double temperature = 300;     ///< K

  double energy() const { return 1e-5 * mass * wave * wave; }
  double momentum() const { return mass * (speed + 1e-5 * wave); }
  double force() const { return momentum() / time + 1e-5 * mass * wave * wave / cell; }
  double velocity() const { return speed + 1e-5 * wave; }
  double stress() const { return 1e-5 * modulus; }
};

template <int Dim>
Sizes sizes_of(const Step<Dim>& step, const Scene& scene) {
  const auto& state = step.state();
  const auto& particles = state.particles;
  Sizes s;
  s.cell = scene.grid.cell;
  for (int d = 0; d < Dim; ++d) {
    const auto k = static_cast<std::size_t>(d);
    s.length = std::max({s.length, std::abs(scene.grid.origin[k]), scene.grid.size[k]});
  }
  s.time = state.time > 0 ? state.time : 1;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (state.bodies[particles.body()[p]].rigid) continue;
    const double m = particles.column(Quantity::mass)[p], c = particles.column(Quantity::wave_speed)[p];
    s.mass += m;
    s.wave += m * c;
    s.speed += m * particles.vector(Quantity::velocity, p).norm();
    s.modulus = std::max(s.modulus, m * c * c / particles.column(Quantity::initial_volume)[p]);
  }
  if (s.mass > 0) s.wave /= s.mass, s.speed /= s.mass;
  return s;
}

/// What a particle's quantity is at least compared by.
double least_scale(Quantity q, const Sizes& s) {
  switch (q) {
    case Quantity::velocity:
      return s.velocity();
    case Quantity::kirchhoff_stress:
    case Quantity::dissipated_energy:
    case Quantity::internal_energy:
      return s.stress();
    case Quantity::velocity_slopes:
      return s.velocity() / s.cell;
    case Quantity::temperature_slope:
      return 1e-5 * s.temperature / s.cell;
    case Quantity::plastic_strain:
      return 1e-5;
    default:
      return 0;
  }
}

template <int Dim>
void list_particles(const Step<Dim>& step, const Sizes& sizes, std::vector<Figure>& out) {
  const auto& particles = step.state().particles;
  const std::size_t n = particles.size();
  out.push_back({"particles", static_cast<double>(n), 0});
  for (const Quantity q : particles.quantities()) {
    double sum = 0, all = 0;
    for (int k = 0; k < Particles<Dim>::components(q); ++k)
      for (std::size_t p = 0; p < n; ++p) {
        const double value = particles.column(q, k)[p];
        sum += weight(particles.id()[p], static_cast<std::uint64_t>(k)) * value;
        all += std::abs(value);
      }
    const double scale = std::max(all, least_scale(q, sizes) * static_cast<double>(n));
    out.push_back({std::string(kQuantityTable[static_cast<std::size_t>(q)].name), sum, scale});
  }
}

bool ends_with(const std::string& text, std::initializer_list<const char*> ends) {
  return std::any_of(ends.begin(), ends.end(), [&](const char* end) { return text.ends_with(end); });
}

/// Columns of the history that are compared by one scale.
std::string kind_of_column(const std::string& name) {
  if (name == "step" || ends_with(name, {"time_s", "dt_s", "outflow_kg"})) return name;
  if (ends_with(name, {".mass_kg"})) return "mass";
  if (name.starts_with("heat_") || ends_with(name, {".heat_J"})) return "heat";
  if (ends_with(name, {"_J"})) return "energy";
  if (name.find("momentum") != std::string::npos) return "momentum";
  if (const auto at = name.find("mean_stress"); at != std::string::npos) return name.substr(0, at) + "stress";
  if (ends_with(name, {"_Nm"})) return "moment";
  if (ends_with(name, {"_N"})) return "force";
  if (ends_with(name, {"_Pa_sqrt_m"})) return "intensity";
  if (ends_with(name, {"_m"})) return "length";
  if (ends_with(name, {"_m2"})) return "area";
  if (ends_with(name, {".vx", ".vy", ".vz"})) return "velocity";
  if (ends_with(name, {".strain"})) return "strain";
  if (ends_with(name, {"_per_m2"})) return "release";
  return name;
}

double least_scale(const std::string& kind, const Sizes& s) {
  if (kind == "energy" || kind == "heat") return s.energy();
  if (kind == "momentum") return s.momentum();
  if (kind.ends_with("stress")) return s.stress();
  if (kind == "force") return s.force();
  if (kind == "moment") return s.force() * s.length;
  if (kind == "length") return s.length;
  if (kind == "area") return s.cell * s.cell;
  if (kind == "velocity") return s.velocity();
  if (kind == "strain") return 1;
  if (kind == "release") return 1e-6 * s.modulus * s.cell;
  if (kind == "intensity") return 1e-5 * s.modulus * std::sqrt(s.cell);
  return 0;
}

/// Numbers of one kind share a scale.
/// @param joined  all but energies are added up by kind
void list_by_kind(const std::vector<std::string>& names, const std::vector<double>& numbers,
                  const Sizes& sizes, bool joined, std::vector<Figure>& out) {
  std::map<std::string, double> scales, sums;
  const auto kinds = [&](std::size_t k) { return kind_of_column(names[k]); };
  for (std::size_t k = 0; k < names.size(); ++k) {
    double& scale = scales.try_emplace(kinds(k), least_scale(kinds(k), sizes)).first->second;
    scale = std::max(scale, std::abs(numbers[k]));
  }
  for (std::size_t k = 0; k < names.size(); ++k)
    if (!joined || kinds(k) == names[k] || kinds(k) == "energy")
      out.push_back({names[k], numbers[k], scales.at(kinds(k))});
    else
      sums[kinds(k)] += (weight(k) + 0.1) * numbers[k];
  for (const auto& [kind, sum] : sums) out.push_back({"all of " + kind, sum, scales.at(kind)});
}

/// Sums of all real columns that a checkpoint has beside those of the particles.
class Adder final : public Archive {
 public:
  /// @param joined  what the history has is passed over
  Adder(const Sizes& sizes, bool joined, std::vector<Figure>& out)
      : sizes_(sizes), joined_(joined), out_(&out) {}
  bool reading() const override { return false; }

 private:
  bool is_passed_over(const std::string& name) const {
    return (joined_ && name.starts_with("sums/")) || name.starts_with("particles/") ||
           name.starts_with("tiling/") || name == "step/time" || name == "step/number" ||
           name == "step/seconds" || name == "step/sort_due" || name == "contact/keys" ||
           name == "contact/iterations" ||  // which stop by round-off
           name == "contact/fits";          // these name particles by where they lie
  }
  double least(const std::string& name) const {
    const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
    if (has("impulse") || has("momentum")) return sizes_.momentum();
    if (has("moment")) return sizes_.momentum() * sizes_.length;
    if (has("work") || has("energy") || has("loss") || has("stored") || has("heat/")) return sizes_.energy();
    if (has("springs") || has("jumps") || has("stretches")) return 0.01 * sizes_.cell;
    return has("planes") || has("bonds") || has("normals") ? 1 : 0;
  }
  void pass(const std::string& name, NumberKind kind, void* values, std::size_t n) override {
    if (is_passed_over(name)) return;
    double sum = 0, all = 0;
    if (kind == NumberKind::real) {
      for (std::size_t k = 0; k < n; ++k) {
        double value = static_cast<double*>(values)[k];
        if (name == "contact/springs") value = bounded(value, 0.01 * sizes_.cell);
        if (std::isfinite(value)) sum += value, all += std::abs(value);
      }
      out_->push_back({name, sum, std::max(all, static_cast<double>(n) * least(name))});
    } else if (kind == NumberKind::whole64 && n == 1 && name != "walls/stuck") {
      out_->push_back({name, static_cast<double>(*static_cast<std::uint64_t*>(values)), 0});
    } else if (kind == NumberKind::whole8) {
      for (std::size_t k = 0; k < n; ++k) sum += static_cast<std::uint8_t*>(values)[k];
      out_->push_back({name, sum, 0});
    } else {
      out_->push_back({name + " (entries)", static_cast<double>(n), 0});
    }
  }
  std::size_t length(const std::string&) override { return 0; }

  Sizes sizes_;
  bool joined_;
  std::vector<Figure>* out_;
};

/// What the last step knew of contact on its nodes.
template <int Dim>
void list_contact(const Step<Dim>& step, const Sizes& sizes, std::vector<Figure>& out) {
  const auto& list = step.contact_list();
  std::map<std::string, Figure> sums;
  std::uint64_t key = 0;
  double unknown = 0;
  const auto add = [&](const std::string& name, double value, double least) {
    Figure& figure = sums.try_emplace(name, Figure{name, 0, 0}).first->second;
    unknown += !std::isfinite(value);
    if (!std::isfinite(value)) return;
    figure.value += weight(key) * value;
    figure.scale += std::max(std::abs(value), least);
  };
  const auto add_vector = [&](const std::string& name, const Vec<Dim>& v, double least) {
    for (int d = 0; d < Dim; ++d) {
      add(name, v[d], least);
      key += 0x9e3779b97f4a7c15;
    }
  };
  const double speed = sizes.velocity(), cell = sizes.cell;
  const double push = sizes.mass / static_cast<double>(step.state().particles.size()) * speed;
  double touching = 0, stuck = 0, held = 0, acting = 0;
  for (const auto& node : list.nodes)
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const PairColumns<Dim>& pairs = list.pairs;
      const PairStatus& status = pairs.status[e];
      const PairImpulses<Dim>& impulse = pairs.impulse[e];
      key = pair_key(step.state(), list, node, pairs.pair[e]);
      touching += status.touching, stuck += status.stuck, held += status.active_in_first;
      add_vector("entries/normal", pairs.geometry[e].normal, 1);
      add("entries/separation", pairs.geometry[e].separation, cell);
      add("entries/advanced", status.predicted_gap, cell);
      add("entries/closing", status.target_approach, speed);
      add("entries/spring", bounded(status.recovery_length, 0.01 * cell), 0.01 * cell);
      add("entries/friction_work", impulse.friction_work, push * speed);
      add_vector("entries/impulse", impulse.now, push);
      add_vector("entries/first", impulse.first, push);
      add_vector("entries/second", impulse.second, push);
      add_vector("entries/slip_end", Vec<Dim>(-pairs.relative[e].end), speed);
      if (!pairs.spring.empty()) {
        const InterfaceSpring<Dim>& spring = pairs.spring[e];
        acting += spring.acts;
        add_vector("bridges/jump", spring.jump.value, cell);
        add_vector("bridges/impulse", spring.impulse, push);
        add("bridges/own_area", spring.own_area, 0);
        add("bridges/mean_area", spring.mean_area, 0);
      }
      if (!pairs.bond.empty()) {
        const Bond<Dim>& bond = pairs.bond[e];
        add("bonds/way", bond.damage, 1);
        add("bonds/area", bond.area, 0);
        add_vector("bonds/offset", bond.offset, 1);
      }
    }
  out.push_back({"contact nodes", static_cast<double>(list.nodes.size()), 0});
  out.push_back({"contact entries", static_cast<double>(list.pairs.size()), 0});
  if (!list.pairs.fit.empty()) return;  // normals that are kept hang on how far a search for them went
  out.push_back({"entries touching", touching, 0});
  out.push_back({"entries stuck", stuck, 0});
  out.push_back({"entries held", held, 0});
  out.push_back({"entries unknown", unknown, 0});
  out.push_back({"bridges acting", acting, 0});
  for (const auto& [name, figure] : sums) out.push_back(figure);
}

/// What no archive keeps, of the steps before and after.
template <int Dim>
void list_counters(const Step<Dim>& step, const Step<Dim>* before, std::vector<Figure>& out) {
  const auto add = [&](const char* name, const auto& count) {
    out.push_back({name, static_cast<double>(count(step) + (before ? count(*before) : 0)), 0});
  };
  out.push_back({"fields", static_cast<double>(step.state().fields()), 0});
  add("extension nodes", [](const Step<Dim>& s) { return s.extension().counters().nodes; });
  add("extension lowered", [](const Step<Dim>& s) { return s.extension().counters().lowered; });
  add("extension alone", [](const Step<Dim>& s) { return s.extension().counters().alone; });
  out.push_back({"pressed points", static_cast<double>(step.penalty().contact_points()), 0});
}

template <int Dim>
std::vector<Figure> figures_of(Step<Dim>& step, const Step<Dim>* before, const Scene& scene, double dt,
                               RunCounters<Dim>& counters) {
  const bool joined = scene.file.parent_path().filename() == "recorded";
  std::vector<Figure> out;
  const HistoryRow row = make_row(step, scene, dt, counters);
  const Sizes sizes = sizes_of(step, scene);
  list_by_kind(history_columns(scene), history_numbers(row, scene), sizes, joined, out);
  list_particles(step, sizes, out);
  list_contact(step, sizes, out);
  Adder adder(sizes, joined, out);
  step.visit(adder);
  list_counters(step, before, out);
  // Two of these have one scale: what they are sums of.
  for (Figure& figure : out)
    if (figure.name == "step/travelled" || figure.name == "step/unlooked") figure.scale = sizes.length;
  return out;
}

/// Moves the particles of a scene a little, each elsewhere: on their lattice, domains end on lines of the
/// grid and particles of flat faces are equally near, so that round-off would decide what has weight and what
/// is nearest. And sets everything in motion.
template <int Dim>
void disturb(State<Dim>& state, double cell) {
  auto& particles = state.particles;
  const auto sway = [&](std::size_t p, int k) {
    return 2 * weight(particles.id()[p], 20 + static_cast<std::uint64_t>(k)) - 1;
  };
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.has(Quantity::temperature))
      particles.column(Quantity::temperature)[p] *= 1 + 1e-3 * sway(p, 9);
    for (int k = 0; k < Dim; ++k) particles.column(Quantity::position, k)[p] += 0.01 * cell * sway(p, k);
    if (state.bodies[particles.body()[p]].rigid) continue;
    const double c = particles.column(Quantity::wave_speed)[p];
    for (int k = 0; k < Dim; ++k) particles.column(Quantity::velocity, k)[p] += 1e-4 * c * sway(p, Dim + k);
  }
}

/// Places and velocities are off by round-off.
template <int Dim>
void shake(Particles<Dim>& particles) {
  for (const Quantity q : {Quantity::position, Quantity::velocity})
    for (int k = 0; k < Dim; ++k)
      for (std::size_t p = 0; p < particles.size(); ++p)
        particles.column(q, k)[p] *=
            1 + 2e-15 * (2 * weight(particles.id()[p], 7 + static_cast<std::uint64_t>(k)) - 1);
}

/// Energies before the first step.
template <int Dim>
std::vector<Figure> first_figures(Step<Dim>& step, const Scene& scene) {
  RunCounters<Dim> counters(scene);
  counters.last_sums = step.sums();
  const HistoryRow row = make_row(step, scene, 0, counters);
  const double scale = sizes_of(step, scene).energy() + row.kinetic + std::abs(row.stored);
  return {{"kinetic_J 0", row.kinetic, scale},
          {"stored_J 0", row.stored, scale},
          {"dissipated_J 0", row.dissipated, scale}};
}

void append(std::vector<Figure>& figures, const std::vector<Figure>& more) {
  figures.insert(figures.end(), more.begin(), more.end());
}

struct Manner {
  bool handed_over = true;  ///< half-way to another step
  bool shaken = false;
};

template <int Dim>
Record run_steps(const Scene& scene, int steps, const Manner& manner) {
  Record record;
  try {
    Step<Dim> before(scene);
    RunCounters<Dim> counters(scene);
    counters.last_sums = before.sums();
    disturb(before.state(), scene.grid.cell);
    if (manner.shaken) shake(before.state().particles);
    const double first = before.stable_dt();
    record.figures = first_figures(before, scene);
    double dt = 0;
    const auto advance = [&](Step<Dim>& step, int n) {
      for (int k = 0; k < n && !has_ended(step.state().time, scene.time.end); ++k) {
        dt = step.dt_towards(scene.time.end, first);
        step.advance(dt, false);
      }
    };
    advance(before, manner.handed_over ? steps / 2 : steps);
    if (!manner.handed_over) {
      append(record.figures, figures_of<Dim>(before, nullptr, scene, dt, counters));
      return record;
    }
    before.find_stresses();
    Forged kept;
    before.visit(kept);
    kept.rewind();
    Step<Dim> after(scene);
    after.visit(kept);
    advance(after, steps - steps / 2);
    append(record.figures, figures_of<Dim>(after, &before, scene, dt, counters));
  } catch (const RunFailure& failure) {
    record.failure = failure.what();
    record.figures.clear();
  }
  return record;
}

Record run_steps(const Scene& scene, int steps, const Manner& manner = {}) {
  return scene.dimension() == 3 ? run_steps<3>(scene, steps, manner) : run_steps<2>(scene, steps, manner);
}

/// A scene a block: "= name", then "figure: value of scale" or "failure: text"; what is not there is zero.
std::map<std::string, Record> read_records() {
  std::map<std::string, Record> records;
  std::ifstream file(source_folder() / "tests" / "recorded" / "runs.txt");
  Record* record = nullptr;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("= ")) {
      record = &records[line.substr(2)];
      continue;
    }
    const std::size_t colon = line.rfind(": ");
    if (!record || colon == std::string::npos) continue;
    if (line.starts_with("failure: ")) {
      record->failure = line.substr(9);
      continue;
    }
    Figure figure{line.substr(0, colon), 0, 0};
    std::istringstream numbers(line.substr(colon + 2));
    numbers.imbue(std::locale::classic());
    std::string of;
    numbers >> figure.value >> of >> figure.scale;
    record->figures.push_back(figure);
  }
  return records;
}

void write_record(const std::string& path, const std::string& name, const Record& record) {
  static bool begun = false;
  std::ofstream file(path, begun ? std::ios::app : std::ios::trunc);
  begun = true;
  file << "= " << name << '\n';
  if (!record.failure.empty()) file << "failure: " << record.failure << '\n';
  for (const Figure& figure : record.figures)
    if (figure.value != 0)
      file << fmt::format("{}: {:.10g}{}\n", figure.name, figure.value,
                          figure.scale > 0 ? fmt::format(" of {:.2g}", figure.scale) : "");
}

/// Figures that are others, with by how much of their scale.
std::vector<std::string> differences(const Record& is, const Record& was, double tolerance) {
  std::vector<std::string> out;
  if (is.failure != was.failure) return {fmt::format("it says '{}', not '{}'", is.failure, was.failure)};
  std::map<std::string, const Figure*> left;
  for (const Figure& b : was.figures)
    if (b.value != 0) left[b.name] = &b;
  for (const Figure& a : is.figures) {
    const auto found = left.find(a.name);
    const Figure b = found == left.end() ? Figure{a.name, 0, a.scale} : *found->second;
    if (found != left.end()) left.erase(found);
    if (std::abs(a.value - b.value) <= tolerance * b.scale) continue;
    out.push_back(fmt::format("{}: {:.12g}, not {:.12g}, off by {:.2g}", a.name, a.value, b.value,
                              std::abs(a.value - b.value) / b.scale));
  }
  for (const auto& [name, b] : left) out.push_back(name + " is there no more");
  return out;
}

std::vector<Override> overrides_of(const std::string& text) {
  std::vector<Override> out;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) {
    part.erase(0, part.find_first_not_of(" \n"));
    const std::size_t equals = part.find('=');
    if (equals != std::string::npos) out.push_back({part.substr(0, equals), part.substr(equals + 1)});
  }
  return out;
}

/// @param overrides  "key=value; key=value"
void check_recorded(const std::string& name, int steps, const std::string& file,
                    const std::string& overrides) {
  const auto folder = source_folder();
  const auto own = folder / "tests" / "recorded" / file;
  const Scene scene =
      read_scene(std::filesystem::exists(own) ? own : folder / "configs" / file, overrides_of(overrides));
  const Record record = run_steps(scene, steps);
  if (const char* path = std::getenv("MPMFAST_RECORD")) {
    write_record(path, name, record);
    for (const auto& line : differences(run_steps(scene, steps, {false, false}), record, 0))
      FAIL_CHECK("through an archive it is another run: " << line);
    for (const auto& line : differences(run_steps(scene, steps, {true, true}), record, kSteady))
      FAIL_CHECK("hangs on round-off: " << line);
    return;
  }
  static const std::map<std::string, Record> records = read_records();
  REQUIRE_MESSAGE(records.contains(name), "nothing is recorded of it");
  const auto others = differences(record, records.at(name), kTolerance);
  for (std::size_t k = 0; k < std::min<std::size_t>(others.size(), 5); ++k) FAIL_CHECK(others[k]);
  CHECK(others.size() == 0);
}

#define MPMFAST_RUN(name, steps, file, overrides) \
  TEST_CASE("as recorded: " name) { check_recorded(name, steps, file, overrides); }

// Scenes of configs/.
MPMFAST_RUN("bar", 60, "bar.yaml", "")
MPMFAST_RUN("bars_impact", 30, "bars_impact.yaml", "")
MPMFAST_RUN("bars_weight", 60, "bars_weight.yaml", "time.end=0.5 ms; gravity.ramp=0.4 ms")
MPMFAST_RUN("broken_beam", 30, "broken_beam.yaml", "grid.cell=2 mm")
MPMFAST_RUN("closed_crack", 30, "closed_crack.yaml", "grid.cell=5 mm")
MPMFAST_RUN("cohesive_bars", 200, "cohesive_bars.yaml", "")
MPMFAST_RUN("corner_particle", 150, "corner_particle.yaml", "")
MPMFAST_RUN("crack_wave", 30, "crack_wave.yaml", "grid.cell=5 mm")
MPMFAST_RUN("cubes", 20, "cubes.yaml", "grid.cell=6 mm")
MPMFAST_RUN("dcb", 40, "dcb.yaml", "")
MPMFAST_RUN("dcb_cohesive", 40, "dcb_cohesive.yaml", "")
MPMFAST_RUN("edge_crack", 30, "edge_crack.yaml", "variables.cell=5 mm")
MPMFAST_RUN("ellipses", 1, "ellipses.yaml", "grid.cell=1/20 mm")
MPMFAST_RUN("fibre_pullout", 40, "fibre_pullout.yaml", "")
MPMFAST_RUN("friction_heat", 20, "friction_heat.yaml", "grid.cell=1 mm")
MPMFAST_RUN("gap", 150, "gap.yaml", "")
MPMFAST_RUN("gap3d", 60, "gap3d.yaml", "")
MPMFAST_RUN("grains_box", 6, "grains_box.yaml", "grid.cell=10 mm")
MPMFAST_RUN("grains_line", 10, "grains_line.yaml", "grid.cell=5 mm")
MPMFAST_RUN("heat_contact", 80, "heat_contact.yaml", "")
MPMFAST_RUN("heat_slab", 150, "heat_slab.yaml", "")
MPMFAST_RUN("hertz_disks", 40, "hertz_disks.yaml", "grid.cell=1 mm")
MPMFAST_RUN("hertz_plane", 10, "hertz_plane.yaml", "grid.cell=0.4 mm")
MPMFAST_RUN("hertz_pulled", 12, "hertz_pulled.yaml", "grid.cell=1 mm")
MPMFAST_RUN("incline", 150, "incline.yaml", "")
MPMFAST_RUN("incline_tilted", 150, "incline_tilted.yaml", "")
MPMFAST_RUN("interface_bars", 150, "interface_bars.yaml", "")
MPMFAST_RUN("interface_wave", 40, "interface_wave.yaml", "")
MPMFAST_RUN("kinked_crack", 30, "kinked_crack.yaml", "grid.cell=2 mm; cracks.0.growth.toughness=0.01 J/m^2")
MPMFAST_RUN("oblique_impact", 80, "oblique_impact.yaml", "")
MPMFAST_RUN("pair_laws", 150, "pair_laws.yaml", "")
MPMFAST_RUN("pressed_ring", 100, "pressed_ring.yaml", "grid.cell=2 mm")
MPMFAST_RUN("rings", 20, "rings.yaml", "grid.cell=2.5 mm")
MPMFAST_RUN("rolling_disk", 20, "rolling_disk.yaml", "grid.cell=0.05 m")
MPMFAST_RUN("sand_column", 60, "sand_column.yaml", "")
MPMFAST_RUN("shock", 20, "shock.yaml", "")
MPMFAST_RUN("slanted_crack", 30, "slanted_crack.yaml", "grid.cell=10 mm")
MPMFAST_RUN("sphere_axis", 40, "sphere_axis.yaml", "grid.cell=0.5 mm")
MPMFAST_RUN("sphere_pair", 12, "sphere_pair.yaml", "grid.cell=2 mm")
MPMFAST_RUN("sphere_plane", 20, "sphere_plane.yaml", "grid.cell=2 mm")
MPMFAST_RUN("spheres", 20, "spheres.yaml", "grid.cell=2 mm")
MPMFAST_RUN("squares", 80, "squares.yaml", "")
MPMFAST_RUN("stl_body", 15, "stl_body.yaml", "grid.cell=2 mm")
MPMFAST_RUN("taylor_bar", 40, "taylor_bar.yaml", "")
MPMFAST_RUN("thick_ring", 300, "thick_ring.yaml", "")
MPMFAST_RUN("thin_plate", 50, "thin_plate.yaml", "")
MPMFAST_RUN("uniaxial", 120, "uniaxial.yaml", "")
MPMFAST_RUN("hard/clouds", 40, "hard/clouds.yaml", "contact.friction=0")
MPMFAST_RUN("hard/corner_on_corner", 120, "hard/corner_on_corner.yaml", "")
MPMFAST_RUN("hard/corner_on_plane", 120, "hard/corner_on_plane.yaml", "")
MPMFAST_RUN("hard/fast_impact", 45, "hard/fast_impact.yaml", "")
MPMFAST_RUN("hard/grains", 6, "hard/grains.yaml", "")
MPMFAST_RUN("hard/grazing", 100, "hard/grazing.yaml", "")
MPMFAST_RUN("hard/hundred_gaps", 120, "hard/hundred_gaps.yaml", "")
MPMFAST_RUN("hard/incompressible", 120, "hard/incompressible.yaml", "")
MPMFAST_RUN("hard/overlapping", 120, "hard/overlapping.yaml", "")
MPMFAST_RUN("hard/ratio", 120, "hard/ratio.yaml", "")
MPMFAST_RUN("hard/rest", 120, "hard/rest.yaml", "")
MPMFAST_RUN("hard/separation", 120, "hard/separation.yaml", "")
MPMFAST_RUN("hard/sheet", 120, "hard/sheet.yaml", "")
MPMFAST_RUN("hard/sheet_over_corner", 120, "hard/sheet_over_corner.yaml", "")
MPMFAST_RUN("hard/sliding", 60, "hard/sliding.yaml", "")
MPMFAST_RUN("hard/sphere_corner", 40, "hard/sphere_corner.yaml", "")
MPMFAST_RUN("hard/spin", 120, "hard/spin.yaml", "")
MPMFAST_RUN("hard/stick_slip", 120, "hard/stick_slip.yaml", "")
MPMFAST_RUN("hard/stretch", 70, "hard/stretch.yaml", "")
MPMFAST_RUN("hard/surrounded", 120, "hard/surrounded.yaml", "")
MPMFAST_RUN("hard/tiny_numbers", 120, "hard/tiny_numbers.yaml", "")
MPMFAST_RUN("hard/wedge", 120, "hard/wedge.yaml", "")
MPMFAST_RUN("starters/axisymmetric", 40, "starters/axisymmetric.yaml", "grid.cell=0.5 mm")
MPMFAST_RUN("starters/impact", 60, "starters/impact.yaml", "grid.cell=0.5 mm")
MPMFAST_RUN("starters/press", 60, "starters/press.yaml", "")
MPMFAST_RUN("starters/soil", 40, "starters/soil.yaml", "")
MPMFAST_RUN("starters/sphere3d", 20, "starters/sphere3d.yaml", "variables.cell=2 mm")

// Scenes of tests/recorded/.
MPMFAST_RUN("meet/linear flip", 24, "meet.yaml", "method={basis: linear, update: flip}")
MPMFAST_RUN("meet/linear pic", 24, "meet.yaml", "method={basis: linear, update: pic}")
MPMFAST_RUN("meet/linear xpic(3)", 24, "meet.yaml", "method={basis: linear, update: xpic(3)}")
MPMFAST_RUN("meet/linear fmpm(2)", 24, "meet.yaml", "method={basis: linear, update: fmpm(2)}")
MPMFAST_RUN("meet/ugimp flip", 24, "meet.yaml", "method={basis: ugimp, update: flip}")
MPMFAST_RUN("meet/ugimp pic", 24, "meet.yaml", "method={basis: ugimp, update: pic}")
MPMFAST_RUN("meet/ugimp xpic(3)", 24, "meet.yaml", "method={basis: ugimp, update: xpic(3)}")
MPMFAST_RUN("meet/ugimp fmpm(2)", 24, "meet.yaml", "method={basis: ugimp, update: fmpm(2)}")
MPMFAST_RUN("meet/lcpdi flip", 24, "meet.yaml", "method={basis: lcpdi, update: flip}")
MPMFAST_RUN("meet/lcpdi pic", 24, "meet.yaml", "method={basis: lcpdi, update: pic}")
MPMFAST_RUN("meet/lcpdi xpic(3)", 24, "meet.yaml", "method={basis: lcpdi, update: xpic(3)}")
MPMFAST_RUN("meet/lcpdi fmpm(2)", 24, "meet.yaml", "method={basis: lcpdi, update: fmpm(2)}")
MPMFAST_RUN("meet/qcpdi flip", 24, "meet.yaml", "method={basis: qcpdi, update: flip}")
MPMFAST_RUN("meet/qcpdi pic", 24, "meet.yaml", "method={basis: qcpdi, update: pic}")
MPMFAST_RUN("meet/qcpdi xpic(3)", 24, "meet.yaml", "method={basis: qcpdi, update: xpic(3)}")
MPMFAST_RUN("meet/qcpdi fmpm(2)", 24, "meet.yaml", "method={basis: qcpdi, update: fmpm(2)}")
MPMFAST_RUN("meet/bspline2 flip", 24, "meet.yaml", "method={basis: bspline2, update: flip}")
MPMFAST_RUN("meet/bspline2 pic", 24, "meet.yaml", "method={basis: bspline2, update: pic}")
MPMFAST_RUN("meet/bspline2 xpic(3)", 24, "meet.yaml", "method={basis: bspline2, update: xpic(3)}")
MPMFAST_RUN("meet/bspline2 fmpm(2)", 24, "meet.yaml", "method={basis: bspline2, update: fmpm(2)}")
MPMFAST_RUN("meet/bspline2 apic", 24, "meet.yaml", "method={basis: bspline2, update: apic}")
MPMFAST_RUN("meet/bspline3 flip", 24, "meet.yaml", "method={basis: bspline3, update: flip}")
MPMFAST_RUN("meet/bspline3 pic", 24, "meet.yaml", "method={basis: bspline3, update: pic}")
MPMFAST_RUN("meet/bspline3 xpic(3)", 24, "meet.yaml", "method={basis: bspline3, update: xpic(3)}")
MPMFAST_RUN("meet/bspline3 fmpm(2)", 24, "meet.yaml", "method={basis: bspline3, update: fmpm(2)}")
MPMFAST_RUN("meet/bspline3 apic", 24, "meet.yaml", "method={basis: bspline3, update: apic}")
MPMFAST_RUN("axisymmetric/linear flip", 24, "meet_axis.yaml", "method={basis: linear, update: flip}")
MPMFAST_RUN("plane_stress/linear pic", 24, "meet.yaml",
            "space=plane_stress; thickness=3 mm; method={basis: linear, update: pic}")
MPMFAST_RUN("solid/linear flip", 10, "solid.yaml", "method={basis: linear, update: flip}")
MPMFAST_RUN("solid/linear xpic(3)", 10, "solid.yaml", "method={basis: linear, update: xpic(3)}")
MPMFAST_RUN("axisymmetric/ugimp pic", 24, "meet_axis.yaml", "method={basis: ugimp, update: pic}")
MPMFAST_RUN("plane_stress/ugimp xpic(3)", 24, "meet.yaml",
            "space=plane_stress; thickness=3 mm; method={basis: ugimp, update: xpic(3)}")
MPMFAST_RUN("solid/ugimp pic", 10, "solid.yaml", "method={basis: ugimp, update: pic}")
MPMFAST_RUN("solid/ugimp fmpm(2)", 10, "solid.yaml", "method={basis: ugimp, update: fmpm(2)}")
MPMFAST_RUN("axisymmetric/lcpdi xpic(3)", 24, "meet_axis.yaml", "method={basis: lcpdi, update: xpic(3)}")
MPMFAST_RUN("plane_stress/lcpdi fmpm(2)", 24, "meet.yaml",
            "space=plane_stress; thickness=3 mm; method={basis: lcpdi, update: fmpm(2)}")
MPMFAST_RUN("solid/lcpdi xpic(3)", 10, "solid.yaml", "method={basis: lcpdi, update: xpic(3)}")
MPMFAST_RUN("solid/lcpdi flip", 10, "solid.yaml", "method={basis: lcpdi, update: flip}")
MPMFAST_RUN("axisymmetric/qcpdi fmpm(2)", 24, "meet_axis.yaml", "method={basis: qcpdi, update: fmpm(2)}")
MPMFAST_RUN("plane_stress/qcpdi flip", 24, "meet.yaml",
            "space=plane_stress; thickness=3 mm; method={basis: qcpdi, update: flip}")
MPMFAST_RUN("solid/qcpdi fmpm(2)", 10, "solid.yaml", "method={basis: qcpdi, update: fmpm(2)}")
MPMFAST_RUN("solid/qcpdi pic", 10, "solid.yaml", "method={basis: qcpdi, update: pic}")
MPMFAST_RUN("axisymmetric/bspline2 apic", 24, "meet_axis.yaml", "method={basis: bspline2, update: apic}")
MPMFAST_RUN("plane_stress/bspline2 flip", 24, "meet.yaml",
            "space=plane_stress; thickness=3 mm; method={basis: bspline2, update: flip}")
MPMFAST_RUN("solid/bspline2 apic", 10, "solid.yaml", "method={basis: bspline2, update: apic}")
MPMFAST_RUN("solid/bspline2 pic", 10, "solid.yaml", "method={basis: bspline2, update: pic}")
MPMFAST_RUN("axisymmetric/bspline3 flip", 24, "meet_axis.yaml", "method={basis: bspline3, update: flip}")
MPMFAST_RUN("plane_stress/bspline3 pic", 24, "meet.yaml",
            "space=plane_stress; thickness=3 mm; method={basis: bspline3, update: pic}")
MPMFAST_RUN("solid/bspline3 flip", 10, "solid.yaml", "method={basis: bspline3, update: flip}")
MPMFAST_RUN("solid/bspline3 xpic(3)", 10, "solid.yaml", "method={basis: bspline3, update: xpic(3)}")
MPMFAST_RUN("solid/bspline2 apic", 10, "solid.yaml", "method={basis: bspline2, update: apic}")
MPMFAST_RUN(
    "meet/one field", 24, "meet.yaml",
    "contact=none; bodies.2.material=hard; bodies.2.velocity=[0, 0]; bodies.2.rotation.speed=50 rad/s")
MPMFAST_RUN("solid/one field", 8, "solid.yaml",
            "boundaries.front=free; contact=none; bodies.2.material=hard; bodies.2.velocity=[0, 0, 0]; "
            "bodies.2.rotation.speed=50 rad/s; method.basis=bspline3")
MPMFAST_RUN("strain first/ugimp flip", 24, "meet.yaml", "method={basis: ugimp, update: flip, strain: first}")
MPMFAST_RUN("strain first/qcpdi xpic(2)", 24, "meet.yaml",
            "method={basis: qcpdi, update: xpic(2), strain: first}")
MPMFAST_RUN("strain first/solid", 6, "solid.yaml", "method={strain: first, update: fmpm(3)}")
MPMFAST_RUN("strain last/ugimp flip", 24, "meet.yaml", "method={basis: ugimp, update: flip, strain: last}")
MPMFAST_RUN("strain last/qcpdi xpic(2)", 24, "meet.yaml",
            "method={basis: qcpdi, update: xpic(2), strain: last}")
MPMFAST_RUN("strain last/solid", 6, "solid.yaml", "method={strain: last, update: fmpm(3)}")
MPMFAST_RUN("strain average/ugimp flip", 24, "meet.yaml",
            "method={basis: ugimp, update: flip, strain: average}")
MPMFAST_RUN("strain average/qcpdi xpic(2)", 24, "meet.yaml",
            "method={basis: qcpdi, update: xpic(2), strain: average}")
MPMFAST_RUN("strain average/solid", 6, "solid.yaml", "method={strain: average, update: fmpm(3)}")
MPMFAST_RUN("strain last+/ugimp flip", 24, "meet.yaml", "method={basis: ugimp, update: flip, strain: last+}")
MPMFAST_RUN("strain last+/qcpdi xpic(2)", 24, "meet.yaml",
            "method={basis: qcpdi, update: xpic(2), strain: last+}")
MPMFAST_RUN("strain last+/solid", 6, "solid.yaml", "method={strain: last+, update: fmpm(3)}")
MPMFAST_RUN("strain average+/ugimp flip", 24, "meet.yaml",
            "method={basis: ugimp, update: flip, strain: average+}")
MPMFAST_RUN("strain average+/qcpdi xpic(2)", 24, "meet.yaml",
            "method={basis: qcpdi, update: xpic(2), strain: average+}")
MPMFAST_RUN("strain average+/solid", 6, "solid.yaml", "method={strain: average+, update: fmpm(3)}")
MPMFAST_RUN("deformation 1/meet", 24, "meet.yaml", "method={deformation_terms: 1, basis: lcpdi}")
MPMFAST_RUN("deformation 1/solid", 6, "solid.yaml", "method={deformation_terms: 1, basis: lcpdi}")
MPMFAST_RUN("deformation 1/axisymmetric", 24, "meet_axis.yaml", "method={deformation_terms: 1}")
MPMFAST_RUN("deformation 2/meet", 24, "meet.yaml", "method={deformation_terms: 2, basis: lcpdi}")
MPMFAST_RUN("deformation 2/solid", 6, "solid.yaml", "method={deformation_terms: 2, basis: lcpdi}")
MPMFAST_RUN("deformation 2/axisymmetric", 24, "meet_axis.yaml", "method={deformation_terms: 2}")
MPMFAST_RUN("deformation inverse/meet", 24, "meet.yaml", "method={deformation_terms: inverse, basis: lcpdi}")
MPMFAST_RUN("deformation inverse/solid", 6, "solid.yaml", "method={deformation_terms: inverse, basis: lcpdi}")
MPMFAST_RUN("deformation inverse/axisymmetric", 24, "meet_axis.yaml", "method={deformation_terms: inverse}")
MPMFAST_RUN("deformation exponential/meet", 24, "meet.yaml",
            "method={deformation_terms: exponential, basis: lcpdi}")
MPMFAST_RUN("deformation exponential/solid", 6, "solid.yaml",
            "method={deformation_terms: exponential, basis: lcpdi}")
MPMFAST_RUN("deformation exponential/axisymmetric", 24, "meet_axis.yaml",
            "method={deformation_terms: exponential}")
MPMFAST_RUN("position grid_end/flip", 24, "meet.yaml", "method={position: grid_end}")
MPMFAST_RUN("position grid_end/xpic", 24, "meet.yaml",
            "method={position: grid_end, update: xpic(2), basis: bspline2}")
MPMFAST_RUN("position grid_end/fmpm", 24, "meet.yaml",
            "method={position: grid_end, update: fmpm(4), every: 3}")
MPMFAST_RUN("position grid/flip", 24, "meet.yaml", "method={position: grid}")
MPMFAST_RUN("position grid/xpic", 24, "meet.yaml",
            "method={position: grid, update: xpic(2), basis: bspline2}")
MPMFAST_RUN("position grid/fmpm", 24, "meet.yaml", "method={position: grid, update: fmpm(4), every: 3}")
MPMFAST_RUN("position trapezoid/xpic", 24, "meet.yaml",
            "method={position: trapezoid, update: xpic(2), basis: bspline2}")
MPMFAST_RUN("position trapezoid/fmpm", 24, "meet.yaml",
            "method={position: trapezoid, update: fmpm(4), every: 3}")
MPMFAST_RUN("position particle/xpic", 24, "meet.yaml",
            "method={position: particle, update: xpic(2), basis: bspline2}")
MPMFAST_RUN("position particle/fmpm", 24, "meet.yaml",
            "method={position: particle, update: fmpm(4), every: 3}")
MPMFAST_RUN("filter/own", 24, "meet.yaml", "method={update: xpic(4), own_filter: true}")
MPMFAST_RUN("filter/no contact", 24, "meet.yaml", "method={update: xpic(4), contact_correction: false}")
MPMFAST_RUN("filter/every third", 24, "meet.yaml", "method={update: xpic(4), every: 3}")
MPMFAST_RUN("filter/solid own", 6, "solid.yaml", "method={update: xpic(3), own_filter: true}")
MPMFAST_RUN("extension/bspline2 0.75 walls", 24, "walls.yaml",
            "contact=none; method={basis: bspline2, extension: {occupation: 0.75}}")
MPMFAST_RUN("extension/bspline2 0.75 solid", 8, "walls3.yaml",
            "contact=none; method={basis: bspline2, extension: {occupation: 0.75}}")
MPMFAST_RUN("extension/bspline2 0.75 penalty", 16, "meet.yaml",
            "contact={family: penalty, friction: 0.2}; method={basis: bspline2, update: xpic(2), extension: "
            "{occupation: 0.75}}")
MPMFAST_RUN("extension/bspline2 0.75 penalty solid", 5, "solid.yaml",
            "contact={family: penalty, friction: 0.2}; method={basis: bspline2, update: fmpm(2), extension: "
            "{occupation: 0.75}}")
MPMFAST_RUN("extension/bspline2 0.75 axisymmetric", 16, "walls_axis.yaml",
            "contact=none; method={basis: bspline2, update: pic, extension: {occupation: 0.75}}")
MPMFAST_RUN("extension/bspline2 0.75 leaving", 30, "drop.yaml",
            "contact=none; method={basis: bspline2, extension: {occupation: 0.75}}; bodies.2.material=soft")
MPMFAST_RUN("extension/bspline3 0.6 walls", 24, "walls.yaml",
            "contact=none; method={basis: bspline3, extension: {occupation: 0.6}}")
MPMFAST_RUN("extension/bspline3 0.6 solid", 8, "walls3.yaml",
            "contact=none; method={basis: bspline3, extension: {occupation: 0.6}}")
MPMFAST_RUN("extension/bspline3 0.6 penalty", 16, "meet.yaml",
            "contact={family: penalty, friction: 0.2}; method={basis: bspline3, update: xpic(2), extension: "
            "{occupation: 0.6}}")
MPMFAST_RUN("extension/bspline3 0.6 penalty solid", 5, "solid.yaml",
            "contact={family: penalty, friction: 0.2}; method={basis: bspline3, update: fmpm(2), extension: "
            "{occupation: 0.6}}")
MPMFAST_RUN("extension/bspline3 0.6 axisymmetric", 16, "walls_axis.yaml",
            "contact=none; method={basis: bspline3, update: pic, extension: {occupation: 0.6}}")
MPMFAST_RUN("extension/bspline3 0.6 leaving", 30, "drop.yaml",
            "contact=none; method={basis: bspline3, extension: {occupation: 0.6}}; bodies.2.material=soft")
MPMFAST_RUN("extension/bspline2 0.3 walls", 24, "walls.yaml",
            "contact=none; method={basis: bspline2, extension: {occupation: 0.3}}")
MPMFAST_RUN("extension/bspline2 0.3 solid", 8, "walls3.yaml",
            "contact=none; method={basis: bspline2, extension: {occupation: 0.3}}")
MPMFAST_RUN("extension/bspline2 0.3 penalty", 16, "meet.yaml",
            "contact={family: penalty, friction: 0.2}; method={basis: bspline2, update: xpic(2), extension: "
            "{occupation: 0.3}}")
MPMFAST_RUN("extension/bspline2 0.3 penalty solid", 5, "solid.yaml",
            "contact={family: penalty, friction: 0.2}; method={basis: bspline2, update: fmpm(2), extension: "
            "{occupation: 0.3}}")
MPMFAST_RUN("extension/bspline2 0.3 axisymmetric", 16, "walls_axis.yaml",
            "contact=none; method={basis: bspline2, update: pic, extension: {occupation: 0.3}}")
MPMFAST_RUN("extension/bspline2 0.3 leaving", 30, "drop.yaml",
            "contact=none; method={basis: bspline2, extension: {occupation: 0.3}}; bodies.2.material=soft")
MPMFAST_RUN("normal smoothed_max_margin/meet", 24, "meet.yaml",
            "contact.normal=smoothed_max_margin; method.basis=linear")
MPMFAST_RUN("normal smoothed_max_margin/solid", 6, "solid.yaml",
            "contact.normal=smoothed_max_margin; method.basis=ugimp")
MPMFAST_RUN("normal smoothed_max_margin/corner", 16, "corner.yaml", "contact.normal=smoothed_max_margin")
MPMFAST_RUN("normal max_margin/meet", 24, "meet.yaml", "contact.normal=max_margin; method.basis=ugimp")
MPMFAST_RUN("normal max_margin/solid", 6, "solid.yaml", "contact.normal=max_margin; method.basis=lcpdi")
MPMFAST_RUN("normal max_margin/corner", 16, "corner.yaml", "contact.normal=max_margin")
MPMFAST_RUN("normal logistic_regression/meet", 24, "meet.yaml",
            "contact.normal=logistic_regression; method.basis=lcpdi")
MPMFAST_RUN("normal logistic_regression/solid", 6, "solid.yaml",
            "contact.normal=logistic_regression; method.basis=qcpdi")
MPMFAST_RUN("normal logistic_regression/corner", 16, "corner.yaml", "contact.normal=logistic_regression")
MPMFAST_RUN("normal smoothed_logistic_regression/meet", 24, "meet.yaml",
            "contact.normal=smoothed_logistic_regression; method.basis=qcpdi")
MPMFAST_RUN("normal smoothed_logistic_regression/solid", 6, "solid.yaml",
            "contact.normal=smoothed_logistic_regression; method.basis=bspline2")
MPMFAST_RUN("normal smoothed_logistic_regression/corner", 16, "corner.yaml",
            "contact.normal=smoothed_logistic_regression")
MPMFAST_RUN("normal logistic_irls/meet", 24, "meet.yaml",
            "contact.normal=logistic_irls; method.basis=bspline2")
MPMFAST_RUN("normal logistic_irls/solid", 6, "solid.yaml",
            "contact.normal=logistic_irls; method.basis=bspline3")
MPMFAST_RUN("normal logistic_irls/corner", 16, "corner.yaml", "contact.normal=logistic_irls")
MPMFAST_RUN("normal linear_regression/meet", 24, "meet.yaml",
            "contact.normal=linear_regression; method.basis=bspline3")
MPMFAST_RUN("normal linear_regression/solid", 6, "solid.yaml",
            "contact.normal=linear_regression; method.basis=linear")
MPMFAST_RUN("normal linear_regression/corner", 16, "corner.yaml", "contact.normal=linear_regression")
MPMFAST_RUN("normal average_gradient/meet", 24, "meet.yaml",
            "contact.normal=average_gradient; method.basis=linear")
MPMFAST_RUN("normal average_gradient/solid", 6, "solid.yaml",
            "contact.normal=average_gradient; method.basis=ugimp")
MPMFAST_RUN("normal average_gradient/corner", 16, "corner.yaml", "contact.normal=average_gradient")
MPMFAST_RUN("normal max_gradient/meet", 24, "meet.yaml", "contact.normal=max_gradient; method.basis=ugimp")
MPMFAST_RUN("normal max_gradient/solid", 6, "solid.yaml", "contact.normal=max_gradient; method.basis=lcpdi")
MPMFAST_RUN("normal max_gradient/corner", 16, "corner.yaml", "contact.normal=max_gradient")
MPMFAST_RUN("normal max_volume/meet", 24, "meet.yaml", "contact.normal=max_volume; method.basis=lcpdi")
MPMFAST_RUN("normal max_volume/solid", 6, "solid.yaml", "contact.normal=max_volume; method.basis=qcpdi")
MPMFAST_RUN("normal max_volume/corner", 16, "corner.yaml", "contact.normal=max_volume")
MPMFAST_RUN("normal own_gradient/meet", 24, "meet.yaml", "contact.normal=own_gradient; method.basis=qcpdi")
MPMFAST_RUN("normal own_gradient/solid", 6, "solid.yaml",
            "contact.normal=own_gradient; method.basis=bspline2")
MPMFAST_RUN("normal own_gradient/corner", 16, "corner.yaml",
            "contact.normal=own_gradient; contact.fields=lump")
MPMFAST_RUN("normal specified/meet", 24, "meet.yaml",
            "contact.specified_normal=[0.2, -1]; contact.normal=specified; method.basis=bspline2")
MPMFAST_RUN("normal specified/solid", 6, "solid.yaml",
            "contact.specified_normal=[0.2, -1, 0.1]; contact.normal=specified; method.basis=bspline3")
MPMFAST_RUN("separation ellipsoid/meet", 24, "meet.yaml", "contact.separation=ellipsoid; method.basis=lcpdi")
MPMFAST_RUN("separation ellipsoid/solid", 6, "solid.yaml", "contact.separation=ellipsoid; method.basis=qcpdi")
MPMFAST_RUN("separation ellipsoid/gradient", 24, "meet.yaml",
            "contact.separation=ellipsoid; contact.normal=average_gradient; contact.corrections=1")
MPMFAST_RUN("separation ellipsoid_support/meet", 24, "meet.yaml",
            "contact.separation=ellipsoid_support; method.basis=qcpdi")
MPMFAST_RUN("separation ellipsoid_support/solid", 6, "solid.yaml",
            "contact.separation=ellipsoid_support; method.basis=bspline2")
MPMFAST_RUN("separation ellipsoid_support/gradient", 24, "meet.yaml",
            "contact.separation=ellipsoid_support; contact.normal=average_gradient; contact.corrections=1")
MPMFAST_RUN("separation parallelogram_support/meet", 24, "meet.yaml",
            "contact.separation=parallelogram_support; method.basis=bspline2")
MPMFAST_RUN("separation parallelogram_support/solid", 6, "solid.yaml",
            "contact.separation=parallelogram_support; method.basis=bspline3")
MPMFAST_RUN(
    "separation parallelogram_support/gradient", 24, "meet.yaml",
    "contact.separation=parallelogram_support; contact.normal=average_gradient; contact.corrections=1")
MPMFAST_RUN("separation displacement/gradient", 24, "meet.yaml",
            "contact.separation=displacement; contact.normal=average_gradient; contact.corrections=1")
MPMFAST_RUN("separation position_offset/meet", 24, "meet.yaml",
            "contact.separation=position_offset; method.basis=linear")
MPMFAST_RUN("separation position_offset/solid", 6, "solid.yaml",
            "contact.separation=position_offset; method.basis=ugimp")
MPMFAST_RUN("separation position_offset/gradient", 24, "meet.yaml",
            "contact.separation=position_offset; contact.normal=average_gradient; contact.corrections=1")
MPMFAST_RUN("separation position_power/meet", 24, "meet.yaml",
            "contact.separation=position_power; method.basis=ugimp")
MPMFAST_RUN("separation position_power/solid", 6, "solid.yaml",
            "contact.separation=position_power; method.basis=lcpdi")
MPMFAST_RUN("separation position_power/gradient", 24, "meet.yaml",
            "contact.separation=position_power; contact.normal=average_gradient; contact.corrections=1")
MPMFAST_RUN("separation position_piecewise/meet", 24, "meet.yaml",
            "contact.separation=position_piecewise; method.basis=lcpdi")
MPMFAST_RUN("separation position_piecewise/solid", 6, "solid.yaml",
            "contact.separation=position_piecewise; method.basis=qcpdi")
MPMFAST_RUN("separation position_piecewise/gradient", 24, "meet.yaml",
            "contact.separation=position_piecewise; contact.normal=average_gradient; contact.corrections=1")
MPMFAST_RUN("separation none/meet", 24, "meet.yaml", "contact.separation=none; method.basis=qcpdi")
MPMFAST_RUN("separation none/gradient", 24, "meet.yaml",
            "contact.separation=none; contact.normal=average_gradient; contact.corrections=1")
MPMFAST_RUN("separation piecewise for one", 24, "meet.yaml",
            "contact.separation=position_piecewise; contact.piecewise_particles=1")
MPMFAST_RUN("detection both/lump", 16, "corner.yaml", "contact.detection=both; contact.fields=lump")
MPMFAST_RUN("detection both/pairs", 16, "corner.yaml", "contact.detection=both; contact.fields=pairs")
MPMFAST_RUN("detection both/simultaneous", 16, "corner.yaml",
            "contact.detection=both; contact.fields=simultaneous")
MPMFAST_RUN("detection velocity/lump", 16, "corner.yaml", "contact.detection=velocity; contact.fields=lump")
MPMFAST_RUN("detection velocity/pairs", 16, "corner.yaml", "contact.detection=velocity; contact.fields=pairs")
MPMFAST_RUN("detection separation/lump", 16, "corner.yaml",
            "contact.detection=separation; contact.fields=lump")
MPMFAST_RUN("detection separation/pairs", 16, "corner.yaml",
            "contact.detection=separation; contact.fields=pairs")
MPMFAST_RUN("detection separation/simultaneous", 16, "corner.yaml",
            "contact.detection=separation; contact.fields=simultaneous")
MPMFAST_RUN("contact warm_start false/meet", 24, "meet.yaml",
            "contact.warm_start=false; contact.normal=logistic_regression")
MPMFAST_RUN("contact warm_start false/corner", 12, "corner.yaml",
            "contact.warm_start=false; contact.normal=logistic_regression")
MPMFAST_RUN("contact warm_start false/solid", 5, "solid.yaml",
            "contact.warm_start=false; contact.normal=logistic_regression")
MPMFAST_RUN("contact refit 0.2/meet", 12, "meet.yaml", "contact.refit=0.2")
MPMFAST_RUN("contact refit 0.2/corner", 6, "corner.yaml", "contact.refit=0.2")
MPMFAST_RUN("contact refit 0.2/solid", 3, "solid.yaml", "contact.refit=0.2")
MPMFAST_RUN("contact rigid_bias 2/meet", 24, "meet.yaml", "contact.rigid_bias=2")
MPMFAST_RUN("contact rigid_bias 2/corner", 12, "corner.yaml", "contact.rigid_bias=2")
MPMFAST_RUN("contact rigid_bias 2/solid", 5, "solid.yaml", "contact.rigid_bias=2")
MPMFAST_RUN("contact rigid_bias 12/meet", 24, "meet.yaml", "contact.rigid_bias=12")
MPMFAST_RUN("contact rigid_bias 12/corner", 12, "corner.yaml", "contact.rigid_bias=12")
MPMFAST_RUN("contact rigid_bias 12/solid", 5, "solid.yaml", "contact.rigid_bias=12")
MPMFAST_RUN("contact advance_separation false/meet", 24, "meet.yaml", "contact.advance_separation=false")
MPMFAST_RUN("contact advance_separation false/corner", 12, "corner.yaml", "contact.advance_separation=false")
MPMFAST_RUN("contact advance_separation false/solid", 5, "solid.yaml", "contact.advance_separation=false")
MPMFAST_RUN("contact persistent false/meet", 24, "meet.yaml", "contact.persistent=false")
MPMFAST_RUN("contact persistent false/corner", 12, "corner.yaml", "contact.persistent=false")
MPMFAST_RUN("contact persistent false/solid", 5, "solid.yaml", "contact.persistent=false")
MPMFAST_RUN("contact hysteresis 0.2/meet", 24, "meet.yaml", "contact.hysteresis=0.2")
MPMFAST_RUN("contact hysteresis 0.2/corner", 12, "corner.yaml", "contact.hysteresis=0.2")
MPMFAST_RUN("contact hysteresis 0.2/solid", 5, "solid.yaml", "contact.hysteresis=0.2")
MPMFAST_RUN("contact mass_screen 0.1/meet", 24, "meet.yaml", "contact.mass_screen=0.1")
MPMFAST_RUN("contact mass_screen 0.1/corner", 12, "corner.yaml", "contact.mass_screen=0.1")
MPMFAST_RUN("contact mass_screen 0.1/solid", 5, "solid.yaml", "contact.mass_screen=0.1")
MPMFAST_RUN("contact volume_screen 0.3/meet", 24, "meet.yaml", "contact.volume_screen=0.3")
MPMFAST_RUN("contact volume_screen 0.3/corner", 12, "corner.yaml", "contact.volume_screen=0.3")
MPMFAST_RUN("contact volume_screen 0.3/solid", 5, "solid.yaml", "contact.volume_screen=0.3")
MPMFAST_RUN("contact corrections 1/meet", 24, "meet.yaml", "contact.corrections=1")
MPMFAST_RUN("contact corrections 1/corner", 12, "corner.yaml", "contact.corrections=1")
MPMFAST_RUN("contact corrections 1/solid", 5, "solid.yaml", "contact.corrections=1")
MPMFAST_RUN("contact first_correction_share 0.2/meet", 24, "meet.yaml", "contact.first_correction_share=0.2")
MPMFAST_RUN("contact first_correction_share 0.2/corner", 12, "corner.yaml",
            "contact.first_correction_share=0.2")
MPMFAST_RUN("contact first_correction_share 0.2/solid", 5, "solid.yaml", "contact.first_correction_share=0.2")
MPMFAST_RUN("contact penalty 1e-3/meet", 24, "meet.yaml",
            "contact.penalty=1e-3; contact.normal=logistic_regression")
MPMFAST_RUN("contact penalty 1e-3/corner", 12, "corner.yaml",
            "contact.penalty=1e-3; contact.normal=logistic_regression")
MPMFAST_RUN("contact penalty 1e-3/solid", 5, "solid.yaml",
            "contact.penalty=1e-3; contact.normal=logistic_regression")
MPMFAST_RUN("contact offset_penalty 1e-2/meet", 24, "meet.yaml",
            "contact.offset_penalty=1e-2; contact.normal=logistic_regression")
MPMFAST_RUN("contact offset_penalty 1e-2/corner", 12, "corner.yaml",
            "contact.offset_penalty=1e-2; contact.normal=logistic_regression")
MPMFAST_RUN("contact offset_penalty 1e-2/solid", 5, "solid.yaml",
            "contact.offset_penalty=1e-2; contact.normal=logistic_regression")
MPMFAST_RUN("contact max_iterations 2/meet", 24, "meet.yaml",
            "contact.max_iterations=2; contact.normal=logistic_regression")
MPMFAST_RUN("contact max_iterations 2/corner", 6, "corner.yaml",
            "contact.max_iterations=2; contact.normal=logistic_regression")
MPMFAST_RUN("contact max_iterations 2/solid", 5, "solid.yaml",
            "contact.max_iterations=2; contact.normal=logistic_regression")
MPMFAST_RUN("contact tolerance 1e-2/meet", 24, "meet.yaml",
            "contact.tolerance=1e-2; contact.normal=logistic_regression")
MPMFAST_RUN("contact tolerance 1e-2/corner", 12, "corner.yaml",
            "contact.tolerance=1e-2; contact.normal=logistic_regression")
MPMFAST_RUN("contact tolerance 1e-2/solid", 5, "solid.yaml",
            "contact.tolerance=1e-2; contact.normal=logistic_regression")
MPMFAST_RUN("law frictionless/joined", 40, "joined.yaml",
            "contact={law: frictionless, pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, "
            "hard], law: ignore}]}")
MPMFAST_RUN(
    "law frictionless/joined linear integrated", 40, "joined.yaml",
    "contact={law: frictionless, jumps: integrated, area: nodal_volume, pairs: [{between: [low, drawn], "
    "friction: 0.2}, {materials: [hard, hard], law: ignore}]}; method={basis: linear, update: fmpm(2)}")
MPMFAST_RUN("law frictionless/joined3", 10, "joined3.yaml", "contact={law: frictionless}")
MPMFAST_RUN("law frictionless/axisymmetric", 30, "joined_axis.yaml", "contact={law: frictionless}")
MPMFAST_RUN("law frictionless/corner", 12, "corner.yaml", "contact={law: frictionless}")
MPMFAST_RUN("law frictionless/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: frictionless}")
MPMFAST_RUN("law stick/joined", 40, "joined.yaml",
            "contact={law: stick, pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], "
            "law: ignore}]}")
MPMFAST_RUN(
    "law stick/joined ugimp integrated", 40, "joined.yaml",
    "contact={law: stick, jumps: integrated, area: nodal_volume, pairs: [{between: [low, drawn], friction: "
    "0.2}, {materials: [hard, hard], law: ignore}]}; method={basis: ugimp, update: xpic(2)}")
MPMFAST_RUN("law stick/joined3", 10, "joined3.yaml", "contact={law: stick}")
MPMFAST_RUN("law stick/corner", 12, "corner.yaml", "contact={law: stick}")
MPMFAST_RUN("law stick/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: stick}")
MPMFAST_RUN("law perfect/joined", 40, "joined.yaml",
            "contact={law: perfect, pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, "
            "hard], law: ignore}]}")
MPMFAST_RUN(
    "law perfect/joined lcpdi integrated", 40, "joined.yaml",
    "contact={law: perfect, jumps: integrated, area: nodal_volume, pairs: [{between: [low, drawn], friction: "
    "0.2}, {materials: [hard, hard], law: ignore}]}; method={basis: lcpdi, update: fmpm(2)}")
MPMFAST_RUN("law perfect/joined3", 10, "joined3.yaml", "contact={law: perfect}")
MPMFAST_RUN("law perfect/axisymmetric", 30, "joined_axis.yaml", "contact={law: perfect}")
MPMFAST_RUN("law perfect/corner", 12, "corner.yaml", "contact={law: perfect}")
MPMFAST_RUN("law perfect/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: perfect}")
MPMFAST_RUN("law ignore/joined", 40, "joined.yaml",
            "contact={law: ignore, pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], "
            "law: ignore}]}")
MPMFAST_RUN(
    "law ignore/joined qcpdi integrated", 40, "joined.yaml",
    "contact={law: ignore, jumps: integrated, area: nodal_volume, pairs: [{between: [low, drawn], friction: "
    "0.2}, {materials: [hard, hard], law: ignore}]}; method={basis: qcpdi, update: xpic(2)}")
MPMFAST_RUN("law ignore/joined3", 10, "joined3.yaml", "contact={law: ignore}")
MPMFAST_RUN("law ignore/axisymmetric", 30, "joined_axis.yaml", "contact={law: ignore}")
MPMFAST_RUN("law ignore/corner", 12, "corner.yaml", "contact={law: ignore}")
MPMFAST_RUN("law adhesion/joined", 40, "joined.yaml",
            "contact={law: adhesion, friction: 0.3, normal_strength: 40 kPa, shear_strength: 30 kPa, reach: "
            "0.1, pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN("law adhesion/joined bspline2 integrated", 40, "joined.yaml",
            "contact={law: adhesion, friction: 0.3, normal_strength: 40 kPa, shear_strength: 30 kPa, reach: "
            "0.1, jumps: integrated, area: nodal_volume, pairs: [{between: [low, drawn], friction: 0.2}, "
            "{materials: [hard, hard], law: ignore}]}; method={basis: bspline2, update: fmpm(2)}")
MPMFAST_RUN(
    "law adhesion/joined3", 10, "joined3.yaml",
    "contact={law: adhesion, friction: 0.3, normal_strength: 40 kPa, shear_strength: 30 kPa, reach: 0.1}")
MPMFAST_RUN(
    "law adhesion/corner", 12, "corner.yaml",
    "contact={law: adhesion, friction: 0.3, normal_strength: 40 kPa, shear_strength: 30 kPa, reach: 0.1}")
MPMFAST_RUN("law adhesion/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: adhesion, friction: 0.3, normal_strength: 40 kPa, "
            "shear_strength: 30 kPa, reach: 0.1}")
MPMFAST_RUN("law velocity_friction/joined", 40, "joined.yaml",
            "contact={law: velocity_friction, friction: 0.1, static_friction: 0.5, decay_speed: 1 m/s, "
            "pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN("law velocity_friction/joined bspline3 integrated", 40, "joined.yaml",
            "contact={law: velocity_friction, friction: 0.1, static_friction: 0.5, decay_speed: 1 m/s, "
            "jumps: integrated, area: nodal_volume, pairs: [{between: [low, drawn], friction: 0.2}, "
            "{materials: [hard, hard], law: ignore}]}; method={basis: bspline3, update: xpic(2)}")
MPMFAST_RUN("law velocity_friction/joined3", 10, "joined3.yaml",
            "contact={law: velocity_friction, friction: 0.1, static_friction: 0.5, decay_speed: 1 m/s}")
MPMFAST_RUN("law velocity_friction/axisymmetric", 30, "joined_axis.yaml",
            "contact={law: velocity_friction, friction: 0.1, static_friction: 0.5, decay_speed: 1 m/s}")
MPMFAST_RUN("law velocity_friction/corner", 12, "corner.yaml",
            "contact={law: velocity_friction, friction: 0.1, static_friction: 0.5, decay_speed: 1 m/s}")
MPMFAST_RUN("law viscous/joined", 40, "joined.yaml",
            "contact={law: viscous, viscosity: 20 Pa*s, film: 0.1 mm, pairs: [{between: [low, drawn], "
            "friction: 0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN("law viscous/joined linear integrated", 40, "joined.yaml",
            "contact={law: viscous, viscosity: 20 Pa*s, film: 0.1 mm, jumps: integrated, area: nodal_volume, "
            "pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}; "
            "method={basis: linear, update: fmpm(2)}")
MPMFAST_RUN("law viscous/joined3", 10, "joined3.yaml",
            "contact={law: viscous, viscosity: 20 Pa*s, film: 0.1 mm}")
MPMFAST_RUN("law viscous/corner", 12, "corner.yaml",
            "contact={law: viscous, viscosity: 20 Pa*s, film: 0.1 mm}")
MPMFAST_RUN("law viscous/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: viscous, viscosity: 20 Pa*s, film: 0.1 mm}")
MPMFAST_RUN("law static/joined", 40, "joined.yaml",
            "contact={law: coulomb, friction: 0.2, static_friction: 0.6, pairs: [{between: [low, drawn], "
            "friction: 0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN("law static/joined ugimp integrated", 40, "joined.yaml",
            "contact={law: coulomb, friction: 0.2, static_friction: 0.6, jumps: integrated, area: "
            "nodal_volume, pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: "
            "ignore}]}; method={basis: ugimp, update: xpic(2)}")
MPMFAST_RUN("law static/joined3", 10, "joined3.yaml",
            "contact={law: coulomb, friction: 0.2, static_friction: 0.6}")
MPMFAST_RUN("law static/axisymmetric", 30, "joined_axis.yaml",
            "contact={law: coulomb, friction: 0.2, static_friction: 0.6}")
MPMFAST_RUN("law static/corner", 12, "corner.yaml",
            "contact={law: coulomb, friction: 0.2, static_friction: 0.6}")
MPMFAST_RUN("law static/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: coulomb, friction: 0.2, static_friction: 0.6}")
MPMFAST_RUN("law interface/joined", 40, "joined.yaml",
            "contact={law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m, pairs: "
            "[{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN("law interface/joined lcpdi integrated", 40, "joined.yaml",
            "contact={law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m, jumps: "
            "integrated, area: nodal_volume, pairs: [{between: [low, drawn], friction: 0.2}, {materials: "
            "[hard, hard], law: ignore}]}; method={basis: lcpdi, update: fmpm(2)}")
MPMFAST_RUN("law interface/joined3", 10, "joined3.yaml",
            "contact={law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m}")
MPMFAST_RUN(
    "law interface/crack", 24, "crack.yaml",
    "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], [9.3 "
    "mm, 11.1 mm]], contour: 2.5, law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m}")
MPMFAST_RUN("law interface pressed/joined", 40, "joined.yaml",
            "contact={law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m, "
            "compression_stiffness: 2e10 Pa/m, friction: 0.3, pairs: [{between: [low, drawn], friction: "
            "0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN(
    "law interface pressed/joined qcpdi integrated", 40, "joined.yaml",
    "contact={law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m, compression_stiffness: "
    "2e10 Pa/m, friction: 0.3, jumps: integrated, area: nodal_volume, pairs: [{between: [low, drawn], "
    "friction: 0.2}, {materials: [hard, hard], law: ignore}]}; method={basis: qcpdi, update: xpic(2)}")
MPMFAST_RUN("law interface pressed/joined3", 10, "joined3.yaml",
            "contact={law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m, "
            "compression_stiffness: 2e10 Pa/m, friction: 0.3}")
MPMFAST_RUN("law interface pressed/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: "
            "1e9 Pa/m, compression_stiffness: 2e10 Pa/m, friction: 0.3}")
MPMFAST_RUN(
    "law interface contact/joined", 40, "joined.yaml",
    "contact={law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m, compression: contact, "
    "friction: 0.3, pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN(
    "law interface contact/joined bspline2 integrated", 40, "joined.yaml",
    "contact={law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m, compression: contact, "
    "friction: 0.3, jumps: integrated, area: nodal_volume, pairs: [{between: [low, drawn], friction: 0.2}, "
    "{materials: [hard, hard], law: ignore}]}; method={basis: bspline2, update: fmpm(2)}")
MPMFAST_RUN("law interface contact/joined3", 10, "joined3.yaml",
            "contact={law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m, compression: "
            "contact, friction: 0.3}")
MPMFAST_RUN("law interface contact/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: "
            "1e9 Pa/m, compression: contact, friction: 0.3}")
MPMFAST_RUN("law curves/joined", 40, "joined.yaml",
            "contact={law: nonlinear_interface, normal_curve: [[-0.1 mm, -0.5 MPa], [0 mm, 0 Pa], [0.05 mm, "
            "0.1 MPa], [0.2 mm, 0.12 MPa]], shear_curve: [[0 mm, 0 Pa], [0.1 mm, 0.05 MPa], [0.2 mm, 0.02 "
            "MPa]], pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN("law curves/joined bspline3 integrated", 40, "joined.yaml",
            "contact={law: nonlinear_interface, normal_curve: [[-0.1 mm, -0.5 MPa], [0 mm, 0 Pa], [0.05 mm, "
            "0.1 MPa], [0.2 mm, 0.12 MPa]], shear_curve: [[0 mm, 0 Pa], [0.1 mm, 0.05 MPa], [0.2 mm, 0.02 "
            "MPa]], jumps: integrated, area: nodal_volume, pairs: [{between: [low, drawn], friction: 0.2}, "
            "{materials: [hard, hard], law: ignore}]}; method={basis: bspline3, update: xpic(2)}")
MPMFAST_RUN(
    "law curves/joined3", 10, "joined3.yaml",
    "contact={law: nonlinear_interface, normal_curve: [[-0.1 mm, -0.5 MPa], [0 mm, 0 Pa], [0.05 mm, 0.1 "
    "MPa], [0.2 mm, 0.12 MPa]], shear_curve: [[0 mm, 0 Pa], [0.1 mm, 0.05 MPa], [0.2 mm, 0.02 MPa]]}")
MPMFAST_RUN("law curves/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: nonlinear_interface, normal_curve: [[-0.1 mm, -0.5 MPa], "
            "[0 mm, 0 Pa], [0.05 mm, 0.1 MPa], [0.2 mm, 0.12 MPa]], shear_curve: [[0 mm, 0 Pa], [0.1 mm, "
            "0.05 MPa], [0.2 mm, 0.02 MPa]]}")
MPMFAST_RUN("law cohesive/joined", 40, "joined.yaml",
            "contact={law: cohesive, normal_strength: 60 kPa, shear_strength: 50 kPa, normal_toughness: 3 "
            "J/m^2, shear_toughness: 5 J/m^2, friction: 0.3, crack: {from: [0 mm, 0 mm], to: [4 mm, 14 mm]}, "
            "pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN("law cohesive/joined linear integrated", 40, "joined.yaml",
            "contact={law: cohesive, normal_strength: 60 kPa, shear_strength: 50 kPa, normal_toughness: 3 "
            "J/m^2, shear_toughness: 5 J/m^2, friction: 0.3, jumps: integrated, area: nodal_volume, pairs: "
            "[{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}; "
            "method={basis: linear, update: fmpm(2)}")
MPMFAST_RUN("law cohesive/joined3", 10, "joined3.yaml",
            "contact={law: cohesive, normal_strength: 60 kPa, shear_strength: 50 kPa, normal_toughness: 3 "
            "J/m^2, shear_toughness: 5 J/m^2, friction: 0.3}")
MPMFAST_RUN("law cohesive/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: cohesive, normal_strength: 60 kPa, shear_strength: 50 "
            "kPa, normal_toughness: 3 J/m^2, shear_toughness: 5 J/m^2, friction: 0.3}")
MPMFAST_RUN(
    "law cohesive exponential/joined", 40, "joined.yaml",
    "contact={law: cohesive, shape: exponential, normal_strength: 60 kPa, shear_strength: 50 kPa, "
    "normal_toughness: 3 J/m^2, shear_toughness: 5 J/m^2, mode_exponent: 2, initial_stiffness: 1e10 Pa/m, "
    "compression_stiffness: 3e10 Pa/m, friction: 0.2, crack: {from: [0 mm, 0 mm], to: [4 mm, 14 mm]}, pairs: "
    "[{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN("law cohesive exponential/joined ugimp integrated", 40, "joined.yaml",
            "contact={law: cohesive, shape: exponential, normal_strength: 60 kPa, shear_strength: 50 kPa, "
            "normal_toughness: 3 J/m^2, shear_toughness: 5 J/m^2, mode_exponent: 2, initial_stiffness: 1e10 "
            "Pa/m, compression_stiffness: 3e10 Pa/m, friction: 0.2, jumps: integrated, area: nodal_volume, "
            "pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}; "
            "method={basis: ugimp, update: xpic(2)}")
MPMFAST_RUN("law cohesive exponential/joined3", 10, "joined3.yaml",
            "contact={law: cohesive, shape: exponential, normal_strength: 60 kPa, shear_strength: 50 kPa, "
            "normal_toughness: 3 J/m^2, shear_toughness: 5 J/m^2, mode_exponent: 2, initial_stiffness: 1e10 "
            "Pa/m, compression_stiffness: 3e10 Pa/m, friction: 0.2}")
MPMFAST_RUN("law cohesive exponential/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: cohesive, shape: exponential, normal_strength: 60 kPa, "
            "shear_strength: 50 kPa, normal_toughness: 3 J/m^2, shear_toughness: 5 J/m^2, mode_exponent: 2, "
            "initial_stiffness: 1e10 Pa/m, compression_stiffness: 3e10 Pa/m, friction: 0.2}")
MPMFAST_RUN("law cohesive trapezoidal/joined", 40, "joined.yaml",
            "contact={law: cohesive, shape: trapezoidal, plateau: 0.3, normal_strength: 60 kPa, "
            "shear_strength: 50 kPa, normal_toughness: 3 J/m^2, shear_toughness: 5 J/m^2, compression: "
            "contact, friction: 0.3, crack: {from: [0 mm, 0 mm], to: [4 mm, 14 mm]}, pairs: [{between: [low, "
            "drawn], friction: 0.2}, {materials: [hard, hard], law: ignore}]}")
MPMFAST_RUN(
    "law cohesive trapezoidal/joined lcpdi integrated", 40, "joined.yaml",
    "contact={law: cohesive, shape: trapezoidal, plateau: 0.3, normal_strength: 60 kPa, shear_strength: 50 "
    "kPa, normal_toughness: 3 J/m^2, shear_toughness: 5 J/m^2, compression: contact, friction: 0.3, jumps: "
    "integrated, area: nodal_volume, pairs: [{between: [low, drawn], friction: 0.2}, {materials: [hard, "
    "hard], law: ignore}]}; method={basis: lcpdi, update: fmpm(2)}")
MPMFAST_RUN(
    "law cohesive trapezoidal/joined3", 10, "joined3.yaml",
    "contact={law: cohesive, shape: trapezoidal, plateau: 0.3, normal_strength: 60 kPa, shear_strength: 50 "
    "kPa, normal_toughness: 3 J/m^2, shear_toughness: 5 J/m^2, compression: contact, friction: 0.3}")
MPMFAST_RUN("law cohesive trapezoidal/crack", 24, "crack.yaml",
            "contact.friction=0.1; cracks.0={name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], "
            "[9.3 mm, 11.1 mm]], contour: 2.5, law: cohesive, shape: trapezoidal, plateau: 0.3, "
            "normal_strength: 60 kPa, shear_strength: 50 kPa, normal_toughness: 3 J/m^2, shear_toughness: 5 "
            "J/m^2, compression: contact, friction: 0.3}")
MPMFAST_RUN("crack/linear", 24, "crack.yaml", "method={basis: linear, update: flip}")
MPMFAST_RUN("crack/linear grows", 40, "crack.yaml",
            "method.basis=linear; cracks.0.growth={toughness: 1 J/m^2}; cracks.1.growth={toughness: 1 J/m^2, "
            "advance: 0.4, zone: 3}")
MPMFAST_RUN("crack/ugimp", 24, "crack.yaml", "method={basis: ugimp, update: pic}")
MPMFAST_RUN("crack/ugimp grows", 40, "crack.yaml",
            "method.basis=ugimp; cracks.0.growth={toughness: 1 J/m^2, rule: energy}; "
            "cracks.1.growth={toughness: 1 J/m^2, advance: 0.4, zone: 3}")
MPMFAST_RUN("crack/lcpdi", 24, "crack.yaml", "method={basis: lcpdi, update: xpic(3)}")
MPMFAST_RUN("crack/lcpdi grows", 40, "crack.yaml",
            "method.basis=lcpdi; cracks.0.growth={toughness: 1 J/m^2}; cracks.1.growth={toughness: 1 J/m^2, "
            "advance: 0.4, zone: 3}")
MPMFAST_RUN("crack/qcpdi", 24, "crack.yaml", "method={basis: qcpdi, update: fmpm(2)}")
MPMFAST_RUN("crack/qcpdi grows", 40, "crack.yaml",
            "method.basis=qcpdi; cracks.0.growth={toughness: 1 J/m^2, rule: energy}; "
            "cracks.1.growth={toughness: 1 J/m^2, advance: 0.4, zone: 3}")
MPMFAST_RUN("crack/bspline2", 18, "crack.yaml", "method={basis: bspline2, update: flip}")
MPMFAST_RUN("crack/bspline2 grows", 40, "crack.yaml",
            "method.basis=bspline2; cracks.0.growth={toughness: 1 J/m^2}; cracks.1.growth={toughness: 1 "
            "J/m^2, advance: 0.4, zone: 3}")
MPMFAST_RUN("crack/bspline3", 24, "crack.yaml", "method={basis: bspline3, update: pic}")
MPMFAST_RUN("crack/bspline3 grows", 40, "crack.yaml",
            "method.basis=bspline3; cracks.0.growth={toughness: 1 J/m^2, rule: energy}; "
            "cracks.1.growth={toughness: 1 J/m^2, advance: 0.4, zone: 3}")
MPMFAST_RUN("crack/crossing", 24, "crack.yaml",
            "cracks.1={name: across, body: plate, line: [[7.1 mm, 2 mm], [8.2 mm, 18 mm]], law: coulomb, "
            "friction: 0.2}")
MPMFAST_RUN("crack/plane_stress", 20, "crack.yaml", "space=plane_stress; cracks.0.growth.toughness=1 J/m^2")
MPMFAST_RUN("crack/spacing", 24, "crack.yaml", "cracks.0.spacing=0.9 mm; cracks.1.spacing=0.2 mm")
MPMFAST_RUN("walls at nodes/linear", 30, "walls.yaml",
            "method={basis: linear, update: flip}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes; boundaries.top.held=true")
MPMFAST_RUN("walls at nodes/ugimp", 30, "walls.yaml",
            "method={basis: ugimp, update: pic}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes; boundaries.top.held=true")
MPMFAST_RUN("walls at nodes/lcpdi", 30, "walls.yaml",
            "method={basis: lcpdi, update: xpic(3)}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes; boundaries.top.held=true")
MPMFAST_RUN("walls at nodes/qcpdi", 30, "walls.yaml",
            "method={basis: qcpdi, update: fmpm(2)}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes; boundaries.top.held=true")
MPMFAST_RUN("walls at nodes/bspline2", 30, "walls.yaml",
            "method={basis: bspline2, update: flip}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes; boundaries.top.held=true")
MPMFAST_RUN("walls at nodes/bspline3", 30, "walls.yaml",
            "method={basis: bspline3, update: pic}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes; boundaries.top.held=true")
MPMFAST_RUN("walls at nodes/solid", 10, "walls3.yaml",
            "boundaries.left.at=nodes; boundaries.bottom.at=nodes; boundaries.back.at=nodes; "
            "boundaries.front.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("walls at nodes/solid xpic", 10, "walls3.yaml",
            "boundaries.left.at=nodes; boundaries.bottom.at=nodes; boundaries.back.at=nodes; "
            "boundaries.front.at=nodes; boundaries.top.at=nodes; method={update: xpic(2), basis: bspline2}")
MPMFAST_RUN("walls at nodes/axisymmetric", 30, "walls_axis.yaml",
            "method.update=pic; boundaries.right.at=nodes; boundaries.bottom.at=nodes; "
            "boundaries.top.at=nodes; boundaries.top.held=true")
MPMFAST_RUN("walls at nodes/extended", 30, "walls.yaml",
            "boundaries.left.at=nodes; boundaries.right.at=nodes; boundaries.bottom.at=nodes; "
            "boundaries.top.at=nodes; boundaries.top.held=true; contact=none; method={basis: bspline2, "
            "extension: {occupation: 0.6}}")
MPMFAST_RUN(
    "walls at nodes/one field", 30, "walls.yaml",
    "boundaries.left.at=nodes; boundaries.right.at=nodes; boundaries.bottom.at=nodes; "
    "boundaries.top.at=nodes; boundaries.top.held=true; contact=none; method={strain: last+, update: pic}")
MPMFAST_RUN("walls at plane/linear", 30, "walls.yaml",
            "method={basis: linear, update: flip}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane; boundaries.top.held=true")
MPMFAST_RUN("walls at plane/ugimp", 30, "walls.yaml",
            "method={basis: ugimp, update: pic}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane; boundaries.top.held=true")
MPMFAST_RUN("walls at plane/lcpdi", 30, "walls.yaml",
            "method={basis: lcpdi, update: xpic(3)}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane; boundaries.top.held=true")
MPMFAST_RUN("walls at plane/qcpdi", 30, "walls.yaml",
            "method={basis: qcpdi, update: fmpm(2)}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane; boundaries.top.held=true")
MPMFAST_RUN("walls at plane/bspline2", 30, "walls.yaml",
            "method={basis: bspline2, update: flip}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane; boundaries.top.held=true")
MPMFAST_RUN("walls at plane/bspline3", 30, "walls.yaml",
            "method={basis: bspline3, update: pic}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane; boundaries.top.held=true")
MPMFAST_RUN("walls at plane/solid", 10, "walls3.yaml",
            "boundaries.left.at=plane; boundaries.bottom.at=plane; boundaries.back.at=plane; "
            "boundaries.front.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("walls at plane/solid xpic", 10, "walls3.yaml",
            "boundaries.left.at=plane; boundaries.bottom.at=plane; boundaries.back.at=plane; "
            "boundaries.front.at=plane; boundaries.top.at=plane; method={update: xpic(2), basis: bspline2}")
MPMFAST_RUN("walls at plane/axisymmetric", 30, "walls_axis.yaml",
            "method.update=pic; boundaries.right.at=plane; boundaries.bottom.at=plane; "
            "boundaries.top.at=plane; boundaries.top.held=true")
MPMFAST_RUN("walls at plane/extended", 30, "walls.yaml",
            "boundaries.left.at=plane; boundaries.right.at=plane; boundaries.bottom.at=plane; "
            "boundaries.top.at=plane; boundaries.top.held=true; contact=none; method={basis: bspline2, "
            "extension: {occupation: 0.6}}")
MPMFAST_RUN(
    "walls at plane/one field", 30, "walls.yaml",
    "boundaries.left.at=plane; boundaries.right.at=plane; boundaries.bottom.at=plane; "
    "boundaries.top.at=plane; boundaries.top.held=true; contact=none; method={strain: last+, update: pic}")
MPMFAST_RUN("walls at surface/lcpdi", 30, "walls.yaml",
            "method={basis: lcpdi, update: xpic(3)}; boundaries.left.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.at=surface; boundaries.top.at=surface; "
            "boundaries.left.friction=0.3; boundaries.top.friction=0.2")
MPMFAST_RUN("walls at surface/qcpdi", 30, "walls.yaml",
            "method={basis: qcpdi, update: fmpm(2)}; boundaries.left.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.at=surface; boundaries.top.at=surface; "
            "boundaries.left.friction=0.3; boundaries.top.friction=0.2")
MPMFAST_RUN("walls at surface/bspline2", 5, "walls.yaml",
            "method={basis: bspline2, update: flip}; boundaries.left.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.at=surface; boundaries.top.at=surface; "
            "boundaries.left.friction=0.3; boundaries.top.friction=0.2")
MPMFAST_RUN("walls at surface/bspline3", 30, "walls.yaml",
            "method={basis: bspline3, update: pic}; boundaries.left.at=surface; boundaries.right.at=surface; "
            "boundaries.bottom.at=surface; boundaries.top.at=surface; boundaries.left.friction=0.3; "
            "boundaries.top.friction=0.2")
MPMFAST_RUN(
    "walls at surface/bspline3 flip more", 20, "walls.yaml",
    "method={basis: bspline3, update: flip}; boundaries.left.at=surface; boundaries.right.at=surface; "
    "boundaries.bottom.at=surface; boundaries.top.at=surface; boundaries.left.friction=0")
MPMFAST_RUN("walls at surface/strain first", 20, "walls.yaml",
            "method={update: pic, strain: first}; boundaries.left.at=surface; boundaries.right.at=surface; "
            "boundaries.bottom.at=surface; boundaries.top.at=surface; boundaries.left.friction=0.3; "
            "boundaries.top.friction=0.2")
MPMFAST_RUN("walls at surface/strain average", 20, "walls.yaml",
            "method={update: xpic(2), strain: average}; boundaries.left.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.at=surface; boundaries.top.at=surface; "
            "boundaries.left.friction=0.3; boundaries.top.friction=0.2")
MPMFAST_RUN("walls at surface/solid xpic", 10, "walls3.yaml",
            "boundaries.left.at=surface; boundaries.bottom.at=surface; boundaries.back.at=surface; "
            "boundaries.front.at=surface; boundaries.top.at=surface; boundaries.bottom.friction=0.3; "
            "method={update: xpic(2), basis: bspline2}")
MPMFAST_RUN("walls at surface/axisymmetric", 30, "walls_axis.yaml",
            "method.update=pic; boundaries.right.at=surface; boundaries.bottom.at=surface; "
            "boundaries.top.at=surface; boundaries.top.friction=0.2")
MPMFAST_RUN("walls at surface/one field", 30, "walls.yaml",
            "boundaries.left.at=surface; boundaries.right.at=surface; boundaries.bottom.at=surface; "
            "boundaries.top.at=surface; boundaries.left.friction=0.3; boundaries.top.friction=0.2; "
            "contact=none; method={strain: last+, update: pic}")
MPMFAST_RUN(
    "walls/turned box", 20, "walls.yaml",
    "boundaries={push: {box: {from: [2 mm, 2 mm], to: [5 mm, 5 mm]}, direction: [1, 2], speed: [[0 ms, 1 "
    "m/s], [0.1 ms, 4 m/s]]}, still: {node: [8 mm, 5 mm], direction: [2, -1], speed: 3 m/s}, bottom: wall}")
MPMFAST_RUN("heat/perfect", 30, "heat.yaml", "contact.conductance=perfect")
MPMFAST_RUN("heat/none", 30, "heat.yaml", "contact.conductance=none")
MPMFAST_RUN("heat/gap", 30, "heat.yaml", "contact.gap_conductivity=20 W/m/K")
MPMFAST_RUN("heat/filter 1", 30, "heat.yaml", "heat.filter={order: 1, every: 0.5}")
MPMFAST_RUN("heat/no filter", 30, "heat.yaml", "heat.filter=none")
MPMFAST_RUN("heat/filter every", 30, "heat.yaml", "heat.filter={order: 2, every: 0}")
MPMFAST_RUN("heat/flip", 30, "heat.yaml", "")
MPMFAST_RUN("heat/pair", 30, "heat.yaml",
            "contact.pairs=[{between: [hot, cold], conductance: perfect, friction: 0.5}]")
MPMFAST_RUN("heat/axisymmetric", 30, "heat.yaml",
            "space=axisymmetric; bodies.2.velocity=[0, 0]; boundaries={}; heat.boundaries={top: {ambient: "
            "[[0 ms, 320 K], [1 ms, 400 K]], coefficient: 0.1 MW/m^2/K}, bottom: {flux: 1 MW/m^2}, spot: "
            "{box: {from: [3.6 mm, 7.6 mm], to: [5.2 mm, 9.2 mm]}, temperature: 360 K}}")
MPMFAST_RUN(
    "heat/axis gap", 30, "heat.yaml",
    "space=axisymmetric; bodies.2.velocity=[0, 0]; boundaries={}; heat.boundaries={top: {ambient: [[0 ms, "
    "320 K], [1 ms, 400 K]], coefficient: 0.1 MW/m^2/K}, bottom: {flux: 1 MW/m^2}, spot: {box: {from: [3.6 "
    "mm, 7.6 mm], to: [5.2 mm, 9.2 mm]}, temperature: 360 K}}; contact.gap_conductivity=20 W/m/K")
MPMFAST_RUN("heat/plane_stress", 30, "heat.yaml", "space=plane_stress")
MPMFAST_RUN("heat/lump", 30, "heat.yaml", "contact.fields=lump; contact.normal=average_gradient")
MPMFAST_RUN("heat/one field", 30, "heat.yaml",
            "contact=none; bodies.2.material=cold; bodies.2.velocity=[0, 0]")
MPMFAST_RUN("heat/still", 30, "heat.yaml", "materials.hot.thermal_expansion=0 K^-1; bodies.0.velocity=[0, 0]")
MPMFAST_RUN("heat/linear", 30, "heat.yaml", "method={basis: linear, update: flip}")
MPMFAST_RUN("heat/solid linear", 8, "heat3.yaml", "method.basis=linear")
MPMFAST_RUN("heat/ugimp", 30, "heat.yaml", "method={basis: ugimp, update: pic}")
MPMFAST_RUN("heat/solid ugimp", 8, "heat3.yaml", "method.basis=ugimp")
MPMFAST_RUN("heat/lcpdi", 30, "heat.yaml", "method={basis: lcpdi, update: xpic(3)}")
MPMFAST_RUN("heat/solid lcpdi", 8, "heat3.yaml", "method.basis=lcpdi")
MPMFAST_RUN("heat/qcpdi", 30, "heat.yaml", "method={basis: qcpdi, update: fmpm(2)}")
MPMFAST_RUN("heat/solid qcpdi", 8, "heat3.yaml", "method.basis=qcpdi")
MPMFAST_RUN("heat/bspline2", 30, "heat.yaml", "method={basis: bspline2, update: apic}")
MPMFAST_RUN("heat/solid bspline2", 8, "heat3.yaml", "method.basis=bspline2")
MPMFAST_RUN("heat/bspline3", 30, "heat.yaml", "method={basis: bspline3, update: flip}")
MPMFAST_RUN("heat/solid bspline3", 8, "heat3.yaml", "method.basis=bspline3")
MPMFAST_RUN("heat/film of springs", 30, "heat.yaml",
            "contact={law: interface, normal_stiffness: 3e9 Pa/m, shear_stiffness: 1e9 Pa/m, conductance: "
            "5e5 W/m^2/K}")
MPMFAST_RUN("penalty/bspline2", 30, "meet.yaml",
            "contact={family: penalty, friction: 0.3, stiffness: 2, pairs: [{between: [disk, square], "
            "friction: 0.1, static_friction: 0.2}]}; method={basis: bspline2, update: flip}")
MPMFAST_RUN("penalty/solid bspline2", 8, "solid.yaml",
            "contact={family: penalty, friction: 0.3, stiffness: 2, pairs: [{between: [egg, block], "
            "friction: 0.1}]}; method={basis: bspline2}")
MPMFAST_RUN("penalty/bspline3", 30, "meet.yaml",
            "contact={family: penalty, friction: 0.3, stiffness: 2, pairs: [{between: [disk, square], "
            "friction: 0.1, static_friction: 0.2}]}; method={basis: bspline3, update: pic}")
MPMFAST_RUN("penalty/solid bspline3", 8, "solid.yaml",
            "contact={family: penalty, friction: 0.3, stiffness: 2, pairs: [{between: [egg, block], "
            "friction: 0.1}]}; method={basis: bspline3}")
MPMFAST_RUN("penalty/ugimp", 30, "meet.yaml",
            "contact={family: penalty, friction: 0.3, stiffness: 2, pairs: [{between: [disk, square], "
            "friction: 0.1, static_friction: 0.2}]}; method={basis: ugimp, update: xpic(3)}")
MPMFAST_RUN("penalty/solid ugimp", 8, "solid.yaml",
            "contact={family: penalty, friction: 0.3, stiffness: 2, pairs: [{between: [egg, block], "
            "friction: 0.1}]}; method={basis: ugimp}")
MPMFAST_RUN("penalty/lcpdi", 30, "meet.yaml",
            "contact={family: penalty, friction: 0.3, stiffness: 2, pairs: [{between: [disk, square], "
            "friction: 0.1, static_friction: 0.2}]}; method={basis: lcpdi, update: fmpm(2)}")
MPMFAST_RUN("penalty/solid lcpdi", 8, "solid.yaml",
            "contact={family: penalty, friction: 0.3, stiffness: 2, pairs: [{between: [egg, block], "
            "friction: 0.1}]}; method={basis: lcpdi}")
MPMFAST_RUN(
    "penalty/extended", 30, "meet.yaml",
    "contact={family: penalty, friction: 0.3, stiffness: 2, pairs: [{between: [disk, square], friction: 0.1, "
    "static_friction: 0.2}]}; method={basis: bspline2, extension: {occupation: 0.75}, update: fmpm(2)}")
MPMFAST_RUN("penalty/stick", 30, "meet.yaml",
            "contact={family: penalty, law: stick, tangential_stiffness: 0.5, points_per_cell: 3}")
MPMFAST_RUN("penalty/frictionless", 30, "meet.yaml",
            "contact={family: penalty, law: frictionless, points_per_cell: 4}; method={basis: bspline2, "
            "extension: {occupation: 0.6}}")
MPMFAST_RUN("penalty/corner", 20, "corner.yaml",
            "contact={family: penalty, friction: 0.3, points_per_cell: 3, pairs: [{between: [a, b], "
            "friction: 0.1}]}; method.basis=bspline2")
MPMFAST_RUN(
    "material neo_hookean/plane", 40, "metal.yaml",
    "materials.m={model: neo_hookean, density: 1 g/cm^3, bulk: 80 MPa, shear: 30 MPa}; method.basis=linear")
MPMFAST_RUN("material neo_hookean/axisymmetric", 40, "metal.yaml",
            "space=axisymmetric; materials.m={model: neo_hookean, density: 1 g/cm^3, bulk: 80 MPa, shear: 30 "
            "MPa}; method.basis=ugimp")
MPMFAST_RUN(
    "material neo_hookean/solid", 12, "metal3.yaml",
    "materials.m={model: neo_hookean, density: 1 g/cm^3, bulk: 80 MPa, shear: 30 MPa}; method.basis=lcpdi")
MPMFAST_RUN(
    "material neo_hookean/plane_stress", 40, "metal.yaml",
    "space=plane_stress; materials.m={model: neo_hookean, density: 1 g/cm^3, bulk: 80 MPa, shear: 30 MPa}")
MPMFAST_RUN("material linear_elastic/plane", 40, "metal.yaml",
            "materials.m={model: linear_elastic, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3}; "
            "method.basis=ugimp")
MPMFAST_RUN("material linear_elastic/axisymmetric", 40, "metal.yaml",
            "space=axisymmetric; materials.m={model: linear_elastic, density: 8 g/cm^3, young: 100 GPa, "
            "poisson: 0.3}; method.basis=lcpdi")
MPMFAST_RUN("material linear_elastic/solid", 12, "metal3.yaml",
            "materials.m={model: linear_elastic, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3}; "
            "method.basis=qcpdi")
MPMFAST_RUN("material linear_elastic/plane_stress", 40, "metal.yaml",
            "space=plane_stress; materials.m={model: linear_elastic, density: 8 g/cm^3, young: 100 GPa, "
            "poisson: 0.3}")
MPMFAST_RUN("material logarithmic/plane", 40, "metal.yaml",
            "materials.m={model: logarithmic_neo_hookean, density: 1 g/cm^3, young: 8 GPa, poisson: 0.4}; "
            "method.basis=lcpdi")
MPMFAST_RUN("material logarithmic/axisymmetric", 40, "metal.yaml",
            "space=axisymmetric; materials.m={model: logarithmic_neo_hookean, density: 1 g/cm^3, young: 8 "
            "GPa, poisson: 0.4}; method.basis=qcpdi")
MPMFAST_RUN("material logarithmic/solid", 12, "metal3.yaml",
            "materials.m={model: logarithmic_neo_hookean, density: 1 g/cm^3, young: 8 GPa, poisson: 0.4}; "
            "method.basis=bspline2")
MPMFAST_RUN("material logarithmic/plane_stress", 40, "metal.yaml",
            "space=plane_stress; materials.m={model: logarithmic_neo_hookean, density: 1 g/cm^3, young: 8 "
            "GPa, poisson: 0.4}")
MPMFAST_RUN("material mie_gruneisen/plane", 40, "metal.yaml",
            "materials.m={model: mie_gruneisen, density: 8 g/cm^3, bulk: 100 GPa, shear: 30 GPa, gruneisen: "
            "2, hugoniot_slope: 1.5, linear_viscosity: 0.2, quadratic_viscosity: 2, heat_capacity: 400 "
            "J/kg/K}; method.basis=qcpdi")
MPMFAST_RUN("material mie_gruneisen/axisymmetric", 40, "metal.yaml",
            "space=axisymmetric; materials.m={model: mie_gruneisen, density: 8 g/cm^3, bulk: 100 GPa, shear: "
            "30 GPa, gruneisen: 2, hugoniot_slope: 1.5, linear_viscosity: 0.2, quadratic_viscosity: 2, "
            "heat_capacity: 400 J/kg/K}; method.basis=bspline2")
MPMFAST_RUN("material mie_gruneisen/solid", 12, "metal3.yaml",
            "materials.m={model: mie_gruneisen, density: 8 g/cm^3, bulk: 100 GPa, shear: 30 GPa, gruneisen: "
            "2, hugoniot_slope: 1.5, linear_viscosity: 0.2, quadratic_viscosity: 2, heat_capacity: 400 "
            "J/kg/K}; method.basis=bspline3")
MPMFAST_RUN(
    "material mie_gruneisen/heat", 40, "metal.yaml",
    "materials.m={model: mie_gruneisen, density: 8 g/cm^3, bulk: 100 GPa, shear: 30 GPa, gruneisen: 2, "
    "hugoniot_slope: 1.5, linear_viscosity: 0.2, quadratic_viscosity: 2, heat_capacity: 400 J/kg/K, "
    "conductivity: 5 kW/m/K}; heat={temperature: 310 K, boundaries: {bottom: {temperature: 350 K}}}")
MPMFAST_RUN("material j2/plane", 40, "metal.yaml",
            "materials.m={model: j2_plasticity, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 300 "
            "MPa, hardening: 1 GPa}; method.basis=bspline2")
MPMFAST_RUN("material j2/axisymmetric", 40, "metal.yaml",
            "space=axisymmetric; materials.m={model: j2_plasticity, density: 8 g/cm^3, young: 100 GPa, "
            "poisson: 0.3, yield: 300 MPa, hardening: 1 GPa}; method.basis=bspline3")
MPMFAST_RUN("material j2/solid", 12, "metal3.yaml",
            "materials.m={model: j2_plasticity, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 300 "
            "MPa, hardening: 1 GPa}; method.basis=linear")
MPMFAST_RUN(
    "material j2 eos/plane", 40, "metal.yaml",
    "materials.m={model: j2_plasticity, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 300 MPa, "
    "hardening: 1 GPa, taylor_quinney: 0.8, heat_capacity: 400 J/kg/K, equation_of_state: {gruneisen: 2, "
    "hugoniot_slope: 1.49, linear_viscosity: 0.2, quadratic_viscosity: 2}}; method.basis=bspline3")
MPMFAST_RUN("material j2 eos/axisymmetric", 40, "metal.yaml",
            "space=axisymmetric; materials.m={model: j2_plasticity, density: 8 g/cm^3, young: 100 GPa, "
            "poisson: 0.3, yield: 300 MPa, hardening: 1 GPa, taylor_quinney: 0.8, heat_capacity: 400 J/kg/K, "
            "equation_of_state: {gruneisen: 2, hugoniot_slope: 1.49, linear_viscosity: 0.2, "
            "quadratic_viscosity: 2}}; method.basis=linear")
MPMFAST_RUN(
    "material j2 eos/solid", 12, "metal3.yaml",
    "materials.m={model: j2_plasticity, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 300 MPa, "
    "hardening: 1 GPa, taylor_quinney: 0.8, heat_capacity: 400 J/kg/K, equation_of_state: {gruneisen: 2, "
    "hugoniot_slope: 1.49, linear_viscosity: 0.2, quadratic_viscosity: 2}}; method.basis=ugimp")
MPMFAST_RUN("material j2 eos/heat", 40, "metal.yaml",
            "materials.m={model: j2_plasticity, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 300 "
            "MPa, hardening: 1 GPa, taylor_quinney: 0.8, heat_capacity: 400 J/kg/K, equation_of_state: "
            "{gruneisen: 2, hugoniot_slope: 1.49, linear_viscosity: 0.2, quadratic_viscosity: 2}, "
            "conductivity: 5 kW/m/K}; heat={temperature: 310 K, boundaries: {bottom: {temperature: 350 K}}}")
MPMFAST_RUN("material johnson_cook/plane", 40, "metal.yaml",
            "materials.m={model: johnson_cook, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 90 "
            "MPa, hardening: 292 MPa, exponent: 0.31, rate_factor: 0.025, reference_rate: 1 s^-1, softening: "
            "1.09, melt: 1356 K, temperature: 294 K, heat_capacity: 383 J/kg/K}; method.basis=linear")
MPMFAST_RUN(
    "material johnson_cook/axisymmetric", 40, "metal.yaml",
    "space=axisymmetric; materials.m={model: johnson_cook, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, "
    "yield: 90 MPa, hardening: 292 MPa, exponent: 0.31, rate_factor: 0.025, reference_rate: 1 s^-1, "
    "softening: 1.09, melt: 1356 K, temperature: 294 K, heat_capacity: 383 J/kg/K}; method.basis=ugimp")
MPMFAST_RUN("material johnson_cook/solid", 12, "metal3.yaml",
            "materials.m={model: johnson_cook, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 90 "
            "MPa, hardening: 292 MPa, exponent: 0.31, rate_factor: 0.025, reference_rate: 1 s^-1, softening: "
            "1.09, melt: 1356 K, temperature: 294 K, heat_capacity: 383 J/kg/K}; method.basis=lcpdi")
MPMFAST_RUN("material johnson_cook/heat", 40, "metal.yaml",
            "materials.m={model: johnson_cook, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 90 "
            "MPa, hardening: 292 MPa, exponent: 0.31, rate_factor: 0.025, reference_rate: 1 s^-1, softening: "
            "1.09, melt: 1356 K, temperature: 294 K, heat_capacity: 383 J/kg/K, conductivity: 5 kW/m/K}; "
            "heat={temperature: 310 K, boundaries: {bottom: {temperature: 350 K}}}")
MPMFAST_RUN("material johnson_cook eos/plane", 40, "metal.yaml",
            "materials.m={model: johnson_cook, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 90 "
            "MPa, hardening: 292 MPa, exponent: 0.31, rate_factor: 0.025, softening: 1.09, melt: 500 K, "
            "temperature: 294 K, heat_capacity: 383 J/kg/K, equation_of_state: {gruneisen: 2, "
            "hugoniot_slope: 1.49, linear_viscosity: 0.2, quadratic_viscosity: 2}}; method.basis=ugimp")
MPMFAST_RUN(
    "material johnson_cook eos/axisymmetric", 40, "metal.yaml",
    "space=axisymmetric; materials.m={model: johnson_cook, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, "
    "yield: 90 MPa, hardening: 292 MPa, exponent: 0.31, rate_factor: 0.025, softening: 1.09, melt: 500 K, "
    "temperature: 294 K, heat_capacity: 383 J/kg/K, equation_of_state: {gruneisen: 2, hugoniot_slope: 1.49, "
    "linear_viscosity: 0.2, quadratic_viscosity: 2}}; method.basis=lcpdi")
MPMFAST_RUN("material johnson_cook eos/solid", 12, "metal3.yaml",
            "materials.m={model: johnson_cook, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 90 "
            "MPa, hardening: 292 MPa, exponent: 0.31, rate_factor: 0.025, softening: 1.09, melt: 500 K, "
            "temperature: 294 K, heat_capacity: 383 J/kg/K, equation_of_state: {gruneisen: 2, "
            "hugoniot_slope: 1.49, linear_viscosity: 0.2, quadratic_viscosity: 2}}; method.basis=qcpdi")
MPMFAST_RUN("material johnson_cook eos/heat", 40, "metal.yaml",
            "materials.m={model: johnson_cook, density: 8 g/cm^3, young: 100 GPa, poisson: 0.3, yield: 90 "
            "MPa, hardening: 292 MPa, exponent: 0.31, rate_factor: 0.025, softening: 1.09, melt: 500 K, "
            "temperature: 294 K, heat_capacity: 383 J/kg/K, equation_of_state: {gruneisen: 2, "
            "hugoniot_slope: 1.49, linear_viscosity: 0.2, quadratic_viscosity: 2}, conductivity: 5 kW/m/K}; "
            "heat={temperature: 310 K, boundaries: {bottom: {temperature: 350 K}}}")
MPMFAST_RUN("material drucker_prager/plane", 40, "metal.yaml",
            "materials.m={model: drucker_prager, density: 2 g/cm^3, young: 1 GPa, poisson: 0.3, "
            "friction_angle: 32 deg, dilation_angle: 5 deg, cohesion: 1 MPa}; method.basis=lcpdi")
MPMFAST_RUN(
    "material drucker_prager/axisymmetric", 40, "metal.yaml",
    "space=axisymmetric; materials.m={model: drucker_prager, density: 2 g/cm^3, young: 1 GPa, poisson: 0.3, "
    "friction_angle: 32 deg, dilation_angle: 5 deg, cohesion: 1 MPa}; method.basis=qcpdi")
MPMFAST_RUN("material drucker_prager/solid", 12, "metal3.yaml",
            "materials.m={model: drucker_prager, density: 2 g/cm^3, young: 1 GPa, poisson: 0.3, "
            "friction_angle: 32 deg, dilation_angle: 5 deg, cohesion: 1 MPa}; method.basis=bspline2")
MPMFAST_RUN(
    "material drucker_prager tension/plane", 40, "metal.yaml",
    "materials.m={model: drucker_prager, density: 2 g/cm^3, young: 1 GPa, poisson: 0.3, friction_angle: 30 "
    "deg, cone: plane_strain, cohesion: 2 MPa, tension: 0.5 MPa}; method.basis=qcpdi")
MPMFAST_RUN(
    "material drucker_prager tension/axisymmetric", 40, "metal.yaml",
    "space=axisymmetric; materials.m={model: drucker_prager, density: 2 g/cm^3, young: 1 GPa, poisson: 0.3, "
    "friction_angle: 30 deg, cone: plane_strain, cohesion: 2 MPa, tension: 0.5 MPa}; method.basis=bspline2")
MPMFAST_RUN(
    "material drucker_prager tension/solid", 12, "metal3.yaml",
    "materials.m={model: drucker_prager, density: 2 g/cm^3, young: 1 GPa, poisson: 0.3, friction_angle: 30 "
    "deg, cone: plane_strain, cohesion: 2 MPa, tension: 0.5 MPa}; method.basis=bspline3")
MPMFAST_RUN(
    "material drucker_prager/apic", 40, "metal.yaml",
    "materials.m={model: drucker_prager, density: 2 g/cm^3, young: 1 GPa, poisson: 0.3, friction_angle: 32 "
    "deg, dilation_angle: 5 deg, cohesion: 1 MPa}; method={basis: bspline2, update: apic}")
MPMFAST_RUN("leaving/linear", 40, "drop.yaml", "method.basis=linear")
MPMFAST_RUN("leaving/ugimp", 40, "drop.yaml", "method.basis=ugimp")
MPMFAST_RUN("leaving/lcpdi", 40, "drop.yaml", "method.basis=lcpdi")
MPMFAST_RUN("leaving/qcpdi", 40, "drop.yaml", "method.basis=qcpdi")
MPMFAST_RUN("leaving/bspline2", 40, "drop.yaml", "method.basis=bspline2")
MPMFAST_RUN("leaving/bspline3", 40, "drop.yaml", "method.basis=bspline3")
MPMFAST_RUN("split/lcpdi", 40, "drop.yaml", "method={basis: lcpdi, split: {edge: 1.1}}")
MPMFAST_RUN("split/lcpdi axisymmetric", 40, "drop_axis.yaml", "method={basis: lcpdi, split: true}")
MPMFAST_RUN("split/lcpdi solid", 10, "metal3.yaml",
            "method={basis: lcpdi, split: {edge: 1.05}}; materials.m={model: neo_hookean, density: 1 g/cm^3, "
            "young: 1 MPa, poisson: 0.3}; grid.leaving=outflow")
MPMFAST_RUN("split/qcpdi", 40, "drop.yaml", "method={basis: qcpdi, split: {edge: 1.1}}")
MPMFAST_RUN("split/qcpdi axisymmetric", 40, "drop_axis.yaml", "method={basis: qcpdi, split: true}")
MPMFAST_RUN("split/qcpdi solid", 10, "metal3.yaml",
            "method={basis: qcpdi, split: {edge: 1.05}}; materials.m={model: neo_hookean, density: 1 g/cm^3, "
            "young: 1 MPa, poisson: 0.3}; grid.leaving=outflow")
MPMFAST_RUN("leaving/wall", 40, "drop.yaml", "grid.leaving=wall; bodies.2.velocity=[0, 0]")
MPMFAST_RUN("leaving/stop", 60, "drop.yaml", "grid.leaving=stop")
MPMFAST_RUN("leaving/apic", 40, "drop.yaml", "method={basis: bspline3, update: apic}")
MPMFAST_RUN("violent/collapse", 60, "drop.yaml", "time.collapse=0.9; bodies.0.rotation.speed=60000 rad/s")
MPMFAST_RUN("violent/inverted", 60, "drop.yaml",
            "bodies.0.velocity=[2000 m/s, 8 m/s]; method.basis=linear; boundaries.right=wall")
MPMFAST_RUN("violent/long domains", 60, "drop.yaml",
            "bodies.0.rotation.speed=60000 rad/s; method.basis=lcpdi; time.collapse=0")
MPMFAST_RUN("failure/fold", 60, "drop.yaml",
            "bodies.0.rotation.speed=60000 rad/s; method.basis=bspline2; contact={family: penalty}; "
            "time.collapse=0; grid.leaving=stop")
MPMFAST_RUN("block at nodes/linear flip", 16, "box.yaml",
            "method={basis: linear, update: flip}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at nodes/linear xpic(2)", 16, "box.yaml",
            "method={basis: linear, update: xpic(2)}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at plane/linear flip", 16, "box.yaml",
            "method={basis: linear, update: flip}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at plane/linear xpic(2)", 16, "box.yaml",
            "method={basis: linear, update: xpic(2)}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at surface/linear flip", 16, "box.yaml",
            "method={basis: linear, update: flip}; boundaries.left.at=surface; boundaries.right.at=surface; "
            "boundaries.bottom.at=surface; boundaries.top.at=surface; boundaries.right.friction=0.5")
MPMFAST_RUN("block at surface/linear xpic(2)", 16, "box.yaml",
            "method={basis: linear, update: xpic(2)}; boundaries.left.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.at=surface; boundaries.top.at=surface; "
            "boundaries.bottom.friction=0.3; boundaries.left.friction=0.1")
MPMFAST_RUN(
    "block at plane/solid linear", 5, "box3.yaml",
    "method={basis: linear, update: pic}; boundaries.left.at=plane; boundaries.bottom.at=plane; "
    "boundaries.back.at=plane; boundaries.front.at=plane; boundaries.top.at=plane; boundaries.right.at=plane")
MPMFAST_RUN("block at surface/solid linear", 5, "box3.yaml",
            "method={basis: linear, update: pic}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
            "boundaries.back.at=surface; boundaries.front.at=surface; boundaries.top.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.friction=0.3; boundaries.top.friction=0.2")
MPMFAST_RUN("block at nodes/ugimp flip", 16, "box.yaml",
            "method={basis: ugimp, update: flip}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at nodes/ugimp xpic(2)", 16, "box.yaml",
            "method={basis: ugimp, update: xpic(2)}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at plane/ugimp flip", 16, "box.yaml",
            "method={basis: ugimp, update: flip}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at plane/ugimp xpic(2)", 16, "box.yaml",
            "method={basis: ugimp, update: xpic(2)}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at surface/ugimp xpic(2)", 16, "box.yaml",
            "method={basis: ugimp, update: xpic(2)}; boundaries.left.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.at=surface; boundaries.top.at=surface; "
            "boundaries.bottom.friction=0.3; boundaries.left.friction=0.1")
MPMFAST_RUN(
    "block at plane/solid ugimp", 5, "box3.yaml",
    "method={basis: ugimp, update: xpic(3)}; boundaries.left.at=plane; boundaries.bottom.at=plane; "
    "boundaries.back.at=plane; boundaries.front.at=plane; boundaries.top.at=plane; boundaries.right.at=plane")
MPMFAST_RUN(
    "block at surface/solid ugimp", 5, "box3.yaml",
    "method={basis: ugimp, update: xpic(3)}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
    "boundaries.back.at=surface; boundaries.front.at=surface; boundaries.top.at=surface; "
    "boundaries.right.at=surface; boundaries.bottom.friction=0.3; boundaries.top.friction=0.2")
MPMFAST_RUN("block at nodes/lcpdi flip", 16, "box.yaml",
            "method={basis: lcpdi, update: flip}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at nodes/lcpdi xpic(2)", 16, "box.yaml",
            "method={basis: lcpdi, update: xpic(2)}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at plane/lcpdi flip", 16, "box.yaml",
            "method={basis: lcpdi, update: flip}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at plane/lcpdi xpic(2)", 16, "box.yaml",
            "method={basis: lcpdi, update: xpic(2)}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at surface/lcpdi flip", 16, "box.yaml",
            "method={basis: lcpdi, update: flip}; boundaries.left.at=surface; boundaries.right.at=surface; "
            "boundaries.bottom.at=surface; boundaries.top.at=surface; boundaries.right.friction=0.5")
MPMFAST_RUN("block at surface/lcpdi xpic(2)", 16, "box.yaml",
            "method={basis: lcpdi, update: xpic(2)}; boundaries.left.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.at=surface; boundaries.top.at=surface; "
            "boundaries.bottom.friction=0.3; boundaries.left.friction=0.1")
MPMFAST_RUN(
    "block at plane/solid lcpdi", 5, "box3.yaml",
    "method={basis: lcpdi, update: fmpm(2)}; boundaries.left.at=plane; boundaries.bottom.at=plane; "
    "boundaries.back.at=plane; boundaries.front.at=plane; boundaries.top.at=plane; boundaries.right.at=plane")
MPMFAST_RUN(
    "block at surface/solid lcpdi", 5, "box3.yaml",
    "method={basis: lcpdi, update: fmpm(2)}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
    "boundaries.back.at=surface; boundaries.front.at=surface; boundaries.top.at=surface; "
    "boundaries.right.at=surface; boundaries.bottom.friction=0.3; boundaries.top.friction=0.2")
MPMFAST_RUN("block at nodes/qcpdi flip", 16, "box.yaml",
            "method={basis: qcpdi, update: flip}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at nodes/qcpdi xpic(2)", 16, "box.yaml",
            "method={basis: qcpdi, update: xpic(2)}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at plane/qcpdi flip", 16, "box.yaml",
            "method={basis: qcpdi, update: flip}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at plane/qcpdi xpic(2)", 16, "box.yaml",
            "method={basis: qcpdi, update: xpic(2)}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at surface/qcpdi flip", 16, "box.yaml",
            "method={basis: qcpdi, update: flip}; boundaries.left.at=surface; boundaries.right.at=surface; "
            "boundaries.bottom.at=surface; boundaries.top.at=surface; boundaries.right.friction=0.5")
MPMFAST_RUN("block at surface/qcpdi xpic(2)", 16, "box.yaml",
            "method={basis: qcpdi, update: xpic(2)}; boundaries.left.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.at=surface; boundaries.top.at=surface; "
            "boundaries.bottom.friction=0.3; boundaries.left.friction=0.1")
MPMFAST_RUN(
    "block at plane/solid qcpdi", 5, "box3.yaml",
    "method={basis: qcpdi, update: flip}; boundaries.left.at=plane; boundaries.bottom.at=plane; "
    "boundaries.back.at=plane; boundaries.front.at=plane; boundaries.top.at=plane; boundaries.right.at=plane")
MPMFAST_RUN("block at surface/solid qcpdi", 5, "box3.yaml",
            "method={basis: qcpdi, update: flip}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
            "boundaries.back.at=surface; boundaries.front.at=surface; boundaries.top.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.friction=0.3; boundaries.top.friction=0.2")
MPMFAST_RUN("block at nodes/bspline2 flip", 16, "box.yaml",
            "method={basis: bspline2, update: flip}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at nodes/bspline2 xpic(2)", 16, "box.yaml",
            "method={basis: bspline2, update: xpic(2)}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at plane/bspline2 flip", 16, "box.yaml",
            "method={basis: bspline2, update: flip}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at plane/bspline2 xpic(2)", 16, "box.yaml",
            "method={basis: bspline2, update: xpic(2)}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at surface/bspline2 xpic(2)", 16, "box.yaml",
            "method={basis: bspline2, update: xpic(2)}; boundaries.left.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.at=surface; boundaries.top.at=surface; "
            "boundaries.bottom.friction=0.3; boundaries.left.friction=0.1")
MPMFAST_RUN(
    "block at plane/solid bspline2", 5, "box3.yaml",
    "method={basis: bspline2, update: pic}; boundaries.left.at=plane; boundaries.bottom.at=plane; "
    "boundaries.back.at=plane; boundaries.front.at=plane; boundaries.top.at=plane; boundaries.right.at=plane")
MPMFAST_RUN(
    "block at surface/solid bspline2", 5, "box3.yaml",
    "method={basis: bspline2, update: pic}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
    "boundaries.back.at=surface; boundaries.front.at=surface; boundaries.top.at=surface; "
    "boundaries.right.at=surface; boundaries.bottom.friction=0.3; boundaries.top.friction=0.2")
MPMFAST_RUN("block at nodes/bspline3 flip", 16, "box.yaml",
            "method={basis: bspline3, update: flip}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at nodes/bspline3 xpic(2)", 16, "box.yaml",
            "method={basis: bspline3, update: xpic(2)}; boundaries.left.at=nodes; boundaries.right.at=nodes; "
            "boundaries.bottom.at=nodes; boundaries.top.at=nodes")
MPMFAST_RUN("block at plane/bspline3 flip", 16, "box.yaml",
            "method={basis: bspline3, update: flip}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN("block at plane/bspline3 xpic(2)", 16, "box.yaml",
            "method={basis: bspline3, update: xpic(2)}; boundaries.left.at=plane; boundaries.right.at=plane; "
            "boundaries.bottom.at=plane; boundaries.top.at=plane")
MPMFAST_RUN(
    "block at surface/bspline3 flip", 16, "box.yaml",
    "method={basis: bspline3, update: flip}; boundaries.left.at=surface; boundaries.right.at=surface; "
    "boundaries.bottom.at=surface; boundaries.top.at=surface; boundaries.right.friction=0.5")
MPMFAST_RUN("block at surface/bspline3 xpic(2)", 16, "box.yaml",
            "method={basis: bspline3, update: xpic(2)}; boundaries.left.at=surface; "
            "boundaries.right.at=surface; boundaries.bottom.at=surface; boundaries.top.at=surface; "
            "boundaries.bottom.friction=0.3; boundaries.left.friction=0.1")
MPMFAST_RUN(
    "block at plane/solid bspline3", 5, "box3.yaml",
    "method={basis: bspline3, update: xpic(3)}; boundaries.left.at=plane; boundaries.bottom.at=plane; "
    "boundaries.back.at=plane; boundaries.front.at=plane; boundaries.top.at=plane; boundaries.right.at=plane")
MPMFAST_RUN(
    "block at surface/solid bspline3", 5, "box3.yaml",
    "method={basis: bspline3, update: xpic(3)}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
    "boundaries.back.at=surface; boundaries.front.at=surface; boundaries.top.at=surface; "
    "boundaries.right.at=surface; boundaries.bottom.friction=0.3; boundaries.top.friction=0.2")
MPMFAST_RUN("block shifted/bspline3", 16, "box.yaml",
            "boundaries.left.position=1.85 mm; boundaries.bottom.position=1.1 mm; "
            "boundaries.left.at=surface; boundaries.bottom.at=surface; boundaries.left.friction=1; "
            "boundaries.bottom.friction=0.2; method={basis: bspline3, update: pic}")
MPMFAST_RUN("block shifted/qcpdi", 16, "box.yaml",
            "boundaries.left.position=1.5 mm; boundaries.bottom.position=0.95 mm; "
            "boundaries.left.at=surface; boundaries.bottom.at=surface; boundaries.left.friction=1; "
            "boundaries.bottom.friction=0.2; method={basis: qcpdi, update: pic}")
MPMFAST_RUN("failure/too fast", 60, "drop.yaml", "bodies.0.velocity=[1e155 m/s, 1e150 m/s]")
MPMFAST_RUN("failure/too stiff", 60, "drop.yaml", "materials.soft.young=1e306 Pa")
MPMFAST_RUN("violent/squeezed", 80, "box.yaml",
            "boundaries.top.piston=200 m/s; time.end=20 us; time.collapse=0.9; method.basis=bspline2")
MPMFAST_RUN("failure/squeezed flat", 80, "box.yaml",
            "boundaries.top.piston=200 m/s; bodies.0.velocity=[0 m/s, 60 m/s]; time.end=20 us; "
            "method={deformation_terms: 1, basis: linear, strain: last}; time.cfl=1; time.collapse=0; "
            "materials.soft={model: linear_elastic, density: 1 g/cm^3, young: 1 MPa, poisson: 0}")
MPMFAST_RUN("failure/frozen", 60, "heat.yaml", "heat.boundaries.left.flux=-3000 MW/m^2")
MPMFAST_RUN("failure/frozen solid", 60, "heat3.yaml", "heat.boundaries.left.flux=-3000 MW/m^2")
MPMFAST_RUN(
    "failure/folded", 60, "drop.yaml",
    "grid.leaving=stop; contact={family: penalty}; bodies.0.velocity=[0, 0]; bodies.0.rotation.speed=0 "
    "rad/s; gravity=[0, 0]; bodies.1.velocity=[150 m/s, -150 m/s]; time.collapse=0; time.cfl=1")
MPMFAST_RUN(
    "slot of 3.3 cells/bspline2", 16, "box.yaml",
    "bodies.0.box.to=[5.3 mm, 6.6 mm]; boundaries.right.position=5.35 mm; boundaries.left.at=surface; "
    "boundaries.right.at=surface; boundaries.left.friction=0.3; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.2; boundaries.top.at=plane; method={basis: bspline2, update: pic}")
MPMFAST_RUN(
    "pebble at surface/bspline2", 16, "box.yaml",
    "bodies.0={name: block, disk: {centre: [3.46 mm, 2.72 mm], radius: 1.3 mm}, seeding: lattice, material: "
    "soft, "
    "velocity: "
    "[-8 m/s, -9 m/s], particles_per_cell: 3}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.4; method={basis: bspline2, update: pic}")
MPMFAST_RUN(
    "slot of 2.3 cells/ugimp", 16, "box.yaml",
    "bodies.0.box.to=[4.3 mm, 6.6 mm]; boundaries.right.position=4.35 mm; boundaries.left.at=surface; "
    "boundaries.right.at=surface; boundaries.left.friction=0.3; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.2; boundaries.top.at=plane; method={basis: ugimp, update: pic}")
MPMFAST_RUN(
    "pebble at surface/ugimp", 16, "box.yaml",
    "bodies.0={name: block, disk: {centre: [3.66 mm, 2.82 mm], radius: 1.4 mm}, seeding: lattice, material: "
    "soft, "
    "velocity: "
    "[-8 m/s, -9 m/s], particles_per_cell: 3}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.4; method={basis: ugimp, update: xpic(2)}")
MPMFAST_RUN(
    "slot of 4.2 cells/bspline3", 16, "box.yaml",
    "bodies.0.box.to=[6.2 mm, 6.6 mm]; boundaries.right.position=6.25 mm; boundaries.left.at=surface; "
    "boundaries.right.at=surface; boundaries.left.friction=0.3; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.2; boundaries.top.at=plane; method={basis: bspline3, update: pic}")
MPMFAST_RUN(
    "pebble at surface/bspline3", 16, "box.yaml",
    "bodies.0={name: block, disk: {centre: [3.86 mm, 2.92 mm], radius: 1.5 mm}, seeding: lattice, material: "
    "soft, "
    "velocity: "
    "[-8 m/s, -9 m/s], particles_per_cell: 3}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.4; method={basis: bspline3, update: pic}")
MPMFAST_RUN(
    "slot of 2.75 cells/qcpdi", 16, "box.yaml",
    "bodies.0.box.to=[4.75 mm, 6.6 mm]; boundaries.right.position=4.8 mm; boundaries.left.at=surface; "
    "boundaries.right.at=surface; boundaries.left.friction=0.3; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.2; boundaries.top.at=plane; method={basis: qcpdi, update: pic}")
MPMFAST_RUN(
    "pebble at surface/qcpdi", 16, "box.yaml",
    "bodies.0={name: block, disk: {centre: [4.06 mm, 3.02 mm], radius: 1.6 mm}, seeding: lattice, material: "
    "soft, "
    "velocity: "
    "[-8 m/s, -9 m/s], particles_per_cell: 3}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.4; method={basis: qcpdi, update: xpic(2)}")
MPMFAST_RUN(
    "slot of 1.8 cells/lcpdi", 16, "box.yaml",
    "bodies.0.box.to=[3.8 mm, 6.6 mm]; boundaries.right.position=3.85 mm; boundaries.left.at=surface; "
    "boundaries.right.at=surface; boundaries.left.friction=0.3; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.2; boundaries.top.at=plane; method={basis: lcpdi, update: pic}")
MPMFAST_RUN(
    "pebble at surface/lcpdi", 16, "box.yaml",
    "bodies.0={name: block, disk: {centre: [4.26 mm, 3.12 mm], radius: 1.7 mm}, seeding: lattice, material: "
    "soft, "
    "velocity: "
    "[-8 m/s, -9 m/s], particles_per_cell: 3}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.4; method={basis: lcpdi, update: pic}")
MPMFAST_RUN(
    "slot of 3.05 cells/linear", 16, "box.yaml",
    "bodies.0.box.to=[5.05 mm, 6.6 mm]; boundaries.right.position=5.1 mm; boundaries.left.at=surface; "
    "boundaries.right.at=surface; boundaries.left.friction=0.3; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.2; boundaries.top.at=plane; method={basis: linear, update: pic}")
MPMFAST_RUN(
    "pebble at surface/linear", 16, "box.yaml",
    "bodies.0={name: block, disk: {centre: [4.46 mm, 3.22 mm], radius: 1.8 mm}, seeding: lattice, material: "
    "soft, "
    "velocity: "
    "[-8 m/s, -9 m/s], particles_per_cell: 3}; boundaries.left.at=surface; boundaries.bottom.at=surface; "
    "boundaries.bottom.friction=0.4; method={basis: linear, update: xpic(2)}")
MPMFAST_RUN("penalty/overlapping", 20, "hard/overlapping.yaml", "contact={family: penalty, friction: 0.2}")
MPMFAST_RUN("penalty/overlapping, extended", 20, "hard/overlapping.yaml",
            "contact={family: penalty, law: stick}; method={basis: bspline2, extension: {occupation: 0.6}}")

}  // namespace
}  // namespace mpmfast
