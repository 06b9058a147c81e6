#pragma once

/// @file Wall seconds by pass.

#include <array>
#include <chrono>
#include <string_view>

namespace mpmfast {

enum class Pass {
  sort,
  project,
  extension,
  surfaces,
  contact_nodes,
  contact_geometry,
  contact_resolve,
  strain_force,
  nodes,
  conditions,
  xpic,
  re_extrapolate,
  update,
  heat
};
inline constexpr std::array<std::string_view, 14> kPassNames{"sort",
                                                             "project",
                                                             "extension",
                                                             "surfaces",
                                                             "contact_nodes",
                                                             "contact_geometry",
                                                             "contact_resolve",
                                                             "strain_force",
                                                             "nodes",
                                                             "conditions",
                                                             "xpic",
                                                             "re_extrapolate",
                                                             "update",
                                                             "heat"};

class PassClock {
 public:
  /// Runs f and books its time on a pass.
  template <class F>
  decltype(auto) time(Pass pass, F f) {
    struct Booking {
      double& seconds;
      std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
      ~Booking() {
        seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      }
    } booking{seconds_[static_cast<std::size_t>(pass)]};
    return f();
  }
  const std::array<double, kPassNames.size()>& seconds() const { return seconds_; }
  std::array<double, kPassNames.size()>& seconds() { return seconds_; }

 private:
  std::array<double, kPassNames.size()> seconds_{};
};

}  // namespace mpmfast
