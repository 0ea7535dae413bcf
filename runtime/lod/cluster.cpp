#include "runtime/lod/cluster.h"

#include <algorithm>
#include <cmath>

#include "runtime/lod/exposure.h"
#include "runtime/lod/stand_in.h"

namespace voyager {
namespace {

constexpr size_t kNeighbours = 8;
// Of the pairs that a round finds, the better half are made: what is left finds better partners
// among the new. Few nodes are paired at once.
constexpr size_t kFewNodes = 16;

struct Cluster {
  Blob blob;
  Exposure exposure;
  double pixel;  // from which on it stands in for its children
  uint32_t child[2];
};

struct Pair {
  double pixel;
  uint32_t first, second;  // first < second

  bool operator<(const Pair& other) const {
    if (pixel != other.pixel) return pixel < other.pixel;
    return first != other.first ? first < other.first : second < other.second;
  }
};

class Clustering {
 public:
  Clustering(const GaussianCloud& cloud, const std::array<double, 3>& origin,
             std::span<const uint32_t> leaves, std::span<const ExposureCode> exposure,
             int footprint_level)
      : leaves_(leaves.size()),
        coefficients_(cloud.coefficients()),
        footprint_(footprint_at(cloud.native.footprint(), footprint_level)),
        low_pass_(cloud.native.low_pass) {
    const size_t floats = size_t{3} * static_cast<size_t>(coefficients_);
    clusters_.reserve(2 * leaves_);
    colours_.resize(2 * leaves_ * floats);
    for (size_t i = 0; i < leaves_; ++i) {
      GaussianWords words = cloud.words(leaves[i]);
      words.mean = local_mean(cloud, leaves[i], origin);
      const Gaussian g = activate(words, true);
      Exposure shown = exposure_of(exposure[leaves[i]]);
      shown.weight = shown_weight(g, shown, footprint_);
      clusters_.push_back({blob_of(g), shown, 0, {0, 0}});
      std::copy_n(&cloud.sh[leaves[i] * floats], floats, colour(i));
      active_.push_back(static_cast<uint32_t>(i));
    }
  }

  std::vector<Cluster> run() {
    while (active_.size() > 1) {
      find_pairs();
      join_pairs();
    }
    return std::move(clusters_);
  }

 private:
  static bool is_before(const Pair& a, const Pair& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  }

  float* colour(size_t cluster) {
    return &colours_[cluster * size_t{3} * static_cast<size_t>(coefficients_)];
  }

  double share_of(uint32_t first, uint32_t second) const {
    const double weight = double{clusters_[first].exposure.weight};
    const double total = weight + double{clusters_[second].exposure.weight};
    return total > 0 ? weight / total : 0.5;
  }

  // METHOD §2 for two, and the error of it.
  Cluster joined(uint32_t first, uint32_t second) {
    const Cluster &a = clusters_[first], &b = clusters_[second];
    const double share = share_of(first, second), other = 1 - share;
    const Blob children[2] = {a.blob, b.blob};
    Group group;
    group.children = children;
    group.footprint = footprint_;
    group.low_pass = low_pass_;
    group.parent.mean = share * a.blob.mean + other * b.blob.mean;
    const Vec3d d = b.blob.mean - a.blob.mean;
    int k = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j, ++k)
        group.parent.covariance[k] = (share * a.blob.covariance[k] + other * b.blob.covariance[k]) +
                                     share * other * (d[i] * d[j]);
    set_colours(share, other, squared_colour_distance(colour(first), colour(second), coefficients_),
                group);
    const Exposure shown[2] = {a.exposure, b.exposure};
    const double weights[2] = {double{a.exposure.weight}, double{b.exposure.weight}};
    const Exposure exposure = set_exposure(shown, weights, group);
    const StandIn found = stand_in(group);
    Cluster cluster{
        group.parent, exposure, std::max({found.pixel, a.pixel, b.pixel}), {first, second}};
    cluster.blob.opacity = found.opacity;
    return cluster;
  }

  // Pairs each active cluster with its nearest few.
  void find_pairs() {
    pairs_.clear();
    const size_t count = active_.size();
    x_.resize(count);
    y_.resize(count);
    z_.resize(count);
    distance_.resize(count);
    const Vec3d& centre = clusters_[active_[0]].blob.mean;
    for (size_t i = 0; i < count; ++i) {
      const Vec3d mean = clusters_[active_[i]].blob.mean - centre;
      x_[i] = static_cast<float>(mean.x);
      y_[i] = static_cast<float>(mean.y);
      z_[i] = static_cast<float>(mean.z);
    }
    for (size_t i = 0; i < count; ++i) {
      for (size_t j = 0; j < count; ++j) {
        const float x = x_[j] - x_[i], y = y_[j] - y_[i], z = z_[j] - z_[i];
        distance_[j] = (x * x + y * y) + z * z;
      }
      add_nearest(static_cast<uint32_t>(i));
    }
    std::sort(pairs_.begin(), pairs_.end(), is_before);
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end(),
                             [](const Pair& a, const Pair& b) {
                               return a.first == b.first && a.second == b.second;
                             }),
                 pairs_.end());
    measure_pairs();
    std::sort(pairs_.begin(), pairs_.end());
  }

  // The last round has already measured about three of ten pairs. Both lists are in the order of
  // clusters.
  void measure_pairs() {
    auto known = measured_.begin();
    for (Pair& pair : pairs_) {
      while (known != measured_.end() && is_before(*known, pair)) ++known;
      const bool is_known = known != measured_.end() && !is_before(pair, *known);
      pair.pixel = is_known ? known->pixel : joined(pair.first, pair.second).pixel;
    }
    measured_ = pairs_;
  }

  // Of equally near clusters it takes those that follow i in order; after the last comes the first.
  // So clusters in one place do not all have the same neighbours, and a round makes many pairs.
  void add_nearest(uint32_t i) {
    float near[kNeighbours];
    uint32_t at[kNeighbours];
    size_t found = 0;
    const auto look = [&](uint32_t begin, uint32_t end) {
      for (uint32_t j = begin; j < end; ++j) {
        const float d = distance_[j];
        if (found == kNeighbours && !(d < near[found - 1])) continue;
        size_t k = found < kNeighbours ? found++ : found - 1;
        for (; k > 0 && d < near[k - 1]; --k) {
          near[k] = near[k - 1];
          at[k] = at[k - 1];
        }
        near[k] = d;
        at[k] = j;
      }
    };
    look(i + 1, static_cast<uint32_t>(distance_.size()));
    look(0, i);
    for (size_t k = 0; k < found; ++k) {
      const uint32_t a = active_[i], b = active_[at[k]];
      pairs_.push_back({0, std::min(a, b), std::max(a, b)});
    }
  }

  void join_pairs() {
    taken_.assign(clusters_.size(), false);
    size_t chosen = 0;
    for (const Pair& pair : pairs_) {
      if (taken_[pair.first] || taken_[pair.second]) continue;
      taken_[pair.first] = taken_[pair.second] = true;
      pairs_[chosen++] = pair;
    }
    const size_t made = active_.size() <= kFewNodes ? chosen : (chosen + 1) / 2;
    taken_.assign(clusters_.size(), false);
    std::vector<uint32_t> next;
    for (size_t i = 0; i < made; ++i) {
      const auto [pixel, first, second] = pairs_[i];
      taken_[first] = taken_[second] = true;
      next.push_back(static_cast<uint32_t>(clusters_.size()));
      const Cluster cluster = joined(first, second);
      const double share = share_of(first, second);
      float* sum = colour(clusters_.size());
      for (int k = 0; k < 3 * coefficients_; ++k)
        sum[k] = static_cast<float>(share * colour(first)[k] + (1 - share) * colour(second)[k]);
      clusters_.push_back(cluster);
    }
    for (const uint32_t cluster : active_)
      if (!taken_[cluster]) next.push_back(cluster);
    std::sort(next.begin(), next.end());
    active_ = std::move(next);
  }

  size_t leaves_;
  int coefficients_;
  double footprint_, low_pass_;
  std::vector<Cluster> clusters_;
  std::vector<float> colours_;
  std::vector<uint32_t> active_;
  std::vector<Pair> pairs_, measured_;  // of this round, and of the last
  std::vector<bool> taken_;
  std::vector<float> x_, y_, z_, distance_;
};

// A child whose pixel is at least this share of its parent's is replaced by its own two children,
// until the parent has four. Such a child's Gaussian would be drawn from few distances only.
constexpr double kWorthwhile = 0.5;
class Flattening {
 public:
  Flattening(const std::vector<Cluster>& clusters, size_t leaves)
      : clusters_(clusters), leaves_(leaves) {
    tree_.nodes.resize(leaves);
  }

  ClusterTree run() {
    add(static_cast<uint32_t>(clusters_.size() - 1));
    return std::move(tree_);
  }

 private:
  uint32_t add(uint32_t cluster) {
    if (cluster < leaves_) return cluster;
    uint32_t child[4] = {clusters_[cluster].child[0], clusters_[cluster].child[1]};
    uint32_t count = 2;
    while (count < 4) {
      uint32_t widest = count;
      for (uint32_t i = 0; i < count; ++i)
        if (child[i] >= leaves_ &&
            clusters_[child[i]].pixel >= kWorthwhile * clusters_[cluster].pixel &&
            (widest == count || clusters_[child[i]].pixel > clusters_[child[widest]].pixel))
          widest = i;
      if (widest == count) break;
      const Cluster& gone = clusters_[child[widest]];
      child[widest] = gone.child[0];
      child[count++] = gone.child[1];
    }
    ClusterTree::Node node{{}, count};
    for (uint32_t i = 0; i < count; ++i) node.child[i] = add(child[i]);
    tree_.nodes.push_back(node);
    return static_cast<uint32_t>(tree_.nodes.size() - 1);
  }

  const std::vector<Cluster>& clusters_;
  size_t leaves_;
  ClusterTree tree_;
};

}  // namespace

ClusterTree cluster(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                    std::span<const uint32_t> leaves, std::span<const ExposureCode> exposure,
                    int footprint_level) {
  const std::vector<Cluster> clusters =
      Clustering(cloud, origin, leaves, exposure, footprint_level).run();
  return Flattening(clusters, leaves.size()).run();
}

}  // namespace voyager
