#include <doctest/doctest.h>

#include "tools/study/gnuplot.hpp"
#include "tools/study/usual_charts.hpp"

#include <set>

using namespace mpmfast;
using Names = std::vector<std::string>;

TEST_CASE("a chart of stresses has no rigid body, nor all bodies where one alone deforms") {
  Table history{{"time_s", "block.mean_stress_xx_Pa", "block.mean_stress_yy_Pa", "floor.mean_stress_xx_Pa",
                 "floor.mean_stress_yy_Pa", "all.mean_stress_xx_Pa", "all.mean_stress_yy_Pa"},
                {{0, 1}, {0, 5}, {0, -7}, {0, 0}, {0, 0}, {0, 5}, {0, -7}}};
  const Names block{"block.mean_stress_xx_Pa", "block.mean_stress_yy_Pa"};
  CHECK(telling_columns(history, ".mean_stress_") == block);
  history.columns[6][1] = -6;  // another body is among all of them
  CHECK(telling_columns(history, ".mean_stress_").size() == 4);
  for (std::size_t k = 1; k < 7; ++k) history.columns[k][1] = 0;
  CHECK(telling_columns(history, ".mean_stress_").size() == 6);  // all at rest
  CHECK(telling_columns(history, ".force_").empty());
}

TEST_CASE("of more curves than can be told apart, those of all bodies are left") {
  Table history;
  for (int body = 0; body < 30; ++body)
    history.names.push_back("b" + std::to_string(body) + ".mean_stress_xx_Pa");
  history.names.push_back("all.mean_stress_xx_Pa");
  history.columns.assign(31, {1, 2});
  CHECK(telling_columns(history, ".mean_stress_") == Names{"all.mean_stress_xx_Pa"});
}

TEST_CASE("the momentum of bodies that meet head on is zero, not round-off") {
  Table history{
      {"momentum_x", "momentum_y", "momentum_z", "a.mass_kg", "a.vx", "a.vy", "b.mass_kg", "b.vx", "b.vy"},
      {{4e-15, -3e-15}, {0, 2e-3}, {0, 0}, {2, 2}, {5, 5}, {0, 0}, {2, 2}, {-5, -5}, {0, 0}}};
  clear_round_off(history);
  CHECK(history.columns[0] == std::vector<double>{0, 0});
  CHECK(history.columns[1] == std::vector<double>{0, 2e-3});
  CHECK(telling_columns(history, "momentum_") == Names{"momentum_y"});
  history.columns[1] = {0, 0};
  CHECK(telling_columns(history, "momentum_") == Names{"momentum_x", "momentum_y"});  // of two dimensions
}

TEST_CASE("no two of many curves look the same") {
  std::set<std::string> styles;
  for (std::size_t k = 0; k < 60; ++k) styles.insert(chart_line(k));
  CHECK(styles.size() == 60);
  CHECK(chart_line(0).find("dt") == std::string::npos);
}
