// Pictures of every kind against recorded ones (tests/recorded/picture_*.svg), which a person can look at;
// what fills a colour bar, many strips, is left out there.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <pugixml.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "engine/output/drawn.hpp"
#include "engine/output/paint.hpp"
#include "engine/output/picture.hpp"
#include "recorded.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

/// What a picture has, one after the other: words, and numbers between them.
struct Item {
  std::string words;
  std::vector<double> numbers;
  bool is_text = false;     ///< numbers: left end, line, width, colour
  std::size_t outline = 0;  ///< numbers of a path before those of its points, which are colours in per cent

  /// Of the many strips that fill a colour bar, 20 pixels wide, those of one colour?
  bool is_strips() const {
    if (outline == 0 || !words.ends_with("MLLLZ") || numbers.size() < outline + 8) return false;
    const auto extent = [&](std::size_t from, std::size_t count) {
      double lower = numbers[from], upper = lower;
      for (std::size_t k = from; k < from + count; k += 2) {
        lower = std::min(lower, numbers[k]);
        upper = std::max(upper, numbers[k]);
      }
      return upper - lower;
    };
    return std::abs(extent(outline, numbers.size() - outline) - 20) < 0.02 && extent(outline + 1, 7) < 3;
  }
};

/// Numbers and the words around them, blanks and commas left out.
void add_parts(Item& item, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if ((c >= '0' && c <= '9') || c == '-' || c == '.') {
      std::size_t bytes = 0;
      item.numbers.push_back(std::stod(text.substr(at), &bytes));
      at += bytes;
      continue;
    }
    if (c != ' ' && c != ',') item.words += c;
    ++at;
  }
}

/// An attribute, which older Cairos write as a style.
std::string attribute(const pugi::xml_node& node, const std::string& name) {
  if (const auto own = node.attribute(name.c_str())) return own.value();
  const std::string style = node.attribute("style").value();
  const std::size_t at = style.find(name + ":");
  if (at == std::string::npos || (at > 0 && style[at - 1] == '-')) return "none";
  const std::size_t begin = at + name.size() + 1;
  return style.substr(begin, style.find(';', begin) - begin);
}

std::string red_green_blue(const std::string& hex) {
  std::string out;
  for (std::size_t k = 1; k + 1 < hex.size(); k += 2)
    out += std::to_string(std::stoi(hex.substr(k, 2), nullptr, 16)) + " ";
  return out;
}

void add_items(std::vector<Item>& out, const pugi::xml_node& node) {
  const std::string name = node.name();
  Item item;
  item.words = name + " ";
  if (name == "svg") {
    add_parts(item, std::string(node.attribute("width").value()) + " " + node.attribute("height").value());
  } else if (name == "title") {
    item.words += node.text().as_string();
  } else if (name == "rect") {
    add_parts(item, attribute(node, "fill"));
  } else if (name == "path") {
    for (const char* part : {"fill", "fill-rule", "stroke", "stroke-width"}) {
      const bool shown = std::string(part).find('-') == std::string::npos || attribute(node, part) != "none";
      if (shown) add_parts(item, " " + attribute(node, part) + ";");
    }
    item.outline = item.numbers.size();
    add_parts(item, node.attribute("d").value());
    // Older Cairos go back to the start of a closed path.
    if (item.words.ends_with("ZM")) {
      item.words.pop_back();
      item.numbers.resize(item.numbers.size() - 2);
    }
  } else if (name == "text") {
    item.is_text = true;
    for (const char* part : {"x", "y", "textLength"})
      item.numbers.push_back(node.attribute(part).as_double());
    add_parts(item, red_green_blue(node.attribute("fill").value()));
    item.words += node.text().as_string();
  } else if (name == "g") {
    item.words += attribute(node, "font-size");
  }
  if (name == "svg" || name == "title" || name == "rect" || name == "path" || name == "text" ||
      (name == "g" && node.attribute("font-size")))
    out.push_back(item);
  for (const auto& child : node.children()) add_items(out, child);
}

std::vector<Item> items_of(const std::filesystem::path& svg) {
  pugi::xml_document document;
  REQUIRE_MESSAGE(document.load_file(svg.c_str()).status == pugi::status_ok, svg.string());
  std::vector<Item> out;
  add_items(out, document.document_element());
  std::erase_if(out, [](const Item& item) { return item.is_strips(); });
  return out;
}

/// Cairo writes places in 256ths of a pixel, and texts lie in hundredths: two such roundings.
constexpr double kRounding = 0.011;

bool is_near(double a, double b) { return std::abs(a - b) <= kRounding; }

/// Texts are as wide as the fonts of the machine make them, and hang by their left, middle or right end.
bool same_text(const Item& a, const Item& b) {
  bool same = is_near(a.numbers[1], b.numbers[1]);
  for (std::size_t k = 3; k < 6; ++k) same = same && a.numbers[k] == b.numbers[k];
  bool hangs = false;
  for (const double share : {0.0, 0.5, 1.0})
    hangs = hangs || is_near(a.numbers[0] + share * a.numbers[2], b.numbers[0] + share * b.numbers[2]);
  return same && hangs;
}

bool same_item(const Item& a, const Item& b) {
  if (a.words != b.words || a.numbers.size() != b.numbers.size()) return false;
  if (a.is_text) return same_text(a, b);
  for (std::size_t k = 0; k < a.numbers.size(); ++k) {
    double most = kRounding;
    if (k < a.outline) most = 0.4;              // a 255th, in per cent
    if (a.words.starts_with("svg ")) most = 0;  // whole pixels
    if (std::abs(a.numbers[k] - b.numbers[k]) > most) return false;
  }
  return true;
}

std::string shown(const Item& item) {
  std::string out = item.words;
  for (const double number : item.numbers) out += " " + std::to_string(number);
  return out;
}

void check_recorded(const std::string& name, Canvas canvas) {
  CAPTURE(name);
  const TemporaryFolder folder;
  const auto record = test::record_folder();
  const auto path = (record.empty() ? folder.path() : record) / ("picture_" + name + ".svg");
  canvas.write(path);
  if (!record.empty()) return;
  const auto recorded = items_of(test::recorded_file(path.filename()));
  const auto drawn = items_of(path);
  CHECK(drawn.size() == recorded.size());
  for (std::size_t k = 0; k < std::min(drawn.size(), recorded.size()); ++k) {
    if (same_item(drawn[k], recorded[k])) continue;
    FAIL_CHECK("drawn: " << shown(drawn[k]) << "\nrecorded: " << shown(recorded[k]));
    return;
  }
}

template <int Dim>
void check_picture(const std::string& name, const Particles<Dim>& particles, const Scene& scene,
                   const std::string& field, double time, const Polylines& lines = {}) {
  check_recorded(name, paint_particles(particles, scene, field, time, framing_of(particles, scene, field),
                                       PictureFormat::svg, lines));
}

/// A body of four by three particles that is bent, pressed and sheared; each third particle is the punch's.
/// @param length  of a cell, m
Particles<2> bent(double length, const std::vector<Quantity>& more = {}) {
  constexpr int kAcross = 4, kUp = 3;
  std::vector<Quantity> quantities{Quantity::position, Quantity::velocity, Quantity::deformation_gradient,
                                   Quantity::kirchhoff_stress, Quantity::initial_volume};
  quantities.insert(quantities.end(), more.begin(), more.end());
  Particles<2> particles;
  particles.allocate(kAcross * kUp, quantities);
  for (int i = 0; i < kAcross * kUp; ++i) {
    const auto p = static_cast<std::size_t>((7 * i + 3) % (kAcross * kUp));  // in any order
    const double x = 0.25 + 0.5 * (i % kAcross), y = 0.25 + 0.5 * (i / kAcross);
    particles.id()[p] = static_cast<std::uint32_t>(i);
    particles.body()[p] = static_cast<std::uint16_t>(i % 4 == 3 ? 2 : i / kAcross % 2);
    particles.column(Quantity::position, 0)[p] = length * (x + 0.1 * y * y + 0.3);
    particles.column(Quantity::position, 1)[p] = length * (1.1 * y + 0.2 * x + 0.1);
    particles.column(Quantity::velocity, 0)[p] = 3 * x - y;
    particles.column(Quantity::velocity, 1)[p] = -2 * x - 0.1;
    particles.column(Quantity::deformation_gradient, 0)[p] = 1 + 0.1 * x;
    particles.column(Quantity::deformation_gradient, 1)[p] = 0.2 * y;
    particles.column(Quantity::deformation_gradient, 2)[p] = 0.2 - 0.3 * x;
    particles.column(Quantity::deformation_gradient, 3)[p] = 1.1 - 0.2 * y;
    particles.column(Quantity::initial_volume)[p] = 0.25 * length * length;
    for (int k = 0; k < 4; ++k)
      particles.column(Quantity::kirchhoff_stress, k)[p] = 1e6 * (x * (k + 1) - y * (3 - k) - 0.5 * k);
  }
  return particles;
}

Scene bent_scene(Space space, double cell) {
  Scene scene = small_scene(space);
  scene.grid = {{0, 0, 0}, {4 * cell, 3 * cell, 0}, cell};
  return scene;
}

/// A tower of balls over a plate; every value depends on the number alone.
Particles<3> tower(std::uint32_t count) {
  Particles<3> particles;
  particles.allocate(count, {Quantity::position, Quantity::velocity, Quantity::deformation_gradient,
                             Quantity::kirchhoff_stress, Quantity::initial_volume});
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t p = (5 * i + 2) % count;
    particles.id()[p] = i;
    particles.body()[p] = static_cast<std::uint16_t>(i % 3);
    particles.column(Quantity::position, 0)[p] = 0.2 + 0.31 * (i % 4);
    particles.column(Quantity::position, 1)[p] = 0.1 + 0.24 * (i / 4 % 3);
    particles.column(Quantity::position, 2)[p] = 0.05 + 0.37 * (i / 2);
    for (int d = 0; d < 3; ++d) {
      particles.column(Quantity::velocity, d)[p] = 0.5 * i * (d + 1) - d;
      particles.column(Quantity::deformation_gradient, 4 * d)[p] = 1 + 0.05 * i * (d - 1);
    }
    particles.column(Quantity::deformation_gradient, 1)[p] = 0.3;
    particles.column(Quantity::initial_volume)[p] = 1e-3 * (1 + i);
    for (int k = 0; k < 6; ++k) particles.column(Quantity::kirchhoff_stress, k)[p] = -2e9 - 1e8 * i * (k + 1);
  }
  return particles;
}

Scene tower_scene() {
  Scene scene = small_scene(Space::three_dimensional);
  scene.grid = {{0, 0, 0}, {1.5, 1, 3}, 0.5};
  return scene;
}

TEST_CASE("bodies in the plane are drawn as they are deformed, each in its colour, with cracks over them") {
  check_picture("bodies", bent(1), bent_scene(Space::plane_strain, 1), "body", 1.25e-3,
                {{{0.5, 0.5}, {1.25, 0.75}, {1.5, 1.5}, {9, 9}, {1, 1}}, {{0.25, 0.25}}});
}

TEST_CASE("about an axis of symmetry the sizes of domains are those of rings, and the axes are r and z") {
  Particles<2> particles = bent(1e-3, {Quantity::out_of_plane_stretch});
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.column(Quantity::out_of_plane_stretch)[p] =
        1.05 + 0.01 * static_cast<double>(particles.id()[p]);
    particles.column(Quantity::initial_volume)[p] *= 2 * 3.14159265358979 * 1e-3;
  }
  Scene scene = bent_scene(Space::axisymmetric, 1e-3);
  scene.method.basis = BasisKind::lcpdi;
  check_picture("rings", particles, scene, "pressure", 0);
}

TEST_CASE("a range of one sign has a sequential scale, and outliers are told behind the title") {
  Particles<2> particles = bent(1e-3);
  const auto stress = [&](std::size_t p) -> double& {
    return particles.column(Quantity::kirchhoff_stress, 3)[p];
  };
  for (std::size_t p = 0; p < particles.size(); ++p)
    stress(p) = 1e9 * (2 + 0.1 * static_cast<double>(particles.id()[p]));
  Scene scene = bent_scene(Space::plane_stress, 1e-3);
  scene.thickness = 2e-3;
  for (std::size_t p = 0; p < particles.size(); ++p) particles.column(Quantity::initial_volume)[p] *= 2e-3;
  Framing framing = framing_of(particles, scene, "stress_xy");
  framing.values = Range{2.1e9, 2.6e9};
  check_recorded("outliers",
                 paint_particles(particles, scene, "stress_xy", -2.5e-5, framing, PictureFormat::svg));
}

TEST_CASE("a range of both signs has a scale that is symmetric about zero") {
  check_picture("both_signs", bent(0.01), bent_scene(Space::plane_strain, 0.01), "stress_xx", 3.25);
}

TEST_CASE("where all is one value the title says it, and there is no bar") {
  Particles<2> particles = bent(2e-6);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.column(Quantity::velocity, 0)[p] = -0.25;
    particles.column(Quantity::velocity, 1)[p] = 0;
  }
  check_picture("one_value", particles, bent_scene(Space::plane_strain, 2e-6), "velocity_x", 4e-9);
}

TEST_CASE("stored edges of domains are drawn, with the limit of shape functions that follow F") {
  Particles<2> particles = bent(1, {Quantity::domain_edges});
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto i = static_cast<double>(particles.id()[p]);
    const double edges[4] = {0.2, -0.02 * i, 0.05 * i, 0.3};
    for (int k = 0; k < 4; ++k) particles.column(Quantity::domain_edges, k)[p] = edges[k] * (i == 5 ? 4 : 1);
  }
  Scene scene = bent_scene(Space::plane_strain, 1);
  scene.method.basis = BasisKind::lcpdi;
  check_picture("stored_edges", particles, scene, "material", 12);
}

TEST_CASE("domains of particles that were split have their share, and those of each body its counts a cell") {
  Particles<2> particles = bent(1, {Quantity::domain_share});
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const bool halved = particles.id()[p] % 2 == 0;
    particles.column(Quantity::domain_share, 0)[p] = halved ? 0.5 : 1;
    particles.column(Quantity::domain_share, 1)[p] = particles.id()[p] % 3 == 0 ? 0.25 : 1;
    particles.column(Quantity::initial_volume)[p] *=
        particles.column(Quantity::domain_share, 0)[p] * particles.column(Quantity::domain_share, 1)[p];
    if (particles.id()[p] == 6) particles.column(Quantity::deformation_gradient, 1)[p] = 30;  // as seeded
  }
  Scene scene = bent_scene(Space::plane_strain, 1);
  scene.bodies[1].particles_per_cell = {1, 3, 1};
  check_picture("split", particles, scene, "speed", 1e-6);
}

TEST_CASE("what lies beyond the grid does not widen a picture, and nothing at all shows the grid") {
  Particles<2> particles = bent(1);
  particles.column(Quantity::position, 0)[4] = 1e4;
  particles.column(Quantity::position, 1)[7] = std::numeric_limits<double>::quiet_NaN();
  particles.column(Quantity::kirchhoff_stress, 2)[2] = std::numeric_limits<double>::quiet_NaN();
  Scene scene = bent_scene(Space::plane_strain, 1);
  scene.grid.origin = {-0.5, -0.25, 0};
  check_picture("lost", particles, scene, "stress_zz", 0.5);
  scene.grid.size = {40, 5, 0};
  check_picture("empty", Particles<2>(), scene, "pressure", 0);
}

TEST_CASE("a high and narrow picture has a line of its own for outliers") {
  Particles<2> particles = bent(1e-3);
  Scene scene = bent_scene(Space::plane_strain, 1e-3);
  scene.grid.size[1] *= 30;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.column(Quantity::position, 1)[p] *= 20;
    particles.column(Quantity::kirchhoff_stress, 0)[p] -= 7e6;
  }
  Framing framing = framing_of(particles, scene, "von_mises");
  framing.values = Range{1e6, 4e6};
  check_recorded("narrow", paint_particles(particles, scene, "von_mises", 0.02, framing, PictureFormat::svg));
}

TEST_CASE("balls in space are drawn from the front right and above, the near ones over the far ones") {
  check_picture("balls", tower(12), tower_scene(), "body", 2e-3);
}

TEST_CASE("balls in space have colours of a field with a bar, and the limits of a basis that follows F") {
  Scene scene = tower_scene();
  scene.method.basis = BasisKind::lcpdi;
  scene.grid.cell = 0.15;
  check_picture("balls_speed", tower(7), scene, "speed", 1);
}

TEST_CASE("a flat box in space that lies off the origin has its numbers along the edges") {
  Particles<3> particles = tower(8);
  Scene scene = tower_scene();
  scene.grid.origin = {-1.5e-3, 2e-3, -4e-3};
  scene.grid.size = {12e-3, 6e-3, 6e-3};
  scene.grid.cell = 1e-3;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.column(Quantity::position, 0)[p] = 1e-2 * particles.column(Quantity::position, 0)[p] - 2e-3;
    particles.column(Quantity::position, 1)[p] = 4e-3 * particles.column(Quantity::position, 1)[p] + 4e-3;
    particles.column(Quantity::position, 2)[p] = 1e-3 * particles.column(Quantity::position, 2)[p] - 3e-3;
    particles.column(Quantity::initial_volume)[p] *= 1e-8;
  }
  check_picture("flat_box", particles, scene, "pressure", 1e-4);
}

TEST_CASE("a colour bar is filled from end to end by strips in the colours of the values at their middles") {
  for (const Range& range : {Range{-3, 5}, Range{0.5, 2.75}, Range{-9e6, -2e6}}) {
    const ColourScale scale(range);
    Labels labels;
    labels.length = {"m", 1};
    labels.axes = "xy";
    labels.bar = scale.range();
    labels.bar_unit = "m";
    Picture picture({0, 2}, {0, 1}, labels, PictureFormat::svg);
    const PixelPoint lower = picture.at(0, 0), upper = picture.at(2, 1);
    picture.draw_colour_bar(scale);
    const TemporaryFolder folder;
    picture.canvas().write(folder.path() / "x.svg");
    pugi::xml_document document;
    REQUIRE(document.load_file((folder.path() / "x.svg").c_str()).status == pugi::status_ok);
    std::vector<Item> items;
    add_items(items, document.document_element());
    // Neighbours of one colour are in one path.
    std::vector<Item> strips;
    std::copy_if(items.begin(), items.end(), std::back_inserter(strips),
                 [](const Item& item) { return item.is_strips(); });
    const double height = lower.y - upper.y;
    const auto count = static_cast<std::size_t>(height);
    std::size_t k = 0;
    for (const Item& strip : strips)
      for (std::size_t at = strip.outline; at + 8 <= strip.numbers.size(); at += 8, ++k) {
        const auto number = [&](std::size_t n) { return strip.numbers[at + n]; };
        const double bottom = std::max({number(1), number(3), number(5), number(7)});
        const double top = std::min({number(1), number(3), number(5), number(7)});
        const double left = std::min({number(0), number(2), number(4), number(6)});
        const double right = std::max({number(0), number(2), number(4), number(6)});
        const double step = height / static_cast<double>(count),
                     from = lower.y - static_cast<double>(k) * step;
        CHECK(left == doctest::Approx(upper.x + 22).epsilon(1e-5));
        CHECK(right == doctest::Approx(upper.x + 42).epsilon(1e-5));
        CHECK(std::abs(bottom - from) <= kRounding);
        CHECK(std::abs(top - std::max(upper.y, from - 2 * step)) <= kRounding);
        const Colour colour =
            scale(scale.range().lower +
                  (static_cast<double>(k) + 0.5) / static_cast<double>(count) * scale.range().width());
        CHECK(std::abs(strip.numbers[0] - colour.red / 2.55) < 0.01);
        CHECK(std::abs(strip.numbers[1] - colour.green / 2.55) < 0.01);
        CHECK(std::abs(strip.numbers[2] - colour.blue / 2.55) < 0.01);
      }
    CHECK(k == count);
  }
}

TEST_CASE("the space beside a box is what the widest labels need, and twelve pixels") {
  const auto widest = [](const Range& range, double pixels, double apart, int fewest) {
    const std::vector<double> ticks = round_ticks(range, std::max(fewest, static_cast<int>(pixels / apart)));
    double out = 0;
    for (const double tick : ticks)
      out = std::max(out, Canvas::text_width(tick_label(tick, ticks[1] - ticks[0])));
    return out;
  };
  Labels labels;
  labels.length = {"m", 1};
  labels.axes = "xy";
  const auto sides = [&](const Range& x, const Range& y) {
    Picture picture(x, y, labels, PictureFormat::svg);
    const double left = picture.at(x.lower, 0).x, right = picture.at(x.upper, 0).x;
    return std::array<double, 3>{left, picture.canvas().width() - right,
                                 picture.at(0, y.lower).y - picture.at(0, y.upper).y};
  };
  const auto [left, right, height] = sides({0, 4e6}, {-2.5e6, 0.5e6});
  CHECK(right ==
        doctest::Approx(0.5 * Canvas::text_width("4e+06") + 12).epsilon(1e-6));  // a number at the end
  CHECK(left == doctest::Approx(12 + widest({-2.5e6, 0.5e6}, height, 90, 2) + 12).epsilon(1e-6));
  labels.bar = Range{1.2341e6, 1.2358e6};
  labels.bar_unit = "m/s";
  const auto with_bar = sides({0, 4}, {0, 3});
  CHECK(with_bar[0] == doctest::Approx(84));
  CHECK(with_bar[1] ==
        doctest::Approx(std::max(150.0, 22 + 20 + 11 + widest({1.2341e6, 1.2358e6}, with_bar[2], 90, 3) + 12))
            .epsilon(1e-6));
  CHECK(with_bar[1] > 151);
  labels.bar = Range{1, 2};
  labels.bar_unit = "a unit with a long name";
  CHECK(sides({0, 4}, {0, 3})[1] ==
        doctest::Approx(22 + Canvas::text_width(labels.bar_unit) + 12).epsilon(1e-6));
}

TEST_CASE("what lies so far off that Cairo's numbers would turn round is not drawn, on any side") {
  constexpr double kTurn = 16777216;  // pixels: 2^32 of Cairo's 256ths
  const auto count = [](const std::vector<PixelPoint>& centres) {
    const TemporaryFolder folder;
    Canvas canvas(50, 40, PictureFormat::svg);
    for (const PixelPoint& centre : centres) canvas.fill_disc(centre, 5, {1, 2, 3});
    canvas.write(folder.path() / "x.svg");
    return items_of(folder.path() / "x.svg").size();
  };
  const std::size_t none = count({});
  CHECK(count({{kTurn + 20, 20}, {20 - kTurn, 20}, {20, kTurn + 20}, {20, 20 - kTurn}}) == none);
  CHECK(count({{20, 20}}) == none + 1);
}

TEST_CASE(
    "a domain is drawn as it is up to the longest diagonal of either direction, else as it was seeded") {
  Scene scene = small_scene(Space::plane_strain);
  const double half = 0.25 * scene.grid.cell, most = constants::kMostHalfDiagonal * scene.grid.cell;
  std::mt19937_64 random(5);
  const auto in = [&](double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  std::array<int, 2> seen{};
  for (int k = 0; k < 200; ++k) {
    Particles<2> one;
    one.allocate(1, {Quantity::position, Quantity::deformation_gradient, Quantity::initial_volume});
    one.body()[0] = 0;
    one.column(Quantity::initial_volume)[0] = 4 * half * half;
    double f[4];
    for (int c = 0; c < 4; ++c) one.column(Quantity::deformation_gradient, c)[0] = f[c] = in(-3.5, 3.5);
    const double sum = std::hypot(f[0] + f[1], f[2] + f[3]),
                 difference = std::hypot(f[0] - f[1], f[2] - f[3]);
    const bool whole = half * std::max(sum, difference) <= most;
    ++seen[whole];
    const Mat<2> edges = drawn_half_edges(one, scene, 0);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        CHECK(edges(i, j) == doctest::Approx(whole ? half * f[2 * i + j] : i == j ? half : 0).epsilon(1e-12));
  }
  CHECK(seen[0] > 20);
  CHECK(seen[1] > 20);
}

TEST_CASE("one ball in space, one value") {
  Particles<3> particles = tower(1);
  check_picture("one_ball", particles, tower_scene(), "stress_yz", 0);
  check_picture("empty_box", Particles<3>(), tower_scene(), "body", 0);
}

}  // namespace
