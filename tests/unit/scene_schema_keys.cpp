/// Which keys the schema lets stand together, and how it writes values.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <string>

#include "engine/scene/schema/schema_values.hpp"
#include "engine/scene/schema/write_schema.hpp"
#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

/// Does the schema allow a map of these keys? Values count only where they are words that it states.
bool allows(const Json& schema, const Json& map) {
  if (schema.is_boolean()) return schema.get<bool>();
  const auto holds = [&](const Json& one) { return allows(one, map); };
  const auto stated = [&](const char* key) { return schema.value(key, Json::array()); };
  for (const Json& key : stated("required"))
    if (!map.contains(key.get<std::string>())) return false;
  for (const auto& [key, value] : map.items()) {
    const bool known = schema.contains("properties") && schema["properties"].contains(key);
    const Json& own = known ? schema["properties"][key] : schema.value("additionalProperties", Json(true));
    if (own == Json(false) || (own.is_object() && own.contains("const") && own["const"] != value))
      return false;
  }
  const Json all = stated("allOf"), any = stated("anyOf"), one = stated("oneOf");
  if (!std::all_of(all.begin(), all.end(), holds)) return false;
  if (!any.empty() && std::none_of(any.begin(), any.end(), holds)) return false;
  if (!one.empty() && std::count_if(one.begin(), one.end(), holds) != 1) return false;
  if (schema.contains("not") && holds(schema["not"])) return false;
  if (!schema.contains("if")) return true;
  const char* branch = holds(schema["if"]) ? "then" : "else";
  return !schema.contains(branch) || holds(schema[branch]);
}

Json map_of(const std::vector<std::string>& keys) {
  Json out = Json::object();
  for (const std::string& key : keys) out[key] = 1;
  return out;
}

}  // namespace

TEST_CASE("the schema allows the moduli of a material that the reader takes, and no others") {
  const Json schema = Json::parse(write_schema());
  const Json& material = schema["properties"]["materials"]["additionalProperties"];
  constexpr std::array moduli{"bulk: 5 GPa", "shear: 3 GPa", "young: 1 GPa", "poisson: 0.3"};
  int taken = 0;
  for (unsigned chosen = 0; chosen < 1U << moduli.size(); ++chosen) {
    std::string text = "model: neo_hookean, density: 1 g/cm^3";
    Json map{{"model", "neo_hookean"}, {"density", 1}};
    for (std::size_t k = 0; k < moduli.size(); ++k) {
      if ((chosen >> k & 1U) == 0) continue;
      const std::string modulus = moduli[k];
      text += ", " + modulus;
      map[modulus.substr(0, modulus.find(':'))] = 1;
    }
    const bool good =
        faults(replaced(plain_scene(),
                        "model: linear_elastic, density: 7.85 g/cm^3, young: 210 GPa, poisson: 0.3", text))
            .empty();
    CAPTURE(text);
    CHECK(allows(material, map) == good);
    taken += good;
  }
  CHECK(taken == 2);  // both pairs
}

TEST_CASE("in the schema a bitmap may have material, materials or both, other shapes need material alone") {
  const Json schema = Json::parse(write_schema());
  const Json& body = schema["properties"]["bodies"]["items"];
  CHECK(allows(body, map_of({"bitmap", "extent", "material"})));
  CHECK(allows(body, map_of({"bitmap", "extent", "materials"})));
  CHECK(allows(body, map_of({"bitmap", "extent", "material", "materials"})));
  CHECK(allows(body, map_of({"box", "material"})));
  CHECK_FALSE(allows(body, map_of({"box", "material", "materials"})));
  CHECK_FALSE(allows(body, map_of({"box", "materials"})));
  CHECK_FALSE(allows(body, map_of({"box", "disk", "material"})));
  CHECK_FALSE(allows(body, map_of({"bitmap", "material"})));  // no extent
}

TEST_CASE("a number of a scene is a whole one in the schema where it can be, and as large as it was") {
  CHECK(json_of("-3").dump() == "-3");
  CHECK(json_of("0.5").dump() == "0.5");
  CHECK(json_of("1e300") == Json(1e300));
  CHECK(json_of("-1e300") == Json(-1e300));  // no whole number of the machine
  CHECK(json_of("[1, -1e300]") == Json::array({1, -1e300}));
}
