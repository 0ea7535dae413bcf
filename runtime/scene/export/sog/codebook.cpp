#include "runtime/scene/export/sog/codebook.h"

#include <algorithm>
#include <cmath>

namespace voyager::sog_export {
namespace {

constexpr size_t kBins = 64;
constexpr int kLloydRounds = 2000;  // of 256 searches each

Codebook first_guess(const std::vector<float>& sorted) {
  const double least = double{sorted.front()}, width = double{sorted.back()} - least;
  std::vector<double> weights(kBins);
  for (const float value : sorted) {
    const double bin = (double{value} - least) / width * kBins;
    ++weights[std::min(static_cast<size_t>(bin), kBins - 1)];
  }
  double total = 0;
  for (double& weight : weights) total += weight = std::cbrt(weight);
  Codebook codebook{};
  size_t bin = 0;
  double before = 0;
  for (size_t i = 0; i < codebook.size(); ++i) {
    const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(codebook.size()) * total;
    while (bin + 1 < kBins && before + weights[bin] < at) before += weights[bin++];
    const double inside = weights[bin] > 0 ? (at - before) / weights[bin] : 0.5;
    codebook[i] = static_cast<float>(
        least + (static_cast<double>(bin) + std::clamp(inside, 0.0, 1.0)) / kBins * width);
  }
  return codebook;
}

// Moves each to the mean of the values that are nearest to it; false where none moves.
bool improve(Codebook& codebook, const std::vector<float>& sorted,
             const std::vector<double>& sums) {
  bool moved = false;
  size_t begin = 0;
  for (size_t i = 0; i < codebook.size(); ++i) {
    size_t end = sorted.size();
    if (i + 1 < codebook.size()) {
      const double half = (double{codebook[i]} + double{codebook[i + 1]}) / 2;
      end = static_cast<size_t>(std::upper_bound(sorted.begin(), sorted.end(), half) -
                                sorted.begin());
    }
    if (end <= begin) continue;
    const double mean = (sums[end] - sums[begin]) / static_cast<double>(end - begin);
    const float value = std::clamp(static_cast<float>(mean), sorted[begin], sorted[end - 1]);
    moved = moved || value != codebook[i];
    codebook[i] = value;
    begin = end;
  }
  return moved;
}

}  // namespace

Codebook codebook_of(std::vector<float> values) {
  std::sort(values.begin(), values.end());
  Codebook codebook;
  codebook.fill(values.front());
  if (values.front() == values.back()) return codebook;
  std::vector<double> sums{0};
  for (const float value : values) sums.push_back(sums.back() + double{value});
  codebook = first_guess(values);
  for (int round = 0; round < kLloydRounds && improve(codebook, values, sums); ++round) {
  }
  std::sort(codebook.begin(), codebook.end());
  return codebook;
}

uint8_t code_of(const Codebook& codebook, float value) {
  const auto above = std::lower_bound(codebook.begin(), codebook.end(), value);
  auto code = above - codebook.begin();
  if (above == codebook.end() || (above != codebook.begin() && value - above[-1] <= *above - value))
    --code;
  return static_cast<uint8_t>(code);
}

}  // namespace voyager::sog_export
