#include "engine/contact/geometry/normal_fit.hpp"

#include <algorithm>

#include "engine/contact/geometry/kept_fits.hpp"

namespace mpmfast {

template <int Dim>
void NormalFit<Dim>::run(const State<Dim>& state, const ContactSpec& spec, const ContactBasis<Dim>& basis,
                         ContactList<Dim>& list, std::vector<SurfaceSample<Dim>>* samples) {
  const FitChoice choice(spec);
  if (samples) samples->assign(list.pairs.size(), {});
  if (!choice.regress && !choice.separate) return;
  const DomainView<Dim> domains = state.domains();
  const bool keeps_fits = !list.pairs.fit.empty();
  for (FitWorkspace<Dim>& work : workspaces_) {
    work.candidates.extent = choice.separate ? std::optional(choice.extent) : std::nullopt;
    work.candidates.numbered = choice.separate && keeps_fits;
    work.tally = {};
    work.block = -1;
  }
  if (choice.smooth) raw_.resize(list.pairs.size()), kept_.resize(list.nodes.size());
  first_.resize(list.fields.size());
  const MeanNormals<Dim> mean(state, list, raw_, choice.all_pairs);
  find_due(list, spec.refit * state.grid.cell, state.threads, shares_, due_,
           [&](const ContactNode<Dim>& node) { reuse(state, choice, mean, node, list); });
  slabs_.cut(state, list, due_, choice.smooth);
  for (FitWorkspace<Dim>& work : workspaces_)
    work.clouds.resize(std::max(slabs_.at_once(), work.clouds.size()));
  const Run run{state, spec, basis, choice, mean, domains, samples};
  std::size_t surrounded = 0;  // slabs whose means are taken
  for (std::size_t s = 0; s < slabs_.size(); ++s) {
    fit_slab(run, s, list);
    for (; choice.smooth && surrounded <= s && slabs_.surrounded_by(surrounded) <= s; ++surrounded)
      take_means(run, surrounded, list);
  }
  count(list.counters);
}

template <int Dim>
std::size_t NormalFit<Dim>::bytes() const {
  std::size_t sum = bytes_in(raw_, kept_, due_, first_);
  const auto add = [&](const auto& columns) {
    for (const auto& column : columns) sum += bytes_in(column);
  };
  for (const FitWorkspace<Dim>& work : workspaces_) {
    const auto& near = work.candidates;
    sum += bytes_in(work.side, work.sums, near.pieces, near.number);
    add(near.position);
    add(near.reach);
    add(near.domain);
    add(near.shape);
    for (const CloudWorkspace<Dim>& cloud : work.clouds) {
      add(cloud.xi);
      add(cloud.shape);
      sum += bytes_in(cloud.number);
    }
  }
  return sum;
}

/// Normals and separations of the nodes of a slab. The clouds are kept where means are taken.
template <int Dim>
void NormalFit<Dim>::fit_slab(const Run& run, std::size_t slab, ContactList<Dim>& list) {
  const std::size_t at = slab % slabs_.at_once();
  for (FitWorkspace<Dim>& work : workspaces_) {
    work.clouds[at].shapes = work.candidates.shapes();
    work.clouds[at].numbered = work.candidates.numbered;
    work.clouds[at].begin = 0;
  }
  slabs_.for_each_node(slab, run.state, list, [&](std::size_t k, const ContactNode<Dim>& node) {
    if (!due_[k]) return;
    FitWorkspace<Dim>& work = own_workspace();
    CloudWorkspace<Dim>& clouds = work.clouds[at];
    if (work.block != node.block) find_candidates(run, list, k, work);
    collect(run, list, node, work.candidates, clouds);
    fit_node(run, node, clouds.columns(clouds.begin, clouds.count), work, list);
    if (!run.choice.smooth) return;
    kept_[k] = {thread_index(), clouds.count, clouds.begin};
    clouds.begin += static_cast<std::size_t>(padded_count(clouds.count));
  });
}

template <int Dim>
void NormalFit<Dim>::fit_node(const Run& run, const ContactNode<Dim>& node, const CloudColumns<Dim>& cloud,
                              FitWorkspace<Dim>& work, ContactList<Dim>& list) {
  const FitChoice& choice = run.choice;
  const FieldRanges fields = ranges(node, cloud.count);
  for (int e = node.pair_begin; e < node.pair_end; ++e) {
    const ContactPair& pair = list.pairs.pair[e];
    PairGeometry<Dim>& geometry = list.pairs.geometry[e];
    const bool fits = choice.regress && !geometry.prescribed;
    const bool fell_back =
        fits && fit_pair(choice, run.spec.warm_start, work.view(work.particles_of(cloud, fields, pair)),
                         geometry, work.tally);
    std::array<std::int32_t, 2> support{-1, -1};
    if (choice.separate)
      geometry.separation = run.state.grid.cell *
                            cloud_separation(choice.extent, cloud, fields, pair, geometry.normal, support);
    if (run.samples && !choice.smooth) sample(run, node, cloud, e, list);
    const bool overlaps = geometry.separation < 0;
    const bool touches = fits && (!choice.separate || overlaps || list.pairs.before[e].touched);
    const bool doubted = touches && fell_back;
    work.tally.touching += touches;
    if (choice.smooth)
      raw_[static_cast<std::size_t>(e)] = run.mean.raw(node, pair, geometry.normal, overlaps, doubted);
    else
      work.tally.doubtful += doubted;
    if (list.pairs.fit.empty()) continue;
    // The others of a lumped pair may be different ones in the next step.
    const bool known =
        fits && !pair.is_lumped() && (!choice.separate || (support[0] >= 0 && support[1] >= 0));
    list.pairs.fit[e] = {geometry.normal, geometry.normal, support, 0, known, overlaps, doubted};
  }
}

/// The kept normals, and the separations by their support particles.
template <int Dim>
void NormalFit<Dim>::reuse(const State<Dim>& state, const FitChoice& choice, const MeanNormals<Dim>& mean,
                           const ContactNode<Dim>& node, ContactList<Dim>& list) {
  for (int e = node.pair_begin; e < node.pair_end; ++e) {
    const ContactPair& pair = list.pairs.pair[e];
    PairGeometry<Dim>& geometry = list.pairs.geometry[e];
    const KeptFit<Dim>& fit = list.pairs.fit[e];
    if (pair.crack < 0) geometry.normal = fit.normal;
    if (choice.separate && pair.crack < 0)
      with_extent(choice.extent, [&]<Extent E>() {
        geometry.separation = state.grid.cell * kept_separation<E>(state, node.index, fit);
      });
    if (choice.smooth)
      raw_[static_cast<std::size_t>(e)] = mean.raw(node, pair, fit.raw, geometry.separation < 0, fit.doubted);
  }
}

/// Lists the particles near those contact nodes of a block that are due. @param first  its first contact node
template <int Dim>
void NormalFit<Dim>::find_candidates(const Run& run, const ContactList<Dim>& list, std::size_t first,
                                     FitWorkspace<Dim>& work) const {
  const Tiling<Dim>& tiling = run.state.tiling;
  work.block = list.nodes[first].block;
  NodeBox<Dim> box{list.nodes[first].index, list.nodes[first].index};
  for (std::size_t k = first; k < list.nodes.size() && list.nodes[k].block == work.block; ++k)
    for (int d = 0; due_[k] && d < Dim; ++d) {
      box.low[d] = std::min(box.low[d], list.nodes[k].index[d]);
      box.high[d] = std::max(box.high[d], list.nodes[k].index[d]);
    }
  work.candidates.clear();
  const auto& block = tiling.node_blocks[static_cast<std::size_t>(work.block)];
  for (int n = block.begin; n < block.end; ++n) {
    const auto& node_tile = tiling.node_tiles[static_cast<std::size_t>(n)];
    for (int t : node_tile.particle_tile) {
      if (t < 0) continue;
      const auto tile = tiling.tiles.begin() + t;
      if (tile->field != node_tile.field) continue;  // sides of a crack share tiles: each tile once
      for (auto part = tile; part <= tile + tile->others; ++part) {
        const TileContext<Dim, DomainView<Dim>> context{&run.domains, &*part, tiling.runs.data(),
                                                        run.state.bodies.data(), &run.state.grid};
        run.basis.add_candidates(context, box, work.candidates);
      }
    }
  }
}

/// The cloud of a node, field after field. Both sides of a crack have all particles of their body.
template <int Dim>
void NormalFit<Dim>::collect(const Run& run, const ContactList<Dim>& list, const ContactNode<Dim>& node,
                             const Candidates<Dim>& candidates, CloudWorkspace<Dim>& clouds) {
  clouds.count = 0;
  auto piece = candidates.pieces.begin();
  const auto end = candidates.pieces.end();
  int before = -1;
  for (int f = node.field_begin; f < node.field_end; ++f) {
    const int field = run.state.field_base[static_cast<std::size_t>(list.fields[f].field)];
    if (field <= before) piece = candidates.pieces.begin();
    before = field;
    while (piece != end && piece->field < field) ++piece;
    first_[static_cast<std::size_t>(f)] = clouds.count;
    for (; piece != end && piece->field == field; ++piece)
      run.basis.append_covering(candidates, *piece, run.state.grid.inverse_cell, node.index, clouds);
  }
  clouds.pad();
}

/// The mean normals of the nodes of a slab, and the separations along them.
template <int Dim>
void NormalFit<Dim>::take_means(const Run& run, std::size_t slab, ContactList<Dim>& list) {
  const std::size_t at = slab % slabs_.at_once();
  slabs_.for_each_node(slab, run.state, list, [&](std::size_t k, const ContactNode<Dim>& node) {
    if (!due_[k]) return;
    FitWorkspace<Dim>& work = own_workspace();
    const KeptCloud& kept = kept_[k];
    const auto cloud =
        workspaces_[static_cast<std::size_t>(kept.thread)].clouds[at].columns(kept.begin, kept.count);
    run.mean(run.mean.around(node), node, work.sums);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      PairGeometry<Dim>& geometry = list.pairs.geometry[e];
      const Vec<Dim>& sum = work.sums[static_cast<std::size_t>(e - node.pair_begin)];
      const RawNormal<Dim>& raw = raw_[static_cast<std::size_t>(e)];
      work.tally.doubtful += raw.doubted && !is_confirmed(raw, sum);
      const double length = sum.norm();
      if (length > 0 && !geometry.prescribed) geometry.normal = sum / length;
      KeptFit<Dim> none, &fit = list.pairs.fit.empty() ? none : list.pairs.fit[e];
      fit.normal = geometry.normal;
      if (run.choice.separate)
        geometry.separation =
            run.state.grid.cell * cloud_separation(run.choice.extent, cloud, ranges(node, cloud.count),
                                                   list.pairs.pair[e], geometry.normal, fit.support);
      if (run.samples) sample(run, node, cloud, e, list);
    }
  });
}

/// The points of a pair's surface that belong to its node.
template <int Dim>
void NormalFit<Dim>::sample(const Run& run, const ContactNode<Dim>& node, const CloudColumns<Dim>& cloud,
                            int e, const ContactList<Dim>& list) const {
  const ContactPair& pair = list.pairs.pair[e];
  const FieldRanges fields = ranges(node, cloud.count);
  const SampledPair<Dim> sampled{cloud,
                                 fields(pair.a),
                                 fields(pair.b),
                                 meets_rigid(node, pair),
                                 list.pairs.geometry[e].normal,
                                 run.state.grid.cell};
  with_extent(run.choice.extent,
              [&]<Extent E>() { (*run.samples)[static_cast<std::size_t>(e)] = sample_surface<E>(sampled); });
}

template <int Dim>
void NormalFit<Dim>::count(ContactCounters& counters) const {
  for (const FitWorkspace<Dim>& work : workspaces_) {
    const FitTally& t = work.tally;
    counters.regressions += t.regressions;
    counters.iterations += t.iterations;
    counters.fallbacks += t.fallbacks;
    counters.unconverged += t.unconverged;
    counters.touching += t.touching;
    counters.doubtful += t.doubtful;
  }
}

template class NormalFit<2>;
template class NormalFit<3>;

}  // namespace mpmfast
