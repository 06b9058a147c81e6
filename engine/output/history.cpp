#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "engine/errors.hpp"
#include "engine/output/hash.hpp"
#include "engine/output/output.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/quantities/time_table.hpp"
#include "engine/scene/crack_tips.hpp"

namespace mpmfast {
namespace {

constexpr std::array<std::string_view, 6> kTensorNames{"xx", "yy", "zz", "xy", "yz", "xz"};
constexpr std::array<std::string_view, 3> kAxisNames{"x", "y", "z"};

std::size_t tensor_components(const Scene& scene) { return scene.dimension() == 2 ? 4 : 6; }
std::size_t vector_components(const Scene& scene) { return static_cast<std::size_t>(scene.dimension()); }

/// A header cell: quoted where the name of a body would otherwise end it (RFC 4180), and always on one line.
std::string csv_cell(std::string text) {
  bool quote = false;
  std::string cell;
  for (char c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    if (c == ',' || c == '"') quote = true;
    if (c == '"') cell += c;
    cell += c;
  }
  return quote ? '"' + cell + '"' : cell;
}

void add_stress_names(std::vector<std::string>& names, const Scene& scene, const std::string& body) {
  for (std::size_t k = 0; k < tensor_components(scene); ++k)
    names.push_back(fmt::format("{}.mean_stress_{}_Pa", body, kTensorNames[k]));
}

/// "a+b" for what contact does between a and b.
std::string pair_name(const Scene& scene, const PairLawSpec& pair) {
  const auto name = [&](int index) {
    const auto k = static_cast<std::size_t>(index);
    return pair.materials ? scene.materials[k].name : scene.bodies[k].name;
  };
  return name(pair.between[0]) + "+" + name(pair.between[1]);
}

const WallSpec* piston_of(const BoundarySpec& boundary) {
  const auto* wall = std::get_if<WallSpec>(&boundary.condition);
  return wall && largest(wall->speed) > 0 ? wall : nullptr;
}

/// Do surfaces of the scene lose energy as they part?
bool has_bonds(const Scene& scene) {
  const auto breaks = [](const SurfaceLaw& law) { return std::holds_alternative<Cohesive>(law.acts); };
  return (scene.contact.active && scene.contact.any(breaks)) ||
         std::any_of(scene.cracks.begin(), scene.cracks.end(),
                     [&](const CrackSpec& crack) { return breaks(crack.law); });
}

/// Do springs or bonds join surfaces of the scene?
bool has_interfaces(const Scene& scene) {
  const auto joint = [](const SurfaceLaw& law) { return has_springs(law.acts); };
  return (scene.contact.active && scene.contact.any(joint)) ||
         std::any_of(scene.cracks.begin(), scene.cracks.end(),
                     [&](const CrackSpec& crack) { return joint(crack.law); });
}

/// How much further apart than at first a piston and what it faces are, by their first distance: negative in
/// compression. It faces the wall on the other side of the grid, or that face.
double nominal_strain(const Scene& scene, const WallSpec& piston, double time) {
  const auto axis = static_cast<std::size_t>(piston.axis);
  double faced = scene.grid.origin[axis] + (piston.upper ? 0 : scene.grid.size[axis]), moved = 0;
  for (const BoundarySpec& boundary : scene.boundaries) {
    const auto* wall = std::get_if<WallSpec>(&boundary.condition);
    if (!wall || wall->axis != piston.axis || wall->upper == piston.upper) continue;
    faced = wall->position;
    moved = integral_to(wall->speed, time);
  }
  return (integral_to(piston.speed, time) - moved) / (piston.position - faced);
}

std::vector<std::string> column_names(const Scene& scene) {
  std::vector<std::string> names{"step",       "time_s",          "dt_s",       "kinetic_J",  "stored_J",
                                 "friction_J", "boundary_work_J", "momentum_x", "momentum_y", "momentum_z"};
  const std::size_t dim = vector_components(scene);
  const auto add = [&](const std::string& owner, std::string_view before, std::string_view after) {
    for (std::size_t k = 0; k < dim; ++k)
      names.push_back(fmt::format("{}.{}{}{}", owner, before, kAxisNames[k], after));
  };
  for (const auto& body : scene.bodies) {
    add_stress_names(names, scene, body.name);
    names.push_back(body.name + ".mass_kg");
    add(body.name, "", "_m");
    add(body.name, "v", "");
  }
  for (const auto& boundary : scene.boundaries) add(boundary.name, "force_", "_N");
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (is_rigid(scene, scene.bodies[b])) add(scene.bodies[b].name, "force_", "_N");
  names.push_back("body_force_work_J");
  add_stress_names(names, scene, "all");
  for (const auto& body : scene.bodies) {
    if (!is_rigid(scene, body)) continue;
    if (dim == 2) names.push_back(body.name + ".moment_z_Nm");
    if (dim == 3) add(body.name, "moment_", "_Nm");
  }
  for (const auto& pair : scene.contact.pairs) {
    const std::string owner = pair_name(scene, pair);
    add(owner, "force_", "_N");
    names.push_back(owner + ".friction_J");
  }
  names.push_back("dissipated_J");
  if (scene.output.overlap) names.insert(names.end(), {"overlap_m2", "inside_m2"});
  if (scene.grid.outflow == OutflowKind::outflow) {
    names.insert(names.end(), {"outflow_kg", "outflow_J"});
    for (std::size_t k = 0; k < dim; ++k) names.push_back(fmt::format("outflow_momentum_{}", kAxisNames[k]));
  }
  for (const auto& boundary : scene.boundaries)
    if (piston_of(boundary)) names.push_back(boundary.name + ".strain");
  if (scene.contact.family == ContactFamily::penalty)
    for (const auto& pair : scene.contact.pairs) names.push_back(pair_name(scene, pair) + ".area_m2");
  if (scene.heat.active) {
    names.insert(names.end(), {"heat_J", "heat_in_J", "heat_friction_J", "expansion_work_J"});
    for (const auto& condition : scene.heat.conditions) names.push_back(condition.name + ".heat_J");
    for (const auto& body : scene.bodies) names.push_back(body.name + ".temperature_K");
  }
  if (has_bonds(scene)) names.push_back("interface_J");
  if (has_interfaces(scene)) names.push_back("interface_stored_J");
  for (const CrackTip& tip : crack_tips(scene))
    for (const char* column : {".x_m", ".y_m", ".J_J_per_m2", ".KI_Pa_sqrt_m", ".KII_Pa_sqrt_m"})
      names.push_back(tip.name + column);
  for (const CrackSpec& crack : scene.cracks)
    if (crack.growth.active) names.push_back(crack.name + ".length_m");
  return names;
}

/// The numbers of a row, one after the other.
struct Numbers {
  std::vector<double> all;
  void add(double number) { all.push_back(number); }
  template <class Several>
  void add(const Several& numbers, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) add(numbers[k]);
  }
};

std::string header(const Scene& scene) {
  std::vector<std::string> cells = column_names(scene);
  for (auto& cell : cells) cell = csv_cell(cell);
  return fmt::format("{}\n", fmt::join(cells, ","));
}

/// Where a line begins and ends, and how many whole lines there are up to it.
struct LineEnds {
  std::uint64_t lines = 0, before = 0, after = 0;
};

/// Of line `number`, counted from 0.
LineEnds find_line(const Descriptor& file, const std::filesystem::path& path, std::uint64_t number) {
  std::vector<char> block(std::size_t{1} << 16);
  LineEnds ends;
  std::uint64_t at = 0;
  while (const std::size_t n = file.read_at(block.data(), block.size(), at, path)) {
    for (std::size_t i = 0; i < n; ++i) {
      if (block[i] != '\n') continue;
      ends.before = ends.after;
      ends.after = at + i + 1;
      if (ends.lines++ == number) return ends;
    }
    at += n;
  }
  return ends;
}

/// Adds the first bytes of a file.
void add_bytes(Hash128& hash, const Descriptor& file, const std::filesystem::path& path, std::uint64_t size) {
  std::vector<char> block(std::size_t{1} << 16);
  for (std::uint64_t at = 0; at < size;) {
    const std::size_t n = file.read_at(
        block.data(), static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), size - at)), at, path);
    if (n == 0) return;
    hash.add(block.data(), n);
    at += n;
  }
}

}  // namespace

std::vector<std::string> history_columns(const Scene& scene) { return column_names(scene); }

std::vector<double> history_numbers(const HistoryRow& row, const Scene& scene) {
  const std::size_t dim = vector_components(scene), tensor = tensor_components(scene);
  Numbers numbers;
  numbers.add(static_cast<double>(row.step));
  for (double x : {row.time, row.dt, row.kinetic, row.stored, row.friction, row.boundary_work})
    numbers.add(x);
  numbers.add(row.momentum, 3);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const HistoryRow::Body body = b < row.bodies.size() ? row.bodies[b] : HistoryRow::Body{};
    numbers.add(body.mean_stress, tensor);
    numbers.add(body.mass);
    numbers.add(body.position, dim);
    numbers.add(body.velocity, dim);
  }
  for (std::size_t i = 0; i < scene.boundaries.size(); ++i)
    numbers.add(i < row.boundary_force.size() ? row.boundary_force[i] : Vec3{}, dim);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (is_rigid(scene, scene.bodies[b]))
      numbers.add(b < row.rigid_force.size() ? row.rigid_force[b] : Vec3{}, dim);
  numbers.add(row.body_force_work);
  numbers.add(row.mean_stress, tensor);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (!is_rigid(scene, scene.bodies[b])) continue;
    const Vec3 moment = b < row.rigid_moment.size() ? row.rigid_moment[b] : Vec3{};
    if (dim == 2) numbers.add(moment[2]);
    if (dim == 3) numbers.add(moment, 3);
  }
  for (std::size_t k = 0; k < scene.contact.pairs.size(); ++k) {
    numbers.add(k < row.pair_force.size() ? row.pair_force[k] : Vec3{}, dim);
    numbers.add(k < row.pair_friction.size() ? row.pair_friction[k] : 0.0);
  }
  numbers.add(row.dissipated);
  if (scene.output.overlap) {
    const Overlap overlap = row.overlap.value_or(Overlap{});
    numbers.add(overlap.area);
    numbers.add(overlap.inside);
  }
  if (scene.grid.outflow == OutflowKind::outflow) {
    const Outflow outflow = row.outflow.value_or(Outflow{});
    numbers.add(outflow.mass);
    numbers.add(outflow.energy);
    numbers.add(outflow.momentum, dim);
  }
  for (const auto& boundary : scene.boundaries)
    if (const WallSpec* piston = piston_of(boundary)) numbers.add(nominal_strain(scene, *piston, row.time));
  if (scene.contact.family == ContactFamily::penalty)
    for (std::size_t k = 0; k < scene.contact.pairs.size(); ++k)
      numbers.add(k < row.pair_area.size() ? row.pair_area[k] : 0.0);
  if (scene.heat.active) {
    const HistoryRow::Heat heat = row.heat.value_or(HistoryRow::Heat{});
    for (double x : {heat.content, heat.in, heat.friction, heat.worked}) numbers.add(x);
    for (std::size_t k = 0; k < scene.heat.conditions.size(); ++k)
      numbers.add(k < heat.conditions.size() ? heat.conditions[k] : 0.0);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      numbers.add(b < row.bodies.size() ? row.bodies[b].temperature : 0.0);
  }
  if (has_bonds(scene)) numbers.add(row.interface);
  if (has_interfaces(scene)) numbers.add(row.joints);
  for (std::size_t k = 0; k < crack_tips(scene).size(); ++k)
    numbers.add(k < row.tips.size() ? row.tips[k] : std::array<double, 5>{}, 5);
  for (std::size_t c = 0; c < scene.cracks.size(); ++c)
    if (scene.cracks[c].growth.active) numbers.add(c < row.crack_lengths.size() ? row.crack_lengths[c] : 0.0);
  return numbers.all;
}

HistoryFile::HistoryFile(const std::filesystem::path& folder, const Scene& scene)
    : path_(folder / "history.csv"),
      file_(Descriptor::open_or_create(path_)),
      scene_(&scene),
      hash_(std::make_unique<Hash128>()) {
  claim();  // before anything of it is cut: it may be another's
  file_.cut(0, path_);
  append_line(header(scene));
}

HistoryFile::HistoryFile(const std::filesystem::path& folder, const Scene& scene, const HistoryMark& mark)
    : path_(folder / "history.csv"),
      file_(Descriptor::open(path_, true)),
      scene_(&scene),
      mark_{mark.rows, mark.last_step, ""},
      hash_(std::make_unique<Hash128>()) {
  claim();
  const LineEnds ends = find_line(file_, path_, mark.rows);
  const std::string first = header(scene), last = mark.rows > 0 ? fmt::format("{},", mark.last_step) : "";
  std::string text(std::max(first.size(), last.size()), '\0');
  const auto starts_with = [&](std::uint64_t offset, const std::string& wanted) {
    return file_.read_at(text.data(), wanted.size(), offset, path_) == wanted.size() &&
           text.compare(0, wanted.size(), wanted) == 0;
  };
  const bool is_long = ends.lines > mark.rows;
  if (is_long) add_bytes(*hash_, file_, path_, ends.after);
  if (!is_long || !starts_with(0, first) || !starts_with(ends.before, last) || hash_->text() != mark.hash)
    throw FileError(
        fmt::format("{} is not that of the checkpoint, which has {} rows up to step {}: nothing was changed",
                    path_.string(), mark.rows, mark.last_step));
  size_ = ends.after;
  file_.cut(size_, path_);
}

HistoryFile::~HistoryFile() = default;

HistoryMark HistoryFile::mark() const { return {mark_.rows, mark_.last_step, hash_->text()}; }

void HistoryFile::claim() const {
  if (!file_.claim()) throw FileError(path_.parent_path().string() + " belongs to a run that goes on now");
}

/// Another run may have taken the folder by force.
void HistoryFile::check_there() const {
  if (!file_.has_name()) throw FileError(path_.string() + " was removed while the run went on");
}

void HistoryFile::sync() const {
  check_there();
  file_.sync(path_);
}

/// All of a line or nothing of it.
void HistoryFile::append_line(std::string_view line) {
  check_there();
  try {
    file_.write_at(line, size_, path_);
  } catch (const FileError&) {
    file_.cut(size_, path_);
    throw;
  }
  size_ += line.size();
  hash_->add(line.data(), line.size());
}

void HistoryFile::append(const HistoryRow& row) {
  const std::vector<double> numbers = history_numbers(row, *scene_);
  std::string line = std::to_string(row.step);
  for (std::size_t k = 1; k < numbers.size(); ++k)
    fmt::format_to(std::back_inserter(line), ",{:.9g}", numbers[k]);
  append_line(line += '\n');
  ++mark_.rows;
  mark_.last_step = row.step;
}

}  // namespace mpmfast
