#include "runtime/scene/import/lcc/rows.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "runtime/math/byte_code.h"
#include "runtime/scene/import/load.h"

namespace voyager::lcc {
namespace {

constexpr uint64_t kMostBytes = 16 << 20;  // of a block

// Three components of x, y, z, w in ten bits each, then which of the four is left out.
void decode_rotation(uint32_t bits, float* wxyz) {
  SmallestThree three{static_cast<int>(bits >> 30), {}};
  for (float& other : three.others) {
    other = between(-kSqrtHalf, kSqrtHalf, bits & 1023u, 1023);
    bits >>= 10;
  }
  const std::array<float, 4> xyzw = quaternion_of(three);
  wxyz[0] = xyzw[3];
  std::copy_n(xyzw.begin(), 3, wxyz + 1);
}

void decode_row(const std::byte* row, const Bounds& scale, size_t i, GaussianCloud& cloud) {
  float* sh = &cloud.sh[i * static_cast<size_t>(cloud.coefficients()) * 3];
  for (size_t k = 0; k < 3; ++k) {
    cloud.position[3 * i + k] = load<float>(row + 4 * k);
    sh[k] = sh_of_colour(std::to_integer<int>(row[12 + k]) / 255.0);
    cloud.log_scale[3 * i + k] = log_of_scale(
        between(scale.least[k], scale.most[k], load<uint16_t>(row + 16 + 2 * k), 65535));
  }
  cloud.opacity[i] = logit_of_byte(std::to_integer<int>(row[15]));
  decode_rotation(load<uint32_t>(row + 22), &cloud.rotation[4 * i]);
}

// A word for each coefficient above the constant one; the last of 16 is unused.
void decode_sh(const std::byte* row, const Bounds& bounds, float* sh) {
  constexpr uint32_t kMost[] = {2047, 1023, 2047};
  constexpr int kShift[] = {0, 11, 21};
  for (size_t k = 1; k < 16; ++k) {
    const auto word = load<uint32_t>(row + 4 * (k - 1));
    for (size_t c = 0; c < 3; ++c)
      sh[3 * k + c] =
          between(bounds.least[c], bounds.most[c], word >> kShift[c] & kMost[c], kMost[c]);
  }
}

class Reader final : public BlockReader {
 public:
  explicit Reader(Rows rows) : rows_(std::move(rows)), count_(rows_.count()) {}

  const std::string& name() const override { return rows_.file->name(); }
  uint64_t count() const override { return count_; }
  int sh_degree() const override { return rows_.sh_degree(); }
  NativeScale native() const override { return {}; }

  // A block: rows of one range, then their rows of the file of SH bands.
  RawBlock next(size_t most) override {
    RawBlock block;
    if (range_ == rows_.ranges.size()) return block;
    Range& left = rows_.ranges[range_];
    const uint64_t row = rows_.row_bytes(), sh_row = rows_.sh_file ? kShRowBytes : 0;
    block.count = std::min<uint64_t>({most, left.count, kMostBytes / (row + sh_row)});
    block.bytes.resize(block.count * (row + sh_row));
    const std::span<std::byte> all = block.bytes;
    rows_.file->read(left.offset, all.first(block.count * row));
    if (sh_row != 0)
      rows_.sh_file->read(kShRowBytes / kRowBytes * left.offset, all.subspan(block.count * row));
    left.offset += block.count * row;
    left.count -= block.count;
    if (left.count == 0) ++range_;
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud;
    cloud.sh_degree = rows_.sh_degree();
    const auto width = static_cast<size_t>(cloud.coefficients()) * 3;
    cloud.position.resize(3 * block.count);
    cloud.log_scale.resize(3 * block.count);
    cloud.rotation.resize(4 * block.count);
    cloud.opacity.resize(block.count);
    cloud.sh.resize(block.count * width);
    const std::byte* row = block.bytes.data();
    const uint64_t step = rows_.row_bytes(), sh_step = rows_.sh_file ? kShRowBytes : step;
    const std::byte* sh = row + (rows_.sh_file ? block.count * step : kRowBytes);
    for (size_t i = 0; i < block.count; ++i) {
      decode_row(row + i * step, rows_.scale, i, cloud);
      if (rows_.sh) decode_sh(sh + i * sh_step, *rows_.sh, &cloud.sh[i * width]);
    }
    return cloud;
  }

 private:
  Rows rows_;  // of its ranges what is left
  uint64_t count_;
  size_t range_ = 0;
};

}  // namespace

uint64_t Rows::count() const {
  return std::accumulate(ranges.begin(), ranges.end(), uint64_t{0},
                         [](uint64_t sum, const Range& range) { return sum + range.count; });
}

std::unique_ptr<BlockReader> open_rows(Rows rows) {
  return std::make_unique<Reader>(std::move(rows));
}

}  // namespace voyager::lcc
