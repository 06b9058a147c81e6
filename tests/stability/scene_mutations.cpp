// Every scene of configs/ with one thing wrong: a key left out, misspelt or given twice, a value of another
// kind or size. Each must be read, or refused with a place and a reason; nothing may crash, hang or ask for
// endless memory.

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>

#include "engine/plan/memory.hpp"
#include "engine/scene/text/tree.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;
namespace fs = std::filesystem;

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

/// A tree as YAML, an entry of a map a line, so that messages have lines to name.
std::string to_yaml(const Node& node) {
  if (node.kind == Node::Kind::null) return "~";
  if (node.kind == Node::Kind::scalar) return quoted(node.scalar);
  const bool map = node.kind == Node::Kind::map;
  std::string out = map ? "{" : "[";
  for (std::size_t k = 0; k < node.items.size(); ++k)
    out += (map ? "\n" + quoted(node.keys[k].text) + ": " : std::string()) + to_yaml(node.items[k]) + ",";
  return out + (map ? "}" : "]");
}

Node scalar(const std::string& text) {
  Node node;
  node.kind = Node::Kind::scalar;
  node.scalar = text;
  return node;
}

/// Calls f with every node that holds others, deepest last.
void for_each_holder(Node& node, const std::function<void(Node&)>& f) {
  if (!node.items.empty()) f(node);
  for (Node& item : node.items) for_each_holder(item, f);
}

/// The number that a text begins with, times a factor; nothing if it begins with none.
std::optional<Node> scaled(const Node& node, double factor) {
  if (node.kind != Node::Kind::scalar) return std::nullopt;
  char* rest = nullptr;
  const double value = std::strtod(node.scalar.c_str(), &rest);
  if (rest == node.scalar.c_str()) return std::nullopt;
  return scalar(fmt::format("{}{}", value * factor, rest));
}

/// Changes each entry of each list and map in turn, in every way; `judge` gets the whole tree each time.
void mutate(Node root, const std::function<void(const Node&, const std::string& what)>& judge) {
  std::vector<Node> others{Node{},        scalar("what"),       scalar("-1"),
                           scalar("0"),   scalar("1e308"),      scalar("1e-308"),
                           scalar("nan"), scalar("5 furlongs"), scalar("")};
  others.emplace_back().kind = Node::Kind::list;
  others.emplace_back().kind = Node::Kind::map;
  for_each_holder(root, [&](Node& holder) {
    const Node before = holder;
    const bool map = holder.kind == Node::Kind::map;
    const auto done = [&](const std::string& what, std::size_t k) {
      judge(root, fmt::format("{} {}", what, map ? before.keys[k].text : fmt::format("item {}", k)));
      holder = before;
    };
    for (std::size_t k = 0; k < before.items.size(); ++k) {
      const auto at = static_cast<std::ptrdiff_t>(k);
      holder.items.erase(holder.items.begin() + at);
      if (map) holder.keys.erase(holder.keys.begin() + at);
      done("without", k);
      holder.items.push_back(before.items[k]);
      if (map) holder.keys.push_back(before.keys[k]);
      done("twice", k);
      if (map) {
        holder.keys[k].text += "x";
        done("misspelt", k);
      }
      for (const Node& other : others) {
        holder.items[k] = other;
        done("replaced (" + to_yaml(other) + ")", k);
      }
      holder.items[k] = others[others.size() - 2];
      holder.items[k].items.push_back(before.items[k]);
      done("in a list", k);
      for (const double factor : {1e6, 1e-6, -1.0})
        if (const auto number = scaled(before.items[k], factor)) {
          holder.items[k] = *number;
          done(fmt::format("times {}:", factor), k);
        }
    }
  });
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The first two steps of a scene that was read. What they may end in: what is wrong with the bodies, or a
/// failure that is told.
void set_out(const Scene& scene) {
  if (estimated_particles(scene) > 2e5) return;
  const auto two_steps = [&]<int Dim>() {
    Step<Dim> step(scene);
    for (int k = 0; k < 2; ++k) {
      const double dt = step.stable_dt();
      CHECK(!(dt < 0));
      step.advance(std::min(dt, scene.time.end));
    }
  };
  try {
    if (scene.dimension() == 3)
      two_steps.operator()<3>();
    else
      two_steps.operator()<2>();
  } catch (const SceneError& error) {
    CHECK(std::string(error.what()).size() > 10);
  } catch (const RunFailure& failure) {
    CHECK(std::string(failure.what()).find("step ") == 0);
  }
}

struct Tally {
  std::size_t mutants = 0, judged = 0, read = 0, refused = 0;
};

/// One in `stride` of the mutants of a scene.
void judge_mutants(const fs::path& file, std::size_t stride, Tally& tally) {
  CAPTURE(file.string());
  Problems problems({file.string()});
  const auto root = parse_tree(text_of(file), 0, problems);
  REQUIRE(root);
  // What is written of the tree is the scene itself.
  REQUIRE(parse_scene(to_yaml(*root), file).resolved_yaml == read_scene(file).resolved_yaml);
  mutate(*root, [&](const Node& mutant, const std::string& what) {
    if (tally.mutants++ % stride != 0) return;
    ++tally.judged;
    CAPTURE(what);
    try {
      const Scene scene = parse_scene(to_yaml(mutant), file);
      if (tally.read++ % stride == 0) set_out(scene);
      try {
        CHECK(parse_scene(scene.resolved_yaml, file).resolved_yaml == scene.resolved_yaml);
      } catch (const SceneError& error) {
        FAIL_CHECK("as resolved it is refused: " << error.what());
      }
    } catch (const SceneError& error) {
      ++tally.refused;
      CHECK(!error.diagnostics().empty());
      for (const Diagnostic& diagnostic : error.diagnostics()) {
        CAPTURE(diagnostic.text());
        CHECK(diagnostic.line > 0);
        CHECK(diagnostic.column > 0);
        CHECK(diagnostic.message.size() > 5);
      }
    }
  });
}

Tally judge_all(std::size_t stride) {
  std::vector<fs::path> scenes;
  for (const char* folder : {"", "bench", "hard"}) {
    const fs::path path = test::source_folder() / "configs" / folder;
    if (!fs::exists(path)) continue;
    for (const auto& entry : fs::directory_iterator(path))
      if (entry.path().extension() == ".yaml") scenes.push_back(entry.path());
  }
  std::sort(scenes.begin(), scenes.end());
  REQUIRE(scenes.size() > 10);
  Tally tally;
  for (const fs::path& scene : scenes) judge_mutants(scene, stride, tally);
  MESSAGE(fmt::format("{} of {} mutants of {} scenes: {} read, {} refused", tally.judged, tally.mutants,
                      scenes.size(), tally.read, tally.refused));
  return tally;
}

TEST_CASE("a scene with one thing wrong is read, or refused with a place and a reason") {
  const Tally tally = judge_all(13);
  CHECK(tally.judged >= 2000);
  CHECK(tally.refused > tally.read / 2);
}

TEST_CASE("slow: every scene with one thing wrong is read, or refused with a place and a reason") {
  judge_all(1);
}

}  // namespace
}  // namespace mpmfast
