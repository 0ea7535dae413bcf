#include "runtime/scene/export/sog/sh_sets.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

namespace voyager::sog_export {
namespace {

constexpr size_t kParts = 16;
constexpr int kCentreRounds = 6;
constexpr int kLevels = 12;      // at most, which bounds the time whatever the rows are
constexpr size_t kSample = 512;  // rows that first centres are chosen from

using PerPart = std::array<float, kParts>;

double squared_distance(const float* a, const float* b, size_t width) {
  double sum = 0;
  for (size_t d = 0; d < width; ++d) sum += double{a[d] - b[d]} * double{a[d] - b[d]};
  return sum;
}

class Tree {
 public:
  Tree(const Rows& rows, size_t most) : rows_(rows), order_(rows.count), part_(rows.count) {
    std::iota(order_.begin(), order_.end(), size_t{0});
    sets_.labels.resize(rows.count);
    if (rows.count > 0) divide(order_, most, kLevels);
  }
  ShSets take() { return std::move(sets_); }

 private:
  using Indices = std::span<size_t>;

  struct Part {
    Indices indices;
    double error = 0;  // squared, around its centre
    size_t sets = 1;
  };

  void divide(Indices indices, size_t sets, int levels) {
    if (sets == 1 || indices.size() == 1 || levels == 0) return close(indices);
    if (indices.size() <= sets) {
      for (size_t i = 0; i < indices.size(); ++i) close(indices.subspan(i, 1));
      return;
    }
    std::vector<Part> parts = part(indices, std::min(sets, kParts));
    if (parts.size() == 1) return close(indices);
    share_out(parts, sets);
    for (const Part& each : parts) divide(each.indices, each.sets, levels - 1);
  }

  // One set, the mean.
  void close(Indices indices) {
    std::vector<double> sums(rows_.width);
    for (const size_t i : indices)
      for (size_t d = 0; d < rows_.width; ++d) sums[d] += double{rows_[i][d]};
    const size_t label = sets_.values.size() / rows_.width;
    for (const double sum : sums)
      sets_.values.push_back(static_cast<float>(sum / static_cast<double>(indices.size())));
    for (const size_t i : indices) sets_.labels[i] = static_cast<uint16_t>(label);
  }

  // k-means++ over a sample.
  void choose_centres(Indices indices, size_t count) {
    std::vector<const float*> sample(std::min(kSample, indices.size()));
    for (const float*& row : sample) row = rows_[indices[random_() % indices.size()]];
    std::vector<double> distances(sample.size(), 1.0);
    centres_.assign(rows_.width, PerPart{});
    for (size_t c = 0; c < count; ++c) {
      const double total = std::accumulate(distances.begin(), distances.end(), 0.0);
      double at = total * (static_cast<double>(random_()) / 4294967296.0);
      size_t chosen = 0;
      while (chosen + 1 < sample.size() && at >= distances[chosen]) at -= distances[chosen++];
      for (size_t d = 0; d < rows_.width; ++d) centres_[d][c] = sample[chosen][d];
      for (size_t i = 0; i < sample.size(); ++i) {
        const double distance = squared_distance(sample[i], sample[chosen], rows_.width);
        distances[i] = c == 0 ? distance : std::min(distances[i], distance);
      }
    }
  }

  // The nearest of `count` centres; side by side, so that the compiler works on all at once.
  std::pair<size_t, float> nearest(const float* row, size_t count) const {
    PerPart distances{};
    for (size_t d = 0; d < rows_.width; ++d)
      for (size_t c = 0; c < kParts; ++c) {
        const float difference = row[d] - centres_[d][c];
        distances[c] += difference * difference;
      }
    const auto least =
        std::min_element(distances.begin(), distances.begin() + static_cast<long>(count));
    return {static_cast<size_t>(least - distances.begin()), *least};
  }

  void move_centres(Indices indices, size_t count) {
    std::vector<double> sums(count * rows_.width);
    std::array<size_t, kParts> counts{};
    for (const size_t i : indices) {
      const size_t c = nearest(rows_[i], count).first;
      ++counts[c];
      for (size_t d = 0; d < rows_.width; ++d) sums[c * rows_.width + d] += double{rows_[i][d]};
    }
    for (size_t c = 0; c < count; ++c)
      for (size_t d = 0; counts[c] > 0 && d < rows_.width; ++d)
        centres_[d][c] =
            static_cast<float>(sums[c * rows_.width + d] / static_cast<double>(counts[c]));
  }

  // Those that are not empty; puts the indices of each side by side.
  std::vector<Part> part(Indices indices, size_t count) {
    choose_centres(indices, count);
    for (int round = 0; round < kCentreRounds; ++round) move_centres(indices, count);
    std::array<double, kParts> errors{};
    std::array<size_t, kParts> counts{};
    for (const size_t i : indices) {
      const auto [c, error] = nearest(rows_[i], count);
      part_[i] = static_cast<uint8_t>(c);
      errors[c] += double{error};
      ++counts[c];
    }
    std::stable_sort(indices.begin(), indices.end(),
                     [&](size_t a, size_t b) { return part_[a] < part_[b]; });
    std::vector<Part> parts;
    size_t begin = 0;
    for (size_t c = 0; c < count; begin += counts[c++])
      if (counts[c] > 0) parts.push_back({indices.subspan(begin, counts[c]), errors[c]});
    return parts;
  }

  // One each, then by squared error, no more than a part has rows.
  static void share_out(std::vector<Part>& parts, size_t sets) {
    const auto by_error = [](const Part& a, const Part& b) { return a.error > b.error; };
    std::stable_sort(parts.begin(), parts.end(), by_error);
    double error = 0;
    for (const Part& each : parts) error += each.error;
    size_t left = sets - parts.size();
    for (Part& each : parts) {
      if (!(error > 0)) break;
      const double share = std::min(1.0, each.error / error);
      const size_t more = std::min({static_cast<size_t>(static_cast<double>(left) * share + 0.5),
                                    each.indices.size() - 1, left});
      each.sets += more;
      left -= more;
      error -= each.error;
    }
  }

  Rows rows_;
  std::vector<size_t> order_;
  std::vector<uint8_t> part_;     // of each row, the part that it falls into
  std::vector<PerPart> centres_;  // of each coefficient
  std::mt19937 random_{1};
  ShSets sets_;
};

}  // namespace

ShSets sh_sets_of(const Rows& rows, size_t most) {
  return Tree(rows, most).take();
}

}  // namespace voyager::sog_export
