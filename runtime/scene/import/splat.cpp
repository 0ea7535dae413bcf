// antimatter15's .splat: 32 bytes a Gaussian from the first byte to the last, little-endian.
#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

#include "runtime/math/byte_code.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/load.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::splat {
namespace {

constexpr size_t kRow = 32, kScale = 12, kColour = 24, kRotation = 28;  // bytes
constexpr size_t kMostRows = kMostBlockBytes / kRow;

static_assert(std::endian::native == std::endian::little);

void decode_row(std::span<const std::byte, kRow> row, size_t i, GaussianCloud& cloud) {
  float scale[3];
  std::memcpy(&cloud.position[3 * i], row.data(), sizeof scale);
  std::memcpy(scale, &row[kScale], sizeof scale);
  for (size_t k = 0; k < 3; ++k) {
    cloud.log_scale[3 * i + k] = log_of_scale(scale[k]);
    cloud.sh[3 * i + k] = sh_of_colour(integer(row[kColour + k]) / 255.0);
  }
  cloud.opacity[i] = logit_of_byte(integer(row[kColour + 3]));
  // As the format's author reads them, and writers mean them; many writers cut fractions off.
  for (size_t k = 0; k < 4; ++k)
    cloud.rotation[4 * i + k] = static_cast<float>(integer(row[kRotation + k]) - 128) / 128.0f;
}

class Reader final : public BlockReader {
 public:
  explicit Reader(std::unique_ptr<ByteReader> reader) : reader_(std::move(reader)) {
    const std::optional<uint64_t> bytes = reader_->remaining();
    // No scene is a file of nothing, as a failed download leaves it.
    if (!bytes || *bytes == 0 || *bytes % kRow != 0)
      refuse(name(), reader_->offset(), "length of the .splat",
             bytes ? std::to_string(*bytes) + " bytes" : "a stream without a length",
             "a multiple of 32 bytes, one row a Gaussian, and not 0");
    count_ = *bytes / kRow;
  }

  const std::string& name() const override { return reader_->name(); }
  uint64_t count() const override { return count_; }
  int sh_degree() const override { return 0; }
  NativeScale native() const override { return {}; }

  RawBlock next(size_t most) override {
    RawBlock block;
    block.count = static_cast<size_t>(std::min<uint64_t>({most, kMostRows, count_ - taken_}));
    block.bytes.resize(block.count * kRow);
    const size_t got = reader_->read(block.bytes);
    if (got != block.bytes.size())
      refuse(name(), reader_->offset(), "rows", std::to_string(taken_ * kRow + got) + " bytes",
             std::to_string(count_ * kRow) + " bytes");
    taken_ += block.count;
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud;
    cloud.position.resize(3 * block.count);
    cloud.log_scale.resize(3 * block.count);
    cloud.rotation.resize(4 * block.count);
    cloud.opacity.resize(block.count);
    cloud.sh.resize(3 * block.count);
    const std::span rows(block.bytes);
    for (size_t i = 0; i < block.count; ++i)
      decode_row(rows.subspan(i * kRow).first<kRow>(), i, cloud);
    return cloud;
  }

 private:
  std::unique_ptr<ByteReader> reader_;
  uint64_t count_ = 0, taken_ = 0;  // Gaussians
};

}  // namespace
}  // namespace voyager::splat

namespace voyager {

std::unique_ptr<BlockReader> open_splat_blocks(std::unique_ptr<ByteReader> reader) {
  return std::make_unique<splat::Reader>(std::move(reader));
}

}  // namespace voyager
