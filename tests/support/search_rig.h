#pragma once
// Every search side by side on one tree, each with its own state: after each query
// all must hold the exhaustive search's cut and weights, to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "runtime/frame/weigh_cut.h"
#include "runtime/select/cut.h"
#include "runtime/select/partitioned.h"
#include "tests/support/random_trees.h"
#include "tests/support/rounded_tree.h"

namespace voyager::test {

inline constexpr float kInfinity = INFINITY;

inline std::vector<float> weights_of(const LodTree& tree, const ExhaustiveSearch& search,
                                     float target_size) {
  const WeightParams params{tree.records.data(), tree.parent.data(), search.sizes().data(),
                            target_size, tree.blend_share};
  std::vector<float> t;
  for (const uint32_t node : search.cut()) t.push_back(weigh(params, node).t);
  return t;
}

class SearchRig {
 public:
  explicit SearchRig(LodTree sound_tree, uint32_t chunk_bytes = kDefaultChunkBytes,
                     unsigned threads = 2)
      : workers(threads),
        tree(rounded(std::move(sound_tree))),
        partition(partition_tree(tree, chunk_bytes)),
        search_tree(make_search_tree(tree, partition, {}, workers)) {}

  // Runs all; false where one differs, and the test has failed.
  bool agree(const CutQuery& query) {
    oracle.run(tree, {}, query, workers);
    const std::vector<float> weights = weights_of(tree, oracle, query.target_size);
    const std::vector<uint32_t> last_cut = std::move(last_cut_);
    last_cut_.assign(oracle.cut().begin(), oracle.cut().end());
    return matches(streaming, Search::streaming, query, weights, last_cut) &&
           matches(temporal, Search::temporal, query, weights, last_cut) &&
           matches(temporal_visit, Search::temporal_visit, query, weights, last_cut);
  }

  Workers workers;
  const LodTree tree;
  const Partition partition;
  const SearchTree search_tree;
  ExhaustiveSearch oracle;
  PartitionedSearch streaming{search_tree}, temporal{search_tree}, temporal_visit{search_tree};

 private:
  bool matches(PartitionedSearch& search, Search kind, const CutQuery& query,
               const std::vector<float>& weights, const std::vector<uint32_t>& last_cut) {
    search.run(query, kind, workers);
    const auto& cut = search.cut();
    const char* names[] = {"exhaustive", "streaming", "temporal", "temporal_visit"};
    const char* name = names[static_cast<size_t>(kind)];
    if (!std::equal(cut.begin(), cut.end(), last_cut_.begin(), last_cut_.end())) {
      ADD_FAILURE() << name << ": another cut than the exhaustive search's: " << cut.size()
                    << " nodes, expected " << last_cut_.size() << ", τ* = " << query.target_size;
      return false;
    }
    return same_weights(search, name, query, weights) && counts_changes(search, name, last_cut);
  }

  bool same_weights(const PartitionedSearch& search, const char* name, const CutQuery& query,
                    const std::vector<float>& weights) {
    items_.resize(search.cut().size());
    weigh_cut(links_of(tree), search_tree, search, query, items_, workers);
    for (size_t i = 0; i < items_.size(); ++i) {
      const DrawItem& item = items_[i];
      const bool whole = item.t == 1.0f;
      const uint32_t parent = whole ? kNoNode : tree.parent[item.gaussian];
      if (item.gaussian == last_cut_[i] && item.parent == parent &&
          std::bit_cast<uint32_t>(item.t) == std::bit_cast<uint32_t>(weights[i]) &&
          item.inverse_k ==
              (whole ? 1.0f : 1.0f / static_cast<float>(tree.records[parent].child_count)))
        continue;
      ADD_FAILURE() << name << ": another weight of node " << last_cut_[i] << ": " << item.t
                    << ", expected " << weights[i] << ", τ* = " << query.target_size;
      return false;
    }
    return true;
  }

  static bool counts_changes(const PartitionedSearch& search, const char* name,
                             const std::vector<uint32_t>& last_cut) {
    std::vector<uint32_t> both;
    const auto& cut = search.cut();
    std::set_intersection(cut.begin(), cut.end(), last_cut.begin(), last_cut.end(),
                          std::back_inserter(both));
    if (search.stats().entered == cut.size() - both.size() &&
        search.stats().left == last_cut.size() - both.size())
      return true;
    ADD_FAILURE() << name << ": counts " << search.stats().entered << " nodes that entered and "
                  << search.stats().left << " that left, expected " << cut.size() - both.size()
                  << " and " << last_cut.size() - both.size();
    return false;
  }

  std::vector<uint32_t> last_cut_;
  std::vector<DrawItem> items_;
};

// Places where a predicate is on edge: on faces, an ulp beside them, 1e-24 m outside,
// inside, and far away.
inline std::vector<Vec3f> edge_centres(const LodTree& tree, std::mt19937& random, size_t nodes) {
  std::vector<Vec3f> centres = {{0, 0, 0}, {0, 0, -50}, {1e17f, 1e17f, -1e17f}, {-9.9e17f, 0, 0}};
  for (size_t i = 0; i < nodes; ++i) {
    const NodeRecord& r = tree.records[random() % tree.size()];
    const Vec3f middle = 0.5f * (r.box_min + r.box_max);
    centres.push_back(middle);
    centres.push_back({r.box_min.x, middle.y, middle.z});
    centres.push_back({middle.x, middle.y, std::nextafter(r.box_max.z, 1e30f)});
    centres.push_back({middle.x, std::nextafter(r.box_min.y, -1e30f), r.box_min.z});
    centres.push_back({r.box_max.x, middle.y, r.box_max.z + 1e-24f});
    centres.push_back(2.0f * r.box_max - middle);
  }
  return centres;
}

// A node's own size at a place, where it is of use as a τ*: < and ≥ part exactly there.
inline float edge_target(const LodTree& tree, const Vec3f& c, std::mt19937& random) {
  const float size = tree.screen_size(static_cast<uint32_t>(random() % tree.size()), c);
  return size > 0.0f ? size : 0.1f;
}

}  // namespace voyager::test
