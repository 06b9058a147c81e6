#include <fmt/format.h>

#include <cmath>
#include <string>

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

const char* cure_of_drift(const RunSummary& summary) {
  if (summary.energy_error > 0)
    return "noise grows; a smaller time.cfl, or method.position: grid_end, may help";
  if (summary.averaged_strain)
    return "the averaged strain takes energy from bodies of few cells that vibrate, bounce or spin: set "
           "method.strain: average+; if it still drifts, smaller cells";
  return "the method took it; smaller cells, or another method.update, may help";
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
                     "contact.volume_screen or contact.mass_screen",
                     percent(part), 100 * kMostScreened)});
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
             "without a law of fracture; more particles_per_cell{} keep it whole for longer",
             summary.spacing_body, summary.spacing, summary.most_spacing,
             summary.most_spacing <= 1 ? " or a CPDI basis"
             : summary.splits          ? ""
                                       : " or method.split")});
  if (summary.splits && summary.splits->held > 0)
    out.push_back(
        {"splits",
         fmt::format(
             "{} edges of domains are longer than method.split allows, and stay so: they were halved {} "
             "times, or lie across an axis; a body is drawn out there to a thread, or parts",
             summary.splits->held, kMostHalvings)});
  if (std::abs(summary.energy_error) > kMostDrift)
    out.push_back({"energy", fmt::format("the energy balance drifted by {}{} % (history.csv shows when): {}",
                                         summary.energy_error > 0 ? "+" : "", percent(summary.energy_error),
                                         cure_of_drift(summary))});
  return out;
}

}  // namespace mpmfast
