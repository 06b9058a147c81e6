#include <fmt/format.h>

#include <cmath>
#include <string>

#include "engine/constants.hpp"
#include "engine/output/output.hpp"
#include "engine/state/splitting.hpp"

namespace mpmfast {

namespace {

double share(std::uint64_t part, std::uint64_t whole) {
  return whole >= kEnoughToJudge ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

/// In per cent, two digits and no exponent.
std::string percent(double share) {
  const double value = 100 * share;
  return std::abs(value) < 99.5 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

/// None of them is what the scene has already.
std::string cure_of_growth(const RunSummary::Settings& settings) {
  std::string ways = fmt::format("a time.cfl below {:g}", settings.cfl);
  if (!settings.filtered && !settings.grid_end) ways += ", or method.position: grid_end,";
  if (!settings.filtered && settings.grid_end) ways += ", or method.update: xpic(5),";
  return "noise grows; " + ways + " may help";
}

/// What keeps a body whole, given what the scene does for it already.
const char* cure_of_parting(const RunSummary::Settings& settings) {
  if (!settings.follows_shape) return "method: {basis: lcpdi, split: {edge: 1.5}} keeps a solid whole";
  if (!settings.splits) return "method: {split: {edge: 1.5}} keeps a solid whole";
  return "smaller cells, or more particles_per_cell, keep it whole for longer";
}

std::string cure_of_drift(const RunSummary& summary) {
  if (summary.energy_error > 0) return cure_of_growth(summary.settings);
  if (summary.settings.averaged_strain)
    return "the averaged strain takes energy from bodies of few cells that vibrate, bounce or spin: set "
           "method.strain: average+; if it still drifts, smaller cells";
  if (summary.settings.filtered) return "the method took it; smaller cells, or method.update: flip, may help";
  return "the method took it; smaller cells may help";
}

}  // namespace

std::vector<RunWarning> run_warnings(const RunSummary& summary) {
  std::vector<RunWarning> out;
  const auto& contact = summary.contact;
  if (const double part = share(contact.unconverged, contact.regressions); part > kMostUnconverged)
    out.push_back({"convergence",
                   fmt::format("{} % of the contact normals did not converge (usual: below {:g} %); a larger "
                               "contact.tolerance or contact.max_iterations may help",
                               percent(part), 100 * kMostUnconverged)});
  if (const double part = share(contact.doubtful, contact.touching); part > kMostDoubtful)
    out.push_back(
        {"fallbacks",
         fmt::format(
             "{} % of the normals of surfaces that touch or overlap fell back on a simpler method, and "
             "nothing around bears them out (usual: below {:g} %): the bodies have too few particles there, "
             "or overlap; smaller cells help",
             percent(part), 100 * kMostDoubtful)});
  if (const double part = share(contact.pair_fallbacks, contact.pair_nodes); part > kMostPairFallbacks)
    out.push_back(
        {"pairs",
         fmt::format("on {} % of the nodes of three and more fields the pairs were not solved for one by one "
                     "(usual: below {:g} %)",
                     percent(part), 100 * kMostPairFallbacks)});
  if (const double part = share(contact.screened, contact.meetings); part > kMostScreened)
    out.push_back(
        {"screens",
         fmt::format("{} % of the nodes where bodies meet were left without contact (usual: below {:g} %) by "
                     "{}: a smaller value leaves fewer",
                     percent(part), 100 * kMostScreened,
                     summary.settings.volume_screen ? "contact.volume_screen" : "contact.mass_screen")});
  if (summary.third_cracks > 0)
    out.push_back(
        {"cracks", fmt::format("{} times a particle saw a node behind a third crack, which does not part "
                               "it: nodes tell two cracks apart; smaller cells keep them further apart",
                               summary.third_cracks)});
  if (summary.spacing > kPartedBy * summary.most_spacing)
    out.push_back(
        {"spacing",
         fmt::format(
             "particles of body '{}' came {:.3g} cells apart, and the basis bridges {:g}: a body parts there "
             "without a law of fracture; {}",
             summary.spacing_body, summary.spacing, summary.most_spacing,
             cure_of_parting(summary.settings))});
  if (summary.splits && summary.splits->held > 0)
    out.push_back(
        {"splits",
         fmt::format(
             "{} edges of domains are longer than method.split allows, and stay so: they were halved {} "
             "times, or lie across an axis; a body is drawn out there to a thread, or parts",
             summary.splits->held, constants::splitting::kMostHalvings)});
  if (std::abs(summary.energy_error) > kMostDrift)
    out.push_back({"energy", fmt::format("the energy balance drifted by {}{} % (history.csv shows when): {}",
                                         summary.energy_error > 0 ? "+" : "", percent(summary.energy_error),
                                         cure_of_drift(summary))});
  return out;
}

namespace {

/// A body that parts is why normals and pairs are not found, and energy drifts.
bool is_cause(const RunWarning& warning) { return warning.about == "spacing"; }

std::string flow_warning(const RunSummary& summary) {
  return fmt::format(
      "body '{}' flows, and the domains of the basis follow F, which says nothing of neighbours after flow; "
      "method.basis: ugimp, or bspline2, keeps them as they were seeded",
      summary.settings.flowing_body);
}

}  // namespace

std::vector<std::string> all_warnings(const RunSummary& summary) {
  std::vector<RunWarning> figures = run_warnings(summary);
  std::vector<std::string> out;
  const auto add = [&](bool causes) {
    for (const RunWarning& warning : figures)
      if (is_cause(warning) == causes) out.push_back(warning.text);
  };
  const auto add_scene = [&] {
    out.insert(out.end(), summary.scene_warnings.begin(), summary.scene_warnings.end());
  };
  if (summary.status != "failed") {
    add_scene();
    for (const RunWarning& warning : figures) out.push_back(warning.text);
    return out;
  }
  if (summary.settings.follows_shape && !summary.settings.flowing_body.empty())
    out.push_back(flow_warning(summary));
  add(true);
  add_scene();
  add(false);
  return out;
}

}  // namespace mpmfast
