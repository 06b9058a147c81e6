// Where pictures look, how large they draw domains, and that their labels are whole.

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "engine/output/drawn.hpp"
#include "engine/output/paint.hpp"
#include "engine/output/projection.hpp"
#include "engine/output/text_lines.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

constexpr double kCell = 0.1;  // of small_scene

/// A square lattice of the seeded spacing, whose lower left corner is at `corner`. One body.
Particles<2> seeded(int side, double corner = 0) {
  Particles<2> particles;
  particles.allocate(static_cast<std::size_t>(side * side),
                     {Quantity::position, Quantity::deformation_gradient, Quantity::initial_volume,
                      Quantity::kirchhoff_stress});
  const double apart = 0.5 * kCell;
  for (int i = 0; i < side * side; ++i) {
    const auto p = static_cast<std::size_t>(i);
    particles.id()[p] = static_cast<std::uint32_t>(i);
    particles.body()[p] = 0;
    particles.column(Quantity::position, 0)[p] = corner + (i % side + 0.5) * apart;
    particles.column(Quantity::position, 1)[p] = corner + (i / side + 0.5) * apart;
    particles.column(Quantity::initial_volume)[p] = apart * apart;
    for (const int k : {0, 3}) particles.column(Quantity::deformation_gradient, k)[p] = 1;
    particles.column(Quantity::kirchhoff_stress, 0)[p] = i;
  }
  return particles;
}

/// Every third is sheared so that its F has no correct digit of J.
void shear(Particles<2>& particles) {
  for (std::size_t p = 0; p < particles.size(); p += 3) {
    particles.column(Quantity::deformation_gradient, 0)[p] = 3e6;
    particles.column(Quantity::deformation_gradient, 1)[p] = -7e6;
    particles.column(Quantity::deformation_gradient, 2)[p] = 1e6;
  }
}

Scene scene_with(BasisKind basis, Space space = Space::plane_strain) {
  Scene scene = small_scene(space);
  scene.method.basis = basis;
  return scene;
}

/// Are the outermost pixels white? Text that is cut touches them.
bool has_white_edge(Canvas canvas) {
  const std::vector<std::uint8_t> pixels = canvas.pixels();
  const auto white = [&](int x, int y) {
    const std::size_t at = 3 * static_cast<std::size_t>(y * canvas.width() + x);
    return pixels[at] == 255 && pixels[at + 1] == 255 && pixels[at + 2] == 255;
  };
  for (int y = 0; y < canvas.height(); ++y)
    if (!white(0, y) || !white(canvas.width() - 1, y)) return false;
  for (int x = 0; x < canvas.width(); ++x)
    if (!white(x, 0) || !white(x, canvas.height() - 1)) return false;
  return true;
}

/// The texts of a picture as a viewer of vectors shows them.
std::vector<std::string> texts_of(const Particles<2>& particles, const Scene& scene, const std::string& field,
                                  double time = 0) {
  const TemporaryFolder folder;
  paint_particles(particles, scene, field, time, framing_of(particles, scene, field), PictureFormat::svg)
      .write(folder.path() / "x.svg");
  pugi::xml_document svg;
  REQUIRE(svg.load_file((folder.path() / "x.svg").c_str()).status == pugi::status_ok);
  std::vector<std::string> out;
  for (const auto& text : svg.select_nodes("//text")) out.emplace_back(text.node().text().as_string());
  return out;
}

}  // namespace

TEST_CASE("a frame is that of the particles, however far their domains are stretched") {
  for (const BasisKind basis : {BasisKind::ugimp, BasisKind::lcpdi, BasisKind::bspline2}) {
    CAPTURE(static_cast<int>(basis));
    const Scene scene = scene_with(basis);
    Particles<2> particles = seeded(16);
    const Framing before = framing_of(particles, scene, "body");
    for (std::size_t d = 0; d < 2; ++d) {
      CHECK(before.box[d]->lower == doctest::Approx(0));
      CHECK(before.box[d]->upper == doctest::Approx(0.8));
    }
    shear(particles);
    const Framing after = framing_of(particles, scene, "body");
    for (std::size_t d = 0; d < 2; ++d) {
      CHECK(after.box[d]->lower >= 0.25 * kCell - kCell);
      CHECK(after.box[d]->lower <= 0.25 * kCell);
      CHECK(after.box[d]->upper <= 0.8 - 0.25 * kCell + kCell);
    }
  }
}

TEST_CASE("a particle that was thrown out of the grid does not widen the frame, one alone is shown") {
  const Scene scene = small_scene(Space::plane_strain);
  Particles<2> particles = seeded(16);
  particles.column(Quantity::position, 0)[5] = 1e6;
  particles.column(Quantity::position, 1)[7] = -1e300;
  const Framing framing = framing_of(particles, scene, "body");
  CHECK(framing.box[0]->upper == doctest::Approx(0.8));
  CHECK(framing.box[1]->lower == doctest::Approx(0));
  CHECK(paint_particles(particles, scene, "body", 0, framing).width() > 800);
  Particles<2> lost = seeded(1, 50);
  CHECK(framing_of(lost, scene, "body").box[0]->lower == doctest::Approx(50));
}

TEST_CASE("a frame is a twentieth wider than what it shows") {
  const Scene scene = small_scene(Space::plane_strain);
  const Particles<2> particles = seeded(16);
  Canvas canvas = paint_particles(particles, scene, "body", 0, framing_of(particles, scene, "body"));
  const std::vector<std::uint8_t> pixels = canvas.pixels();
  const auto at = [&](int x, int y) {
    const std::uint8_t* p = &pixels[3 * static_cast<std::size_t>(y * canvas.width() + x)];
    return Colour{p[0], p[1], p[2]};
  };
  const int middle = canvas.height() / 2;
  int first = 0, last = canvas.width() - 1;
  while (at(first, middle) != body_colour(0)) ++first;
  while (at(last, middle) != body_colour(0)) --last;
  const Colour ink{30, 30, 30};  // the box is the first of it from within
  int left = first, right = last;
  while (left > 0 && at(left, middle) != ink) --left;
  while (right + 1 < canvas.width() && at(right, middle) != ink) ++right;
  const double body = last - first + 1;
  CHECK((right - left) / body == doctest::Approx(1.05).epsilon(0.005));
}

TEST_CASE("a domain that is too long is drawn along its principal axis as long as shape functions take it") {
  Mat<2> edges;
  edges << 0.3, 0.1, 0.1, 0.2;
  CHECK(with_diagonals_up_to(edges, 1) == edges);
  edges << 5, 0.1, 0.2, 0.3;
  const Mat<2> cut = with_diagonals_up_to(edges, 1);
  CHECK(cut.squaredNorm() == doctest::Approx(1).epsilon(1e-12));  // of orthogonal edges, the half-diagonal
  CHECK(std::abs(cut.col(0).dot(cut.col(1))) < 1e-12);
  // R Rᵀ has the same principal axes.
  const Mat<2> moments = edges * edges.transpose();
  CHECK(std::abs(cut.col(0).dot(moments * cut.col(1))) < 1e-12 * moments.norm());
}

TEST_CASE(
    "domains that follow F are drawn with the limit of the shape functions, others as they were seeded") {
  Particles<2> particles = seeded(1);
  particles.column(Quantity::deformation_gradient, 0)[0] = 50;
  const double limit = largest_half_diagonal(scene_with(BasisKind::lcpdi));
  CHECK(limit == doctest::Approx(kLargestHalfDiagonal * kCell));
  const Mat<2> followed = drawn_half_edges(particles, scene_with(BasisKind::lcpdi), 0);
  CHECK((followed.col(0) + followed.col(1)).norm() == doctest::Approx(limit));
  const Mat<2> seeded_edges = drawn_half_edges(particles, scene_with(BasisKind::ugimp), 0);
  CHECK(seeded_edges.isApprox(0.25 * kCell * Mat<2>::Identity()));
  particles.column(Quantity::deformation_gradient, 0)[0] = 2;  // within the limit: as it is deformed
  CHECK(drawn_half_edges(particles, scene_with(BasisKind::ugimp), 0)(0, 0) == doctest::Approx(0.5 * kCell));
  particles.column(Quantity::initial_volume)[0] = -1;  // of a file, by a J without a digit
  CHECK(drawn_half_edges(particles, scene_with(BasisKind::ugimp), 0).isApprox(seeded_edges));
  particles.column(Quantity::deformation_gradient, 0)[0] = std::nan("");
  CHECK_FALSE(drawn_half_edges(particles, scene_with(BasisKind::ugimp), 0).allFinite());
}

TEST_CASE("a ball in 3-D is drawn no larger than the largest domain") {
  Particles<3> one;
  one.allocate(1, {Quantity::position, Quantity::deformation_gradient, Quantity::initial_volume});
  one.id()[0] = one.body()[0] = 0;
  for (const int k : {0, 4, 8}) one.column(Quantity::deformation_gradient, k)[0] = 1;
  one.column(Quantity::initial_volume)[0] = std::pow(0.5 * kCell, 3);
  const auto radius = [&](BasisKind basis) {
    return drawn_radius(one, scene_with(basis, Space::three_dimensional), 0);
  };
  CHECK(radius(BasisKind::ugimp) == doctest::Approx(0.25 * kCell));
  for (const int k : {0, 4, 8}) one.column(Quantity::deformation_gradient, k)[0] = 1e4;
  CHECK(radius(BasisKind::ugimp) == doctest::Approx(0.25 * kCell));
  CHECK(radius(BasisKind::lcpdi) == doctest::Approx(kLargestHalfDiagonal * kCell / std::numbers::sqrt3));
}

TEST_CASE("no label of a picture is cut, wherever the bodies are and whatever the numbers") {
  Scene scene = small_scene(Space::plane_strain);
  for (const double corner : {0.0, -285000.0, 123456.0, 0.123}) {
    CAPTURE(corner);
    scene.grid.origin = {corner, corner, corner};
    Particles<2> particles = seeded(16, corner);
    for (const double size : {1.0, 1e-25, 1e22}) {
      CAPTURE(size);
      for (std::size_t p = 0; p < particles.size(); ++p)
        particles.column(Quantity::kirchhoff_stress, 0)[p] = size * (1 + 1e-4 * double(p));
      const Framing framing = framing_of(particles, scene, "stress_xx");
      CHECK(has_white_edge(paint_particles(particles, scene, "stress_xx", 1e-3, framing)));
    }
  }
}

TEST_CASE("no label of a picture in 3-D is cut") {
  Scene scene = small_scene(Space::three_dimensional);
  for (const double corner : {0.0, -285000.0, 5.25}) {
    CAPTURE(corner);
    scene.grid.origin = {corner, corner, corner};
    for (const double high : {0.01, 1.0, 20.0}) {
      CAPTURE(high);
      scene.grid.size = {1, 1, high};
      Particles<3> particles = particles_in_order<3>(ascending(200));
      for (std::size_t p = 0; p < particles.size(); ++p)
        for (int d = 0; d < 3; ++d) {
          double& x = particles.column(Quantity::position, d)[p];
          x = corner + (d == 2 ? high : 1) * x;
        }
      const Framing framing = framing_of(particles, scene, "stress_xx");
      CHECK(has_white_edge(paint_particles(particles, scene, "stress_xx", 1e-3, framing)));
    }
  }
}

TEST_CASE("the numbers along the edges of a box in 3-D lie within its frame, however many digits they have") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.svg";
  // From `near` on numbers have one digit or two, from `far` on a dozen.
  const double near = 1, far = -2850000000;
  for (const auto& corner : {Vec3{near, near, near}, Vec3{far, near, near}, Vec3{near, far, near},
                             Vec3{near, near, far}, Vec3{far, near, far}, Vec3{far, far, far}})
    for (const double wide : {0.5, 1.0, 20.0})
      for (const double high : {0.5, 1.0, 20.0})
        for (const bool bar : {false, true}) {
          CAPTURE(corner[0]);
          CAPTURE(corner[1]);
          CAPTURE(corner[2]);
          CAPTURE(wide);
          CAPTURE(high);
          CAPTURE(bar);
          const ViewBox view({Range{corner[0], corner[0] + wide}, Range{corner[1], corner[1] + 1},
                              Range{corner[2], corner[2] + high}},
                             {"m", 1});
          Labels labels;
          labels.length = {"m", 1};
          if (bar) labels.bar = Range{0, 1};
          Picture picture(view.across(), view.up(), labels, PictureFormat::svg);
          const double left = picture.at(view.across().lower, 0).x,
                       right = picture.at(view.across().upper, 0).x;
          view.draw_labels(picture);
          picture.canvas().write(path);
          pugi::xml_document svg;
          REQUIRE(svg.load_file(path.c_str()).status == pugi::status_ok);
          for (const auto& found : svg.select_nodes("//text")) {
            const pugi::xml_node text = found.node();
            CAPTURE(text.text().as_string());
            const double x = text.attribute("x").as_double(),
                         width = text.attribute("textLength").as_double();
            CHECK(x > left);
            CHECK(x + width < right);
          }
        }
}

TEST_CASE("a long title goes on in the next line, and no word of it is lost") {
  Scene scene = small_scene(Space::plane_strain);
  scene.title = "A title";
  Canvas plain = paint_particles(seeded(16), scene, "body", 0, framing_of(seeded(16), scene, "body"));
  for (int k = 0; k < 30; ++k) scene.title += " of words " + std::to_string(k);
  Particles<2> narrow = seeded(16);
  for (std::size_t p = 0; p < narrow.size(); ++p) narrow.column(Quantity::position, 0)[p] *= 0.01;
  std::string all;
  const std::vector<std::string> texts = texts_of(narrow, scene, "stress_xx", 1e-3);
  for (const std::string& text : texts) all += text + " ";
  CHECK(all.find(scene.title + " stress xx at 1 ms") != std::string::npos);
  Canvas canvas = paint_particles(narrow, scene, "stress_xx", 1e-3, framing_of(narrow, scene, "stress_xx"));
  CHECK(canvas.height() > plain.height() + 24);
  CHECK(has_white_edge(std::move(canvas)));
}

TEST_CASE("lines break at blanks, within a word that is wider than a line, and end where there are enough") {
  const double space = Canvas::text_width("abcd efgh ");
  CHECK(text_lines("abcd", space, 3) == std::vector<std::string>{"abcd"});
  CHECK(text_lines("abcd efgh ijkl", space, 3) == std::vector<std::string>{"abcd efgh", "ijkl"});
  const auto broken = text_lines(std::string(60, 'x'), space, 99);
  std::string all;
  for (const std::string& line : broken) {
    CHECK(Canvas::text_width(line) <= space);
    all += line;
  }
  CHECK(all == std::string(60, 'x'));
  const auto few = text_lines(std::string(60, 'x'), space, 2);
  REQUIRE(few.size() == 2);
  CHECK(few[1].find("...") == few[1].size() - 3);
  CHECK(text_lines("", space, 2) == std::vector<std::string>{""});
}
