/// What a scene needs, held against tables in tests/recorded: its plan, what the particles are at the start,
/// the memory, and what `mpmfast check` says.

#include <omp.h>

#include <array>

#include "engine/plan/contact_law.hpp"
#include "engine/plan/memory.hpp"
#include "engine/plan/plan.hpp"
#include "engine/plan/seed.hpp"
#include "engine/plan/surfaces.hpp"
#include "engine/run/run.hpp"
#include "engine/scene/crack_tips.hpp"
#include "engine/scene/keys/names.hpp"
#include "engine/step/step.hpp"
#include "kernels/simd/lanes.hpp"
#include "recorded_table.hpp"

using namespace mpmfast;
using namespace mpmfast::test;
using namespace mpmfast::test::recorded;

namespace {

std::string text_of(double value) { return fmt::format("{:.9g}", value); }
std::string text_of(const TractionCurve& curve) {
  std::string text;
  for (std::size_t k = 0; k < curve.jump.size(); ++k)
    text += fmt::format("{}[{:.9g}, {:.9g}]", k > 0 ? ", " : "", curve.jump[k], curve.traction[k]);
  return text;
}

/// A law with its parameters.
struct ParametersOf {
  std::string text;

  template <class T, class Form>
  void key(const char* name, const char*, const T& member, const Form& form) {
    if constexpr (std::is_enum_v<T>)
      text += fmt::format(", {} {}", name, name_of(form, member));
    else
      text += fmt::format(", {} {}", name, text_of(member));
  }
  template <class T, class Form>
  void need(const char* name, const char* description, const T& member, const Form& form) {
    key(name, description, member, form);
  }
};

std::string law_text(const SurfaceLaw& surface, const Scene& scene) {
  AnyLaw law = law_on(surface, scene);
  ParametersOf parameters;
  std::visit(
      [&](auto& one) {
        parameters.text = one.kKeyword;
        one.describe(parameters);
      },
      law);
  return parameters.text;
}

/// The i-th of these words.
template <class E, std::size_t N>
const char* word(E value, const std::array<const char*, N>& words) {
  return words.at(static_cast<std::size_t>(value));
}

std::vector<std::string> plan_lines(const Scene& scene) {
  const Plan plan = make_plan(scene);
  std::vector<std::string> lines;
  const auto line = [&](const char* name, const auto& value) {
    lines.push_back(fmt::format("{}: {}", name, value));
  };
  line("depth", word(plan.plane_kind, std::array{"held", "relaxed", "hoop"}));
  line("update", word(plan.update, std::array{"flip", "pic", "xpic", "apic"}));
  line("position", word(plan.position, std::array{"grid_end", "grid", "trapezoid", "particle"}));
  line("dimension", plan.dimension);
  line("occupation", plan.occupation);
  line("order", plan.order);
  line("filter_every", plan.filter_every);
  line("full_mass", plan.full_mass);
  line("strain_first", plan.strain_first);
  line("re_extrapolate", plan.re_extrapolate);
  line("wall_share", plan.wall_share);
  line("deformation_terms", plan.deformation_terms);
  line("contact", plan.contact);
  line("penalty", plan.penalty);
  line("own_filter", plan.own_filter);
  line("paired", plan.paired);
  line("first_correction_stays", plan.first_correction_stays);
  line("first_share", plan.first_share);
  line("first_correction", plan.first_correction);
  line("one_set", plan.one_set);
  line("contact_geometry", plan.contact_geometry);
  line("keeps_fits", plan.keeps_fits);
  line("bridges", plan.interface_springs);
  line("cracks_alone", plan.cracks_alone);
  line("displacements", plan.displacements);
  line("exact_fields", plan.exact_fields);
  line("geometry", plan.geometry);
  line("split_edge", plan.split_edge);
  line("heat", plan.heat);
  line("gravity", plan.gravity);
  line("force_with_mass", plan.force_with_mass);
  line("moves_as_strained", plan.moves_as_strained());
  for (std::size_t f = 0; f < plan.fields.size(); ++f)
    line("field", fmt::format("{} {}{} acceleration {:.9g} {:.9g} {:.9g}{}", f, plan.fields[f],
                              plan.field_rigid[f] ? ", rigid," : "", plan.field_acceleration[f][0],
                              plan.field_acceleration[f][1], plan.field_acceleration[f][2],
                              f < plan.first_side.size() && plan.sides[f] > 0
                                  ? fmt::format(", sides {} from {} on", plan.sides[f], plan.first_side[f])
                                  : ""));
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    line("body", fmt::format("{} in field {}{}", scene.bodies[b].name, plan.body_field[b],
                             plan.body_splits.empty() ? ""
                             : plan.body_splits[b]    ? ", splits"
                                                      : ", never splits"));
  line("law", law_text(scene.contact.law, scene));
  for (const PairLawSpec& pair : scene.contact.pairs) line("law of a pair", law_text(pair.law, scene));
  for (const CrackSpec& crack : scene.cracks) line("law of a crack", law_text(crack.law, scene));
  for (const CrackTip& tip : crack_tips(scene))
    line("tip", fmt::format("{} of crack {}", tip.name, tip.crack));
  if (!plan.pairs.empty()) {
    const auto fields = static_cast<int>(plan.fields.size());
    REQUIRE(plan.pairs.group.size() == plan.fields.size());
    for (int a = 0; a < fields; ++a) {
      std::string row;
      for (int b = 0; b < fields; ++b) {
        const std::size_t at = plan.pairs.at(a, b);
        const int k = plan.pairs.pair.at(at);
        row += k < 0 ? " -" : fmt::format(" {}{}", k, plan.pairs.forward.at(at) ? ">" : "<");
      }
      line("pairs of field", fmt::format("{}:{}", a, row));
    }
    // Groups, among them those of materials that no body is made of.
    std::string all;
    for (std::size_t k = 0; k < plan.pairs.pair.size(); ++k)
      all += fmt::format(" {}{}", plan.pairs.pair[k], plan.pairs.forward[k] ? ">" : "<");
    line("pairs of groups", fmt::format("{}:{}", plan.pairs.groups, all));
  }
  for (const Quantity q : plan.particle_columns)
    line("column", kQuantityTable[static_cast<std::size_t>(q)].name);
  for (const Nodal q : plan.nodal_columns)
    line("nodal column", kNodalTable[static_cast<std::size_t>(q)].name);
  for (const std::string& pass : plan.passes) line("pass", pass);
  return lines;
}

/// Of a column, over the particles of a body: their sum, their largest, and a sum in which each counts
/// otherwise.
template <int Dim>
std::vector<std::string> particle_lines(const Scene& scene) {
  const Plan plan = make_plan(scene);
  State<Dim> state;
  seed(scene, plan, state);
  const auto& particles = state.particles;
  std::vector<std::string> lines;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& view = state.bodies[b];
    std::size_t count = 0;
    for (std::size_t p = 0; p < particles.size(); ++p) count += particles.body()[p] == b;
    std::string sizes;
    for (int d = 0; d < Dim; ++d) sizes += fmt::format(" {:.9g}", view.half_size[d]);
    lines.push_back(fmt::format("{}: {} particles of half{}{}", scene.bodies[b].name, count, sizes,
                                view.rigid ? ", rigid" : ""));
    for (const Quantity q : particles.quantities()) {
      const double least = q == Quantity::kirchhoff_stress ? 1e-3 : 1e-16;  // less is round-off
      std::string text;
      for (int c = 0; c < Particles<Dim>::components(q); ++c) {
        const double* column = particles.column(q, c);
        double sum = 0, most = 0, weighed = 0;
        for (std::size_t p = 0; p < particles.size(); ++p) {
          if (particles.body()[p] != b) continue;
          sum += std::abs(column[p]);
          most = std::max(most, std::abs(column[p]));
          weighed += std::abs(column[p]) * (1 + 0.37 * static_cast<double>(particles.id()[p] % 17));
        }
        text += most > least ? fmt::format(" [{:.8g} {:.8g} {:.8g}]", sum, most, weighed) : " 0";
      }
      lines.push_back(fmt::format("{} {}:{}", scene.bodies[b].name,
                                  kQuantityTable[static_cast<std::size_t>(q)].name, text));
    }
  }
  const double stored = stored_energy(state);
  lines.push_back(fmt::format("stored: {:.9g}", std::abs(stored) > 1e-12 ? stored : 0.0));
  // Of surfaces that are followed; the sums tell apart which facet has which points and joints.
  const auto& surfaces = state.surfaces;
  double area = 0, whole = 0;
  std::size_t smooth = 0, points = 0, joints = 0, cones = 0;
  for (std::size_t f = 0; f < surfaces.facets.size(); ++f) {
    const auto& facet = surfaces.facets[f];
    whole += facet.area;
    area += facet.area * (1 + static_cast<double>(f % 5));
    for (std::size_t k = 0; k < Dim; ++k) {
      const bool is_smooth = facet.joint[k] == Joint::smooth;
      smooth += is_smooth;
      joints += is_smooth * (f + k) % 7;
      points += (1 + f % 11) * (k + 1) * static_cast<std::size_t>(facet.point[k]);
      cones += (1 + f % 13) * (k + 1) * static_cast<std::size_t>(facet.normal_cone[k]);
    }
    points += static_cast<std::size_t>(facet.body + 3 * facet.patch);
  }
  if (!surfaces.facets.empty())
    lines.push_back(fmt::format(
        "surfaces: {} facets, {} smooth joints, {} normal cones, sums {:.9g} {} {} {}",
        surfaces.facets.size(), smooth, surfaces.normal_cones.size(), area, points, joints, cones));
  double shares = 0;
  for (const double share : tributary_areas(surfaces)) shares += share;
  CHECK(shares == doctest::Approx(whole));
  return lines;
}

std::vector<std::string> start_lines(const Scene& scene) {
  return scene.dimension() == 3 ? particle_lines<3>(scene) : particle_lines<2>(scene);
}

std::vector<std::string> memory_lines(const Scene& scene) {
  const Plan plan = make_plan(scene);
  const double particles = estimated_particles(scene);
  std::vector<std::string> lines{fmt::format("particles: {:.9g}", particles),
                                 fmt::format("bytes: {:.9g}", estimated_bytes(scene, plan, particles))};
  for (const double count : {0.0, 1e4, 1e6})
    for (const double later : {0.0, 1e5, 1e7}) {
      const PassingNeed need = passing_need(scene, count, later);
      lines.push_back(fmt::format("passing {} {}: {:.9g} for {}", count, later, need.bytes, need.reason));
    }
  // The least that is enough, and one byte less.
  const auto enough = static_cast<std::uint64_t>(estimated_bytes(scene, plan, particles));
  for (const std::uint64_t bytes : {enough - 1, enough + 1}) try {
      check_memory(scene, plan, {bytes, "of a test"});
      lines.push_back("enough");
    } catch (const SceneError& error) {
      lines.push_back(error.what());
    }
  return lines;
}

/// What `mpmfast check` says, but for the time that steps take here.
std::vector<std::string> check_lines(const Scene& scene, bool verbose) {
  std::vector<std::string> lines = lines_of(describe_plan(scene, verbose));
  std::erase_if(lines, [](const std::string& line) {
    return line.starts_with("  estimated time") && !holds(line, "unknown");
  });
  return lines;
}

/// One thread as long as it lives.
class OneThread {
 public:
  OneThread() : before_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

}  // namespace

TEST_CASE("the plan of a scene is what the table of plans says, whole") {
  check_table("plan_plans.txt", plan_lines);
}

TEST_CASE("particles start as the table of starts says") { check_table("plan_starts.txt", start_lines); }

TEST_CASE("the memory of a scene is foretold as the table says") {
  check_table("plan_memory.txt", memory_lines);
}

/// The tables have the memory of a program whose vectors hold so many numbers.
constexpr bool kLanesOfTables = kLanes == 8;

TEST_CASE("check --verbose says of a scene what the table says") {
  if (!kLanesOfTables) return;
  const OneThread one;
  check_table("plan_checks.txt", [](const Scene& scene) { return check_lines(scene, true); });
}

TEST_CASE("check tries no steps where bodies crowd a cell, and a few where they do not quite") {
  if (!kLanesOfTables) return;
  const OneThread one;
  check_table("plan_crowds.txt", [](const Scene& scene) { return check_lines(scene, false); });
}

TEST_CASE("check says of a scene what the table says, with long lists folded") {
  if (!kLanesOfTables) return;
  const OneThread one;
  check_table("plan_briefs.txt", [](const Scene& scene) { return check_lines(scene, false); });
}
