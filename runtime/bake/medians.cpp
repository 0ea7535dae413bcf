#include "runtime/bake/medians.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <bit>

#include "runtime/base/first_that.h"
#include "runtime/lod/build.h"
#include "runtime/lod/shape.h"

namespace voyager {
namespace {

constexpr uint32_t kMostBins = 4096, kBinsAtOnce = 1u << 20;
constexpr uint64_t kMostCandidates = 1u << 22;

struct Bounds {
  Vec3f least{0, 0, 0}, most{0, 0, 0};
  bool any = false;

  void add(const Vec3f& m) {
    if (!any) least = most = m;
    any = true;
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], m[axis]);
      most[axis] = std::max(most[axis], m[axis]);
    }
  }
  void add(const Bounds& other) {
    if (!other.any) return;
    add(other.least);
    add(other.most);
  }
  // As kd_order() has it.
  int longest_side() const {
    const Vec3f side = most - least;
    return side.x >= side.y ? (side.x >= side.z ? 0 : 2) : (side.y >= side.z ? 1 : 2);
  }
};

// The search for the element of one rank in the order by (coordinate, index).
struct Search {
  int axis = 0;
  uint64_t rank = 0;  // among the elements inside
  uint64_t inside = 0;
  // Elements inside have a key from key_least to key_most; where these are equal, also an
  // index from index_least to index_most.
  float key_least = 0, key_most = 0;
  uint32_t index_least = 0, index_most = 0;

  // -1 below, 0 inside, 1 above.
  int side(float key, uint32_t index) const {
    if (key < key_least) return -1;
    if (key > key_most) return 1;
    if (key_least != key_most) return 0;
    return index < index_least ? -1 : index > index_most ? 1 : 0;
  }
  // Monotone in (key, index), for what is inside; the ends are in the first and the last.
  uint32_t bin(float key, uint32_t index, uint32_t bins) const {
    if (key_least != key_most) {
      const double width = double{key_most} - double{key_least};
      const double at = (double{key} - double{key_least}) / width * bins;
      return std::min(static_cast<uint32_t>(at), bins - 1);
    }
    const uint64_t width = uint64_t{index_most} - index_least + 1;
    return static_cast<uint32_t>((uint64_t{index} - index_least) * bins / width);
  }
  void narrow_to(uint32_t chosen, uint32_t bins);
};

// Floats in the order of these numbers; -0 is taken for 0.
int64_t place_of(float value) {
  const auto bits = std::bit_cast<uint32_t>(value + 0.0f);
  return bits >> 31 ? -static_cast<int64_t>(bits & 0x7fffffffu) : static_cast<int64_t>(bits);
}
float float_at(int64_t place) {
  const auto bits = static_cast<uint32_t>(place < 0 ? -place : place);
  return std::bit_cast<float>(place < 0 ? bits | 0x80000000u : bits);
}

void Search::narrow_to(uint32_t chosen, uint32_t bins) {
  const bool by_key = key_least != key_most;
  const auto bin_at = [&](int64_t place) {
    return by_key ? bin(float_at(place), 0, bins)
                  : bin(key_least, static_cast<uint32_t>(place), bins);
  };
  const int64_t least = by_key ? place_of(key_least) : index_least;
  const int64_t most = by_key ? place_of(key_most) : index_most;
  const int64_t begin = first_that(least, most, [&](int64_t p) { return bin_at(p) >= chosen; });
  const int64_t end = chosen + 1 == bins ? most + 1 : first_that(begin, most + 1, [&](int64_t p) {
    return p > most || bin_at(p) > chosen;
  });
  if (by_key) {
    key_least = float_at(begin);
    key_most = float_at(end - 1);
  } else {
    index_least = static_cast<uint32_t>(begin);
    index_most = static_cast<uint32_t>(end - 1);
  }
}

struct Candidate {
  uint32_t node, index;
  Vec3f mean;
};

class MedianFinder {
 public:
  MedianFinder(const SpoolInfo& spool, uint32_t cell_level, const KdRule& rule,
               const WorkFolder& folder, const std::array<double, 3>& origin, uint64_t memory,
               Workers& workers)
      : spool_(spool),
        levels_(rule.splits * cell_level),
        rule_(rule),
        file_(ScratchFile::open(folder.file(kPositionRows))),
        origin_(origin),
        most_candidates_(
            std::clamp<uint64_t>(memory / 4 / sizeof(Candidate), 1024, kMostCandidates)),
        workers_(workers) {}

  SplitTree run(const Progress& progress) {
    sizes_ = {spool_.gaussians};
    bounds_ = {bounds_of_all()};
    for (uint32_t level = 0; level < levels_; ++level) {
      report(progress, "splitting", level, levels_);
      split_level();
    }
    report(progress, "splitting", levels_, levels_);
    return std::move(tree_);
  }

 private:
  // visit(local of the thread, mean, index) for every Gaussian, by all threads.
  template <class Local, class Visit>
  void for_all(tbb::enumerable_thread_specific<Local>& locals, bool checked, const Visit& visit) {
    workers_.for_blocks(spool_.pieces.size(), 1, [&](size_t i, size_t) {
      const SpoolPiece& piece = spool_.pieces[i];
      std::vector<float> words;
      if (checked) {
        words = read_positions(file_, piece);
      } else {
        words.resize(3 * size_t{piece.count});
        file_.read(uint64_t{piece.first} * 3 * sizeof(float),
                   std::as_writable_bytes(std::span(words)));
      }
      Local& local = locals.local();
      for (uint32_t k = 0; k < piece.count; ++k) {
        const float* word = words.data() + 3 * size_t{k};
        if (checked) check_mean(piece.first + k, local_mean(word, spool_.source_origin, {0, 0, 0}));
        visit(local, local_mean(word, spool_.source_origin, origin_), piece.first + k);
      }
    });
  }

  Bounds bounds_of_all() {
    tbb::enumerable_thread_specific<Bounds> locals;
    for_all(locals, true, [](Bounds& bounds, const Vec3f& mean, uint32_t index) {
      check_mean(index, mean);
      bounds.add(mean);
    });
    Bounds bounds;
    for (const Bounds& local : locals) bounds.add(local);
    return bounds;
  }

  void split_level() {
    const size_t nodes = sizes_.size();
    searches_.resize(nodes);
    for (size_t i = 0; i < nodes; ++i) {
      const int axis = bounds_[i].longest_side();
      searches_[i] = {axis,
                      lower_part(sizes_[i], rule_),
                      sizes_[i],
                      bounds_[i].least[axis] + 0.0f,
                      bounds_[i].most[axis] + 0.0f,
                      0,
                      spool_.gaussians - 1};
    }
    const uint64_t few = std::max<uint64_t>(most_candidates_ / nodes, 16);
    while (std::any_of(searches_.begin(), searches_.end(),
                       [&](const Search& s) { return s.inside > few; }))
      narrow(few);
    choose();
  }

  void narrow(uint64_t few) {
    const size_t nodes = searches_.size();
    const uint32_t bins = std::clamp(kBinsAtOnce / static_cast<uint32_t>(nodes), 64u, kMostBins);
    using Counts = std::vector<uint32_t>;
    tbb::enumerable_thread_specific<Counts> locals(Counts(nodes * bins));
    for_all(locals, false, [&](Counts& counts, const Vec3f& mean, uint32_t index) {
      const uint32_t node = tree_.node_of(mean, index);
      const Search& search = searches_[node];
      const float key = mean[search.axis];
      if (search.inside <= few || search.side(key, index) != 0) return;
      ++counts[size_t{node} * bins + search.bin(key, index, bins)];
    });
    workers_.for_blocks(nodes, 1, [&](size_t node, size_t) {
      Search& search = searches_[node];
      if (search.inside <= few) return;
      for (uint32_t bin = 0; bin < bins; ++bin) {
        uint64_t count = 0;
        for (const Counts& counts : locals) count += counts[node * bins + bin];
        if (search.rank >= count) {
          search.rank -= count;
          continue;
        }
        search.inside = count;
        search.narrow_to(bin, bins);
        return;
      }
    });
  }

  // What is left of every search at once, and the bounds of both sides of each split.
  void choose() {
    const size_t nodes = searches_.size();
    struct Found {
      std::vector<Candidate> candidates;
      std::vector<Bounds> sides;
    };
    tbb::enumerable_thread_specific<Found> locals(Found{{}, std::vector<Bounds>(2 * nodes)});
    for_all(locals, false, [&](Found& found, const Vec3f& mean, uint32_t index) {
      const uint32_t node = tree_.node_of(mean, index);
      const int side = searches_[node].side(mean[searches_[node].axis], index);
      if (side == 0)
        found.candidates.push_back({node, index, mean});
      else
        found.sides[2 * size_t{node} + (side < 0 ? 0 : 1)].add(mean);
    });
    std::vector<std::vector<Candidate>> candidates(nodes);
    std::vector<Bounds> sides(2 * nodes);
    for (Found& found : locals) {
      for (const Candidate& c : found.candidates) candidates[c.node].push_back(c);
      found.candidates = {};
      for (size_t i = 0; i < sides.size(); ++i) sides[i].add(found.sides[i]);
    }
    std::vector<SplitTree::Split> splits(nodes);
    workers_.for_blocks(nodes, 1, [&](size_t node, size_t) {
      splits[node] = choose_one(searches_[node], candidates[node], &sides[2 * node]);
    });
    tree_.add_level(splits);
    std::vector<uint32_t> sizes;
    for (const uint32_t size : sizes_) {
      const uint32_t lower = lower_part(size, rule_);
      sizes.insert(sizes.end(), {lower, size - lower});
    }
    sizes_ = std::move(sizes);
    bounds_ = std::move(sides);
  }

  static SplitTree::Split choose_one(const Search& search, std::vector<Candidate>& candidates,
                                     Bounds* sides) {
    const int axis = search.axis;
    const auto pivot = candidates.begin() + static_cast<std::ptrdiff_t>(search.rank);
    std::nth_element(candidates.begin(), pivot, candidates.end(),
                     [axis](const Candidate& a, const Candidate& b) {
                       const float p = a.mean[axis], q = b.mean[axis];
                       return p < q || (p == q && a.index < b.index);
                     });
    for (auto c = candidates.begin(); c != candidates.end(); ++c)
      sides[c < pivot ? 0 : 1].add(c->mean);
    return {axis, pivot->mean[axis], pivot->index};
  }

  const SpoolInfo& spool_;
  uint32_t levels_;
  const KdRule rule_;
  ScratchFile file_;
  const std::array<double, 3>& origin_;
  uint64_t most_candidates_;
  Workers& workers_;
  SplitTree tree_;
  // Of each node of the level that is split next.
  std::vector<uint32_t> sizes_;
  std::vector<Bounds> bounds_;
  std::vector<Search> searches_;
};

}  // namespace

void SplitTree::add_level(const std::vector<Split>& splits) {
  splits_.insert(splits_.end(), splits.begin(), splits.end());
  ++depth_;
}

std::array<double, 3> origin_of(const SpoolInfo& spool, const WorkFolder& folder) {
  const ScratchFile file = ScratchFile::open(folder.file(kPositionRows));
  std::vector<Vec3d> sample;
  for (uint64_t i = 0; i < spool.gaussians; i += origin_stride(spool.gaussians)) {
    float word[3];
    file.read(i * sizeof word, std::as_writable_bytes(std::span(word)));
    const std::array<double, 3>& origin = spool.source_origin;
    sample.push_back(
        {double{word[0]} + origin[0], double{word[1]} + origin[1], double{word[2]} + origin[2]});
  }
  return scene_origin(sample);
}

SplitTree find_medians(const SpoolInfo& spool, uint32_t cell_level, const KdRule& rule,
                       const WorkFolder& folder, const std::array<double, 3>& origin,
                       uint64_t memory, Workers& workers, const Progress& progress) {
  return MedianFinder(spool, cell_level, rule, folder, origin, memory, workers).run(progress);
}

}  // namespace voyager
