// N20 Fig. 4: three blocks that meet at a point, pressed by 5 %, against one velocity field.

#include <algorithm>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

using Overrides = std::vector<Override>;

Outcome pressed(Overrides overrides, const Overrides& more) {
  overrides.insert(overrides.end(), more.begin(), more.end());
  overrides.push_back({"output.frames", "0"});
  return run(scene_file("three_materials.yaml", overrides));
}

struct Difference {
  double stress = 0;  ///< largest relative difference of the mean axial stress from 1 % strain on
  double apart = 0;  ///< how much further the upper blocks have parted than in one field, cells; < 0: overlap
};

Difference against_one_field(const Overrides& scene, const Overrides& contact) {
  // In one field the strain that comes with the contact: average with published normals.
  const std::string strain = contact.front().second == "smoothed_max_margin" ? "average+" : "average";
  const Outcome one = pressed(scene, {{"contact", "none"}, {"method.strain", strain}}),
                three = pressed(scene, contact);
  REQUIRE(one.failure == "");
  REQUIRE(three.failure == "");
  const auto column = [](const Outcome& outcome, const char* name) { return outcome.history.at(name); };
  const auto time = column(three, "time_s"), stress = column(three, "all.mean_stress_yy_Pa");
  const auto t = column(one, "time_s"), s = column(one, "all.mean_stress_yy_Pa");
  Difference difference;
  for (std::size_t k = 0; k < time.size(); ++k) {
    const auto at = static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), time[k]) - t.begin());
    if (time[k] * 0.9622 / 0.1 < 0.01 || at == 0 || at == t.size()) continue;
    const double share = (time[k] - t[at - 1]) / (t[at] - t[at - 1]);
    const double expected = s[at - 1] + share * (s[at] - s[at - 1]);
    difference.stress = std::max(difference.stress, std::abs(stress[k] / expected - 1));
  }
  const auto distance = [&](const Outcome& outcome) {
    return column(outcome, "right.x_m").back() - column(outcome, "left.x_m").back();
  };
  difference.apart = (distance(three) - distance(one)) / 5e-3;
  return difference;
}

/// The meeting point in the middle of a cell.
const Overrides kMidCell{{"bodies.0.box.to", "[40 mm, 52.5 mm]"},
                         {"bodies.1.box.from", "[0 mm, 52.5 mm]"},
                         {"bodies.1.box.to", "[22.5 mm, 100 mm]"},
                         {"bodies.2.box.from", "[22.5 mm, 52.5 mm]"}};

TEST_CASE(
    "three materials: pairs solved at once are one field within 0.4 %; the lump parts the upper blocks") {
  // At the meeting point each field faces the lump of the two others, whose normal lies between those of its
  // two surfaces. The upper blocks do not enter each other in any case.
  struct Reached {
    Overrides contact, scene;
    double stress, apart;
  };
  const Overrides lump{{"contact.normal", "logistic_regression"}},
      pairs{{"contact.normal", "logistic_regression"}, {"contact.fields", "pairs"}},
      ours{{"contact.normal", "smoothed_max_margin"}}, gradient{{"contact.normal", "average_gradient"}};
  for (const Reached& reached : {Reached{lump, {}, 0.02, 0.05},           // measured 1.7 %, 0.04 cells
                                 Reached{lump, kMidCell, 0.05, 0.06},     // 4.2 %, 0.05
                                 Reached{pairs, {}, 0.004, 0.035},        // 0.34 %, 0.024
                                 Reached{pairs, kMidCell, 0.004, 0.035},  // 0.3 %, 0.027
                                 Reached{ours, {}, 0.004, 0.035},         // 0.34 %, 0.028
                                 Reached{ours, kMidCell, 0.004, 0.035},   // 0.32 %, 0.028
                                 Reached{gradient, {}, 0.085, 0.07}}) {   // 7.6 %, 0.06
    CAPTURE(reached.contact.size());
    CAPTURE(reached.contact.front().second);
    CAPTURE(reached.scene.size());
    const Difference difference = against_one_field(reached.scene, reached.contact);
    CHECK(difference.stress < reached.stress);
    CHECK(difference.apart > -0.01);
    CHECK(difference.apart < reached.apart);
  }
}

TEST_CASE("bodies side by side keep their energy under a held piston at its plane") {
  const Outcome out =
      run(scene_file("three_materials.yaml",
                     {{"output.frames", "0"},
                      {"boundaries.top", "{piston: 0.9622 m/s, direction: down, held: true, at: plane}"}}));
  REQUIRE(out.failure == "");
  // Measured 0.08 %. Where a line through rows held them along the plane too, the contact between them made
  // energy until they were thrown out.
  CHECK(std::abs(out.summary.energy_error) < 0.003);
}

}  // namespace
}  // namespace mpmfast
