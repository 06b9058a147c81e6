#include "frame_constants.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "pack.hpp"

namespace mpmfast {

namespace {

/// The undeformed sides of the domains of a file's particles, from their volumes, F and how they were seeded.
class Sides {
 public:
  Sides(const FrameFile& file, const std::optional<Scene>& scene, int dimension)
      : scene_(scene),
        dimension_(dimension),
        points_(file.reader().points()),
        volume_(FrameField{"", "", "volume", 0, FrameField::Kind::component}.values(file)),
        ratio_(FrameField{"", "", "deformation_gradient", 0, FrameField::Kind::determinant}.values(file)),
        across_(FrameField{"", "", "deformation_gradient", 8, FrameField::Kind::component}.values(file)) {
    for (std::size_t d = 0; d < 3; ++d)
      share_[d] = FrameField{"", "", "domain_share", d, FrameField::Kind::component}.values(file);
  }

  std::array<double, 2> of(std::size_t i, std::size_t body) const {
    double size = std::isfinite(ratio_[i]) && ratio_[i] > 0 ? volume_[i] / ratio_[i] : volume_[i];
    if (!(size > 0)) return {0, 0};
    for (const std::vector<double>& share : share_)
      if (std::isfinite(share[i])) size /= share[i];  // of what was split, the domain that it was part of
    if (dimension_ == 3) return {std::cbrt(size), 0};
    size /= scene_ ? scene_->thickness : 1;
    // Of a ring, the square that is turned about the axis.
    if (scene_ && scene_->space == Space::axisymmetric)
      size *= across_[i] / (2 * std::numbers::pi * points_[3 * i]);
    double aspect = 1;
    if (scene_ && body < scene_->bodies.size()) {
      const auto& per_cell = scene_->bodies[body].particles_per_cell;
      aspect = static_cast<double>(per_cell[1]) / per_cell[0];
    }
    return {std::sqrt(size * aspect), std::sqrt(size / aspect)};
  }

 private:
  const std::optional<Scene>& scene_;
  int dimension_;
  std::vector<double> points_, volume_, ratio_, across_;
  std::array<std::vector<double>, 3> share_;
};

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

}  // namespace

void note_constants(const FrameFile& file, const PointOrder& point_order, const std::optional<Scene>& scene,
                    int dimension, FrameConstants& constants) {
  const Sides sides(file, scene, dimension);
  const auto body = file.reader().read<std::uint16_t>("body"),
             material = file.reader().read<std::uint16_t>("material");
  for (std::size_t k = 0; k < point_order.in_file.size(); ++k) {
    const std::size_t i = point_order.in_file[k], p = point_order.in_page[k];
    if (constants.known[p]) continue;
    constants.known[p] = true;
    constants.body[p] = body[i];
    constants.material[p] = material[i];
    const auto [x, y] = sides.of(i, body[i]);
    constants.side_x[p] = static_cast<float>(x);
    constants.side_y[p] = static_cast<float>(y);
  }
}

std::vector<std::pair<std::string, std::string>> packed_constants(const FrameConstants& constants,
                                                                  const std::vector<std::uint32_t>& ids) {
  std::vector<std::pair<std::string, std::string>> out{{"body", deflated(bytes_of(constants.body))},
                                                       {"material", deflated(bytes_of(constants.material))},
                                                       {"side_x", deflated(bytes_of(constants.side_x))},
                                                       {"side_y", deflated(bytes_of(constants.side_y))}};
  if (!ids.empty() && ids.back() + 1 != ids.size()) out.emplace_back("ids", deflated(bytes_of(ids)));
  return out;
}

}  // namespace mpmfast
