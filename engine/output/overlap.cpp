#include "engine/output/overlap.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>

#include "engine/output/first_overlaps.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {
namespace {

/// A polygon with space for a parallelogram cut by four lines: 8 corners, or 19 (a half more with each cut)
/// should rounding make a sliver cross a line again and again.
struct Polygon {
  std::array<Vec<2>, 20> corner;
  std::size_t count = 0;
  void add(const Vec<2>& x) { corner[count++] = x; }
};

/// What of the polygon lies at sign · u_axis ≤ 1.
Polygon cut(const Polygon& polygon, int axis, double sign) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.count; ++k) {
    const Vec<2>&a = polygon.corner[k], &b = polygon.corner[(k + 1) % polygon.count];
    const double beyond_a = sign * a[axis] - 1, beyond_b = sign * b[axis] - 1;
    if (beyond_a <= 0) kept.add(a);
    if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0))
      kept.add(a + (beyond_a / (beyond_a - beyond_b)) * (b - a));
  }
  return kept;
}

double area_of(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t k = 2; k < polygon.count; ++k) {
    const Vec<2> a = polygon.corner[k - 1] - polygon.corner[0], b = polygon.corner[k] - polygon.corner[0];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * std::abs(twice);
}

/// Sides included, with a little for round-off, so that no place falls between two domains of one body.
bool holds(const ParticleDomain& q, const Vec<2>& x) {
  if (q.edges.determinant() == 0) return false;
  return (q.edges.inverse() * (x - q.centre)).cwiseAbs().maxCoeff() <= 1 + 1e-9;
}

struct Box {
  static constexpr double kFar = std::numeric_limits<double>::max();
  Vec<2> lower = Vec<2>::Constant(kFar), upper = -lower;

  void include(const Box& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
  bool meets(const Box& other) const {
    return (lower.array() <= other.upper.array()).all() && (other.lower.array() <= upper.array()).all();
  }
  bool finite() const { return lower.allFinite() && upper.allFinite(); }
};

Box box_of(const ParticleDomain& domain) {
  const Vec<2> reach = domain.edges.cwiseAbs().rowwise().sum();
  return {domain.centre - reach, domain.centre + reach};
}

/// Which domains can meet one of another owner: those in the box around another owner's. Of many owners
/// hardly a domain lies in no other box, and each is taken. A failing run may ask too: what is no number is
/// nowhere.
class OwnerBoxes {
 public:
  void include(const ParticleDomain& domain) {
    const Box box = box_of(domain);
    if (box.finite() && around_.size() <= kMany) around_[domain.owner].include(box);
  }
  /// @param domain  one of those that were included
  bool may_meet(const ParticleDomain& domain) const {
    const Box box = box_of(domain);
    if (around_.size() > kMany) return box.finite();
    return box.finite() && std::any_of(around_.begin(), around_.end(), [&](const auto& other) {
             return other.first != domain.owner && other.second.meets(box);
           });
  }

 private:
  static constexpr std::size_t kMany = 32;
  std::map<int, Box> around_;
};

using BinIndex = std::array<std::uint32_t, 2>;

/// Square bins over the plane. A domain is listed, in order, in each bin that its bounding box touches; two
/// domains are compared in the lowest bin that both boxes touch, so once.
class Bins {
 public:
  explicit Bins(const std::vector<ParticleDomain>& domains);

  std::size_t count() const { return start_.size() - 1; }
  std::span<const std::uint32_t> listed(std::size_t bin) const {
    return {list_.data() + start_[bin], start_[bin + 1] - start_[bin]};
  }
  std::size_t of(const Vec<2>& x) const { return flat(at(x)); }
  std::size_t first_common(std::uint32_t p, std::uint32_t q) const {
    return flat({std::max(first_[p][0], first_[q][0]), std::max(first_[p][1], first_[q][1])});
  }

 private:
  BinIndex at(const Vec<2>& x) const {
    BinIndex bin;
    for (int k = 0; k < 2; ++k)
      bin[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>((x[k] - origin_[k]) / width_);
    return bin;
  }
  std::size_t flat(const BinIndex& bin) const { return std::size_t{bin[1]} * columns_ + bin[0]; }
  std::size_t lay_out(const std::vector<ParticleDomain>& domains);
  template <class Visit>
  void for_each_bin(const std::vector<ParticleDomain>& domains, std::size_t p, Visit visit) const {
    const BinIndex last = at(box_of(domains[p]).upper);
    for (std::uint32_t y = first_[p][1]; y <= last[1]; ++y)
      for (std::uint32_t x = first_[p][0]; x <= last[0]; ++x) visit(flat({x, y}));
  }

  Vec<2> origin_ = Vec<2>::Zero();
  double width_ = 1;
  std::size_t columns_ = 1;
  std::vector<BinIndex> first_;
  std::vector<std::size_t> start_;  ///< of each bin in list_, and the end
  std::vector<std::uint32_t> list_;
};

/// Bins as wide as the mean box, or wider so that there are about as many as domains. Returns their number.
std::size_t Bins::lay_out(const std::vector<ParticleDomain>& domains) {
  Box all;
  double extents = 0, n = 0;
  for (const ParticleDomain& domain : domains) {
    const Box box = box_of(domain);
    all.include(box);
    extents += (box.upper - box.lower).maxCoeff();
    ++n;
  }
  if (n == 0) return 1;
  origin_ = all.lower;
  const Vec<2> size = all.upper - all.lower;
  width_ = std::max({extents / n, std::sqrt(size[0] / n * size[1]), size.maxCoeff() / n});
  if (!(width_ > 0)) width_ = 1;
  const BinIndex last = at(all.upper);
  columns_ = last[0] + 1;
  return columns_ * (std::size_t{last[1]} + 1);
}

/// While the list is filled, start_[bin + 1] is where the next of a bin goes: in the end, where that ends.
Bins::Bins(const std::vector<ParticleDomain>& domains) : first_(domains.size()) {
  start_.assign(lay_out(domains) + 2, 0);
  for (std::size_t p = 0; p < domains.size(); ++p) {
    first_[p] = at(box_of(domains[p]).lower);
    for_each_bin(domains, p, [&](std::size_t bin) { ++start_[bin + 2]; });
  }
  for (std::size_t bin = 1; bin < start_.size(); ++bin) start_[bin] += start_[bin - 1];
  list_.resize(start_.back());
  for (std::size_t p = 0; p < domains.size(); ++p)
    for_each_bin(domains, p,
                 [&](std::size_t bin) { list_[start_[bin + 1]++] = static_cast<std::uint32_t>(p); });
  start_.pop_back();
}

/// The share of one bin: the pairs that it compares, and the particles whose centre it holds.
/// @param goes_on  of such a particle that lies in another's domain, the two owners; false: enough
template <class GoesOn>
Overlap overlap_in(const std::vector<ParticleDomain>& domains, const Bins& bins, std::size_t bin,
                   const GoesOn& goes_on) {
  Overlap sum;
  const auto listed = bins.listed(bin);
  for (std::size_t i = 0; i < listed.size(); ++i) {
    const ParticleDomain& p = domains[listed[i]];
    for (std::size_t j = i + 1; j < listed.size(); ++j)
      if (domains[listed[j]].owner != p.owner && bins.first_common(listed[i], listed[j]) == bin)
        sum.area += common_area(p, domains[listed[j]]);
    if (bins.of(p.centre) != bin) continue;
    const auto other = std::find_if(listed.begin(), listed.end(), [&](std::uint32_t q) {
      return domains[q].owner != p.owner && holds(domains[q], p.centre);
    });
    if (other == listed.end()) continue;
    sum.inside += p.area();
    ++sum.particles_inside;
    sum.owners = {p.owner, domains[*other].owner};
    if (!goes_on(sum.owners)) break;
  }
  return sum;
}

void add(Overlap& sum, const Overlap& part) {
  sum.area += part.area;
  sum.inside += part.inside;
  sum.particles_inside += part.particles_inside;
  if (part.particles_inside > 0) sum.owners = part.owners;
}

/// Of domains that may meet. Few bins at a time: what each has is added up in their order.
Overlap overlap_of(const std::vector<ParticleDomain>& domains, int threads) {
  constexpr std::size_t kBins = std::size_t{1} << 16;
  const Bins bins(domains);
  std::vector<Overlap> of_bin(std::min(kBins, bins.count()));
  Overlap sum;
  for (std::size_t begin = 0; begin < bins.count(); begin += kBins) {
    const std::size_t end = std::min(begin + kBins, bins.count());
    share_out(static_cast<std::int64_t>(end - begin), threads, 64, [&](std::int64_t k) {
      const auto at = static_cast<std::size_t>(k);
      of_bin[at] = overlap_in(domains, bins, begin + at, [](const auto&) { return true; });
    });
    for (std::size_t k = 0; k < end - begin; ++k) add(sum, of_bin[k]);
  }
  return sum;
}

using Owners = std::set<std::pair<int, int>>;

/// As overlap_of, up to so many pairs of owners: no bin looks on when it knows them, and more and more bins
/// are looked at together. What lies at one place by the thousand is not compared with all the others.
FirstOverlaps first_of(const std::vector<ParticleDomain>& domains, std::size_t most, int threads) {
  constexpr std::size_t kFewest = 1, kMost = std::size_t{1} << 16;  // bins at a time
  const Bins bins(domains);
  std::vector<Overlap> of_bin;
  std::vector<Owners> owners_in;
  Owners owners;
  FirstOverlaps found;
  for (std::size_t begin = 0, size = kFewest; begin < bins.count() && owners.size() <= most;
       size = std::min(2 * size, kMost)) {
    const std::size_t count = std::min(size, bins.count() - begin);
    of_bin.resize(count);
    owners_in.assign(count, {});
    share_out(static_cast<std::int64_t>(count), threads, 64, [&](std::int64_t k) {
      const auto at = static_cast<std::size_t>(k);
      of_bin[at] = overlap_in(domains, bins, begin + at, [&](const std::pair<int, int>& pair) {
        owners_in[at].insert(std::minmax(pair.first, pair.second));
        return owners_in[at].size() <= most;
      });
    });
    for (std::size_t k = 0; k < count; ++k) {
      add(found.overlap, of_bin[k]);
      owners.merge(owners_in[k]);
    }
    begin += count;
  }
  found.all = owners.size() <= most;
  return found;
}

/// f(domain) of all particles, as particle_domains() lists them.
template <class F>
void for_each_domain(const Particles<2>& particles, const std::vector<BodyView<2>>& bodies,
                     const std::vector<int>& owner, const Surfaces<2>& surfaces, const F& f) {
  for (const std::uint32_t p : order_by_id(particles)) {
    const std::size_t body = particles.body()[p];
    if (surfaces.holds(static_cast<int>(body), particles.id()[p])) continue;
    Mat<2> edges = particles.has(Quantity::deformation_gradient) ? particles.deformation_gradient(p)
                                                                 : Mat<2>(Mat<2>::Identity());
    for (int k = 0; k < 2; ++k) edges.col(k) *= bodies[body].half_size[k] * particles.domain_share(p, k);
    f(ParticleDomain{particles.vector(Quantity::position, p), edges, owner[body]});
  }
}

}  // namespace

double ParticleDomain::area() const { return 4 * std::abs(edges.determinant()); }

/// Cuts p by the four sides of q, in coordinates u in which q is the square |u_k| ≤ 1.
double common_area(const ParticleDomain& p, const ParticleDomain& q) {
  const double scale = std::abs(q.edges.determinant());
  if (!(scale > 0)) return 0;
  const Mat<2> inverse = q.edges.inverse(), edges = inverse * p.edges;
  const Vec<2> centre = inverse * (p.centre - q.centre);
  Polygon polygon;
  constexpr std::array<std::array<int, 2>, 4> kSigns{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (const auto& [first, second] : kSigns)
    polygon.add(centre + first * edges.col(0) + second * edges.col(1));
  for (int axis = 0; axis < 2; ++axis)
    for (const double sign : {-1.0, 1.0}) polygon = cut(polygon, axis, sign);
  return scale * area_of(polygon);
}

Overlap measure_overlap(const std::vector<ParticleDomain>& domains, int threads) {
  OwnerBoxes boxes;
  for (const ParticleDomain& domain : domains) boxes.include(domain);
  std::vector<ParticleDomain> meeting;
  for (const ParticleDomain& domain : domains)
    if (boxes.may_meet(domain)) meeting.push_back(domain);
  return overlap_of(meeting, threads);
}

namespace {

/// Only what may meet is listed: a list of all domains is two thirds as large as the particles themselves.
std::vector<ParticleDomain> meeting_domains(const Particles<2>& particles,
                                            const std::vector<BodyView<2>>& bodies,
                                            const std::vector<int>& owner, const Surfaces<2>& surfaces) {
  const auto each = [&](const auto& f) { for_each_domain(particles, bodies, owner, surfaces, f); };
  OwnerBoxes boxes;
  std::size_t count = 0;
  each([&](const ParticleDomain& domain) { boxes.include(domain); });
  each([&](const ParticleDomain& domain) { count += boxes.may_meet(domain); });
  std::vector<ParticleDomain> meeting;
  meeting.reserve(count);
  each([&](const ParticleDomain& domain) {
    if (boxes.may_meet(domain)) meeting.push_back(domain);
  });
  return meeting;
}

}  // namespace

Overlap measure_overlap(const Particles<2>& particles, const std::vector<BodyView<2>>& bodies,
                        const std::vector<int>& owner, const Surfaces<2>& surfaces, int threads) {
  return overlap_of(meeting_domains(particles, bodies, owner, surfaces), threads);
}

FirstOverlaps first_overlaps(const Particles<2>& particles, const std::vector<BodyView<2>>& bodies,
                             const std::vector<int>& owner, const Surfaces<2>& surfaces, std::size_t most,
                             int threads) {
  return first_of(meeting_domains(particles, bodies, owner, surfaces), most, threads);
}

double area_of_domains(const Particles<2>& particles, const std::vector<BodyView<2>>& bodies,
                       const Surfaces<2>& surfaces) {
  double sum = 0;
  for_each_domain(particles, bodies, std::vector<int>(bodies.size()), surfaces,
                  [&](const ParticleDomain& domain) { sum += domain.area(); });
  return sum;
}

/// Domains follow F alone: those of a rigid body that turns keep their directions.
std::vector<ParticleDomain> particle_domains(const Particles<2>& particles,
                                             const std::vector<BodyView<2>>& bodies,
                                             const std::vector<int>& owner, const Surfaces<2>& surfaces) {
  std::vector<ParticleDomain> domains;
  domains.reserve(particles.size());
  for_each_domain(particles, bodies, owner, surfaces,
                  [&](const ParticleDomain& domain) { domains.push_back(domain); });
  return domains;
}

}  // namespace mpmfast
