#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>

#include "engine/geometry/shapes.hpp"
#include "engine/quantities/quantity.hpp"
#include "engine/scene/suspicions.hpp"
#include "engine/scene/text/parts.hpp"

namespace mpmfast {

namespace {

/// Of waves of pressure in the material as it lies there, m/s; 0 where nothing deforms.
double wave_speed(const MaterialSpec& material) {
  return std::visit([](const auto& law) { return std::sqrt(law.modulus() / law.density); }, material.model);
}

/// What makes a reader of the scene raise an eyebrow: unit mistakes above all.
class Suspicions {
 public:
  Suspicions(const Node& root, const Scene& scene, const std::vector<BodyLocation>& locations,
             Problems& found)
      : root_(root), scene_(scene), locations_(locations), found_(found) {
    for (const MaterialSpec& material : scene.materials) speed_.push_back(wave_speed(material));
  }

  void all() {
    materials();
    bodies();
    if (!doubtful_) times();
    find_idle_cells(location_of("grid.size"), scene_, found_);
    friction(scene_.contact.law.friction, "contact.friction");
    for (std::size_t k = 0; k < scene_.contact.pairs.size(); ++k)
      if (scene_.contact.pairs[k].law.friction != scene_.contact.law.friction)
        friction(scene_.contact.pairs[k].law.friction, fmt::format("contact.pairs.{}.friction", k));
    if (scene_.output.frames > kMostFrames)
      say("output.frames", fmt::format("{} particle files take much of a disk", scene_.output.frames));
    falls();
    loads();
    joints(scene_.contact.law, "contact");
    for (std::size_t k = 0; k < scene_.contact.pairs.size(); ++k)
      if (!same_bond(scene_.contact.pairs[k].law, scene_.contact.law))
        joints(scene_.contact.pairs[k].law, fmt::format("contact.pairs.{}", k));
    if (scene_.contact.family == ContactFamily::penalty && !scene_.method.extended)
      say("contact.family", "penalty forces throw nodes at surfaces that have hardly any mass",
          "method: {basis: bspline2, extension: {occupation: 0.75}}");
  }

 private:
  static constexpr int kMostFrames = 1000;
  static constexpr double kFewestCells = 2, kMostSteps = 1e8, kMostFriction = 2;
  static constexpr double kLightest = 1e-1, kLightestBare = 25, kHeaviest = 3e4;  // kg/m³
  static constexpr double kSlowest = 1, kFastest = 2e4;                           // m/s

  /// What stands at a path, or at as much of it as the scene states.
  const Node& node_at(const std::string& path) const {
    const Node* node = &root_;
    for (const std::string_view part : parts_of(path, '.')) {
      const std::string key(part);
      const Node* inner = find_value(*node, key);
      if (node->kind == Node::Kind::list && !key.empty() &&
          std::isdigit(static_cast<unsigned char>(key[0])) && std::stoul(key) < node->items.size())
        inner = &node->items[std::stoul(key)];
      if (!inner) break;
      node = inner;
    }
    return *node;
  }
  SourceLocation location_of(const std::string& path) const { return node_at(path).location; }
  bool is_bare(const std::string& path) const { return parse_number(node_at(path).scalar).has_value(); }

  void say(const std::string& path, const std::string& what, const std::string& hint = "") {
    found_.add(location_of(path), path, what, hint);
  }

  void materials() {
    std::set<int> used;
    for (const BodySpec& body : scene_.bodies) used.insert(body.material);
    for (std::size_t m = 0; m < scene_.materials.size(); ++m) {
      const MaterialSpec& material = scene_.materials[m];
      const std::string path = "materials." + material.name;
      if (!used.contains(static_cast<int>(m))) {  // a file that others include may hold more than each needs
        if (!found_.is_included(location_of(path).source)) say(path, "no body is made of this material");
        continue;
      }
      if (speed_[m] == 0) continue;
      const double density = density_of(material);
      const bool heavy = density < kLightest || density > kHeaviest;
      const bool fast = speed_[m] < kSlowest || speed_[m] > kFastest;
      const bool forgotten = density < kLightestBare && is_bare(path + ".density") && has_units(path);
      doubtful_ = doubtful_ || heavy || fast || forgotten;
      if (heavy)
        say(path + ".density", fmt::format("{:.4g} kg/m^3 is no density of a solid or a liquid", density),
            meant(density));
      else if (forgotten)
        say(path + ".density",
            fmt::format("a bare density is in kg/m^3, and {:g} is that of a gas or a foam", density),
            fmt::format("Did you mean {:g} g/cm^3?", density));
      else if (fast)
        say(path,
            fmt::format("waves would run at {:.3g} m/s in it (usual: {:g} to {:g})", speed_[m], kSlowest,
                        kFastest),
            speed_[m] > kFastest ? "Is the density too small, or a modulus too large?" : slow_because(path));
    }
  }

  std::string slow_because(const std::string& path) const {
    for (const char* key : {"young", "bulk", "shear", "lambda"})
      if (is_bare(join(path, key)) && has_units(path))
        return fmt::format("Is a unit missing? {} is read as {} Pa", key, node_at(join(path, key)).scalar);
    return "Is the density too large, or a modulus too small?";
  }

  /// Does any other value of the material have a unit?
  bool has_units(const std::string& path) const {
    const Node& material = node_at(path);
    return std::any_of(material.items.begin(), material.items.end(), [](const Node& value) {
      const auto amount = parse_amount(value.scalar);
      return std::holds_alternative<Amount>(amount) && std::get<Amount>(amount).dimensions != Dimensions{};
    });
  }

  /// 2780 g/cm^3 for 2780 kg/m^3, 2.78 kg/cm^3 for 2.78 g/cm^3: a thousand, or a million, too much or too
  /// little.
  static std::string meant(double density) {
    for (const double factor : {1e-3, 1e3, 1e-6, 1e6}) {
      const double other = density * factor;
      if (other >= 10 && other <= kHeaviest)
        return fmt::format("Did you mean {:.4g} kg/m^3, that is {:.4g} g/cm^3?", other, other / 1e3);
    }
    return "";
  }

  void bodies() {
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const BodySpec& body = scene_.bodies[b];
      const double speed = speed_[static_cast<std::size_t>(body.material)];
      if (speed == 0) continue;
      const std::string& path = locations_[b].entry.path();
      const double moves = std::hypot(body.velocity[0], body.velocity[1], body.velocity[2]);
      if (moves > speed)
        say(path + ".velocity",
            fmt::format("body '{}' flies at {:.4g} m/s, faster than waves in it ({:.4g} m/s)", body.name,
                        moves, speed));
      if (const double cells = thickness(body) / scene_.grid.cell; cells < kFewestCells * (1 - 1e-9))
        say(path,
            fmt::format("body '{}' is only {:.2g} cells thick, which the grid hardly sees", body.name, cells),
            "Smaller cells");
      const auto fewest = std::min_element(body.particles_per_cell.begin(),
                                           body.particles_per_cell.begin() + scene_.dimension());
      if (*fewest < 2)
        say(path + ".particles_per_cell",
            fmt::format("body '{}' has one particle along a cell's side: holes open early (2 is usual)",
                        body.name));
    }
  }

  /// Does a body reach a wall? A slice between planes of symmetry is as thick as what it stands for.
  bool at_wall(const Bounds& box, std::size_t axis) const {
    return std::any_of(scene_.boundaries.begin(), scene_.boundaries.end(), [&](const BoundarySpec& boundary) {
      const auto* wall = std::get_if<WallSpec>(&boundary.condition);
      if (!wall || static_cast<std::size_t>(wall->axis) != axis) return false;
      return std::abs(wall->position - (wall->upper ? box.upper : box.lower)[axis]) < 1e-6 * scene_.grid.cell;
    });
  }

  /// The least extent; infinite where it is not known.
  double thickness(const BodySpec& body) const {
    if (std::holds_alternative<BitmapShape>(body.shape)) return kInfinity;
    const Bounds box = bounds(body.shape);
    double least = kInfinity;
    for (std::size_t k = 0; k < static_cast<std::size_t>(scene_.dimension()); ++k)
      if (!at_wall(box, k)) least = std::min(least, box.upper[k] - box.lower[k]);
    if (const auto* ring = std::get_if<RingShape>(&body.shape))
      least = std::min(least, ring->outer - ring->inner);
    return least;
  }

  void times() {
    double crossing = kInfinity, fastest = 0;
    for (const BodySpec& body : scene_.bodies) {
      const double speed = speed_[static_cast<std::size_t>(body.material)];
      if (speed == 0) continue;
      fastest = std::max(fastest, speed);
      crossing = std::min(crossing, thickness(body) / speed);
    }
    const double end = scene_.time.end;
    const double steps = end * fastest / (scene_.time.cfl * scene_.grid.cell);
    if (std::isfinite(crossing) && end < crossing)
      say("time.end",
          fmt::format("{:.3g} s is over before a wave has crossed any body ({:.3g} s)", end, crossing));
    if (steps > kMostSteps)
      say("time.end", fmt::format("about {:.2g} steps of {:.2g} s", steps, end / steps),
          "Is the time in the right unit?");
  }

  /// A load on a part of a surface where no body of its field lies.
  void loads() {
    for (std::size_t k = 0; k < scene_.loads.size(); ++k) {
      const auto* pressure = std::get_if<PressureSpec>(&scene_.loads[k]);
      if (!pressure || !pressure->where) continue;
      const BodySpec& loaded = scene_.bodies[static_cast<std::size_t>(pressure->body)];
      const Bounds part = bounds(*pressure->where);
      const bool any = std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [&](const BodySpec& body) {
        return (&body == &loaded || (!body.field.empty() && body.field == loaded.field)) &&
               meet(bounds(body.shape), part);
      });
      if (!any)
        say(fmt::format("loads.pressure.{}.where", k),
            fmt::format("nothing of body '{}' lies here, and the load acts on nothing", loaded.name));
    }
  }

  /// Do two boxes have a point in common, along the axes of the scene?
  bool meet(const Bounds& one, const Bounds& other) const {
    for (std::size_t d = 0; d < static_cast<std::size_t>(scene_.dimension()); ++d)
      if (one.upper[d] < other.lower[d] || other.upper[d] < one.lower[d]) return false;
    return true;
  }

  /// Gravity towards a face without a wall, and nothing else that could hold what falls.
  void falls() {
    const Vec3& gravity = scene_.gravity.acceleration;
    int axis = 0;
    for (int d = 1; d < scene_.dimension(); ++d)
      if (std::abs(gravity[static_cast<std::size_t>(d)]) > std::abs(gravity[static_cast<std::size_t>(axis)]))
        axis = d;
    const double pull = gravity[static_cast<std::size_t>(axis)];
    if (pull == 0) return;
    const bool held =
        std::any_of(scene_.boundaries.begin(), scene_.boundaries.end(), [&](const auto& boundary) {
          const auto* wall = std::get_if<WallSpec>(&boundary.condition);
          return !wall || wall->fixed || (wall->axis == axis && wall->upper == (pull > 0));
        });
    const bool rigid = std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [&](const BodySpec& body) {
      return speed_[static_cast<std::size_t>(body.material)] == 0;
    });
    if (held || rigid) return;
    constexpr const char* kFaces[3][2] = {{"left", "right"}, {"bottom", "top"}, {"back", "front"}};
    const char* const face = kFaces[axis][pull > 0];
    say("gravity",
        fmt::format("it pulls towards the {} face ({} {}), which is free, and no body is rigid", face,
                    pull > 0 ? "upper" : "lower", "xyz"[axis]),
        fmt::format("boundaries: {{{}: wall}}", face));
  }

  void friction(double coefficient, const std::string& path) {
    if (coefficient > kMostFriction)
      say(path, fmt::format("{:g} is a lot of friction (steel on steel: 0.1 to 0.8)", coefficient),
          "Is it an angle, or percent?");
  }

  /// Of the bodies that deform, the least and the largest ρ c², Pa.
  struct Moduli {
    double least = 0, largest = 0;
  };
  Moduli moduli() const {
    Moduli out;
    for (const BodySpec& body : scene_.bodies) {
      if (is_rigid(scene_, body)) continue;
      const auto m = static_cast<std::size_t>(body.material);
      const double own = density_of(scene_.materials[m]) * speed_[m] * speed_[m];
      out.least = out.least > 0 ? std::min(out.least, own) : own;
      out.largest = std::max(out.largest, own);
    }
    return out;
  }

  /// Of a pair that has the bond of all others, nothing is said again.
  static bool same_bond(const SurfaceLaw& one, const SurfaceLaw& other) {
    const auto *a = std::get_if<Cohesive>(&one.acts), *b = std::get_if<Cohesive>(&other.acts);
    const auto numbers = [](const Cohesive& c) {
      return std::array{c.normal_strength,        c.shear_strength,    c.normal_toughness,
                        c.shear_toughness,        c.initial_stiffness, c.compression_stiffness,
                        c.softening().integral(1)};
    };
    return a && b && numbers(*a) == numbers(*b);
  }

  void joints(const SurfaceLaw& law, const std::string& path) {
    if (const auto* springs = std::get_if<Interface>(&law.acts)) {
      stiff(springs->normal_stiffness, path + ".normal_stiffness");
      stiff(springs->shear_stiffness, path + ".shear_stiffness");
      stiff(springs->compression_stiffness, path + ".compression_stiffness");
    } else if (const auto* curves = std::get_if<NonlinearInterface>(&law.acts)) {
      stiff(curves->normal_curve.steepest(), path + ".normal_curve");
      stiff(curves->shear_curve.steepest(), path + ".shear_curve");
      reach(curves->normal_curve, path + ".normal_curve");
      reach(curves->shear_curve, path + ".shear_curve");
      stiff(curves->compression_stiffness, path + ".compression_stiffness");
    } else if (const auto* bond = std::get_if<Cohesive>(&law.acts)) {
      stiff(bond->initial_stiffness, path + ".initial_stiffness");
      stiff(bond->compression_stiffness, path + ".compression_stiffness");
      crack(bond->normal_strength, bond->normal_toughness, bond->softening(), path + ".normal_strength");
      crack(bond->shear_strength, bond->shear_toughness, bond->softening(), path + ".shear_strength");
    }
  }

  /// NN Eq. 5.36: Δt = C h/c < h √(ρ/(2 D h)), with the least ρ c² of the bodies.
  void stiff(double stiffness, const std::string& path) {
    constexpr double kTieLike = 100;  // from here on a cell gives way a hundred times as much
    const Moduli modulus = moduli();
    const double most = modulus.least / (2 * scene_.time.cfl * scene_.time.cfl * scene_.grid.cell);
    if (stiffness > most && stiffness * scene_.grid.cell < kTieLike * modulus.largest)
      say(path,
          fmt::format("{:.3g} Pa/m swings faster than steps follow: right at rest, but too slow for waves",
                      stiffness),
          fmt::format("Up to {:.3g} Pa/m; time.cfl {:.2g}, or smaller cells, would follow this one", most,
                      scene_.time.cfl * std::sqrt(most / stiffness)));
  }

  /// Springs of surfaces that are a cell apart let go.
  void reach(const TractionCurve& curve, const std::string& path) {
    const double cell = scene_.grid.cell, last = curve.jump.back();
    if (last > cell && curve.traction.back() != curve.at(cell))
      say(path,
          fmt::format("goes on to {:.3g} m, and surfaces that are a cell apart ({:g} m) let go before", last,
                      cell),
          "Larger cells, or another unit");
  }

  /// Ahead of a crack the bond softens over about E G/σ² (Hillerborg 1976), which cells must resolve; and it
  /// must break before its surfaces are so far apart that no node sees both.
  void crack(double strength, double toughness, const SofteningLaw& softening, const std::string& path) {
    constexpr double kFewest = 3;
    const double modulus = moduli().least, cell = scene_.grid.cell;
    const double zone = modulus * (toughness / strength) / strength,
                 opening = toughness / (strength * softening.integral(1));
    if (modulus > 0 && zone < kFewest * cell)
      say(path,
          fmt::format("a crack's zone, E G/strength^2 = {:.3g} m, is {:.2g} cells long: it grows in jumps",
                      zone, zone / cell),
          fmt::format("Up to {:.3g} Pa, or cells of {:.2g} m: three cells",
                      strength * std::sqrt(zone / (kFewest * cell)), zone / kFewest));
    if (opening > cell)
      say(path,
          fmt::format(
              "the bond breaks at {:.3g} m, and surfaces that are a cell apart ({:g} m) let go before",
              opening, cell),
          "Larger cells, or less toughness for this strength");
  }

  const Node& root_;
  const Scene& scene_;
  const std::vector<BodyLocation>& locations_;
  Problems& found_;
  std::vector<double> speed_;  ///< of waves in each material
  bool doubtful_ = false;      ///< these speeds
};

}  // namespace

void find_suspicions(const Node& root, const Scene& scene, const std::vector<BodyLocation>& locations,
                     Problems& found) {
  Suspicions(root, scene, locations, found).all();
  find_suspicious_text(root, found);
}

}  // namespace mpmfast
