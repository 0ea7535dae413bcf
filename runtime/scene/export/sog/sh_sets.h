#pragma once
// Sets of SH coefficients that stand for those of many Gaussians.
#include <cstdint>
#include <span>
#include <vector>

namespace voyager::sog_export {

// What is sorted into sets: `count` rows of `width` numbers, `stride` apart, all finite.
struct Rows {
  const float* first;
  size_t count, width, stride;

  const float* operator[](size_t i) const { return first + i * stride; }
};

struct ShSets {
  std::vector<float> values;     // of each set `width`
  std::vector<uint16_t> labels;  // of each row its set
};

// At most `most` sets, 1 to 65,536. By k-means in a tree: rows are parted into 16 (k-means++ from a
// fixed seed, then Lloyd), sets are shared out by squared error, and each part is parted again.
// Some 100 distances a row and level, and four or five levels for 65,536 sets, where k-means over
// all of them takes 65,536 a row and round; in exchange a row's set may not be the nearest one.
ShSets sh_sets_of(const Rows& rows, size_t most);

}  // namespace voyager::sog_export
