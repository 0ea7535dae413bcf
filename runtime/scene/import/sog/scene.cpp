#include "runtime/scene/import/sog/scene.h"

#include <algorithm>
#include <array>

#include "runtime/math/byte_code.h"
#include "runtime/math/signed_log.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/load.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/sog/image.h"

namespace voyager::sog {
namespace {

// Where each image's channels are in the bytes of a Gaussian.
struct Place {
  size_t at, channels;
};
constexpr std::array<Place, kFiles> kPlaces = {
    {{0, 3}, {3, 3}, {6, 3}, {9, 4}, {13, 4}, {0, 0}, {17, 2}}};
constexpr size_t kRow = 19, kPixelBytes = 4;
constexpr size_t kMostRows = kMostBlockBytes / kRow;
constexpr uint32_t kCentroidsARow = 64;  // of their image
constexpr uint64_t kMostCentroidRows = 1024;
constexpr uint64_t kSparePixels = 1 << 16;  // of an image, which writers round up

using Row = std::span<const std::byte, kRow>;

float position_of(std::byte low, std::byte high, double least, double most) {
  const double share = (integer(low) + 256 * integer(high)) / 65535.0;
  return static_cast<float>(signed_exp((1.0 - share) * least + share * most));
}

// The last byte says which component is the largest; the others follow in the order w, x, y, z.
// Any other byte there leaves a rotation of zero, which sanitise() mends and counts.
void decode_rotation(std::span<const std::byte, 4> code, std::span<float, 4> wxyz) {
  SmallestThree found;
  found.largest = integer(code[3]) - 252;
  if (found.largest < 0) return;
  for (size_t i = 0; i < found.others.size(); ++i)
    found.others[i] = between(-kSqrtHalf, kSqrtHalf, static_cast<uint32_t>(integer(code[i])), 255);
  const std::array<float, 4> rotation = quaternion_of(found);
  std::copy(rotation.begin(), rotation.end(), wxyz.begin());
}

class Scene final : public BlockReader {
 public:
  Scene(std::unique_ptr<Files> files, uint64_t first, uint64_t count, PixelBudget* budget)
      : files_(std::move(files)),
        budget_(budget),
        name_(files_->name()),
        meta_(read_meta(*files_)) {
    check_count(sum_of(files_->bytes(meta_.named_files())));
    if (meta_.has_sh) read_centroids();
    first_ = std::min(first, meta_.count);
    count_ = std::min(count, meta_.count - first_);
  }

  const std::string& name() const override { return name_; }
  uint64_t count() const override { return count_; }
  int sh_degree() const override { return sh_degree_; }
  NativeScale native() const override {
    return meta_.antialiased ? compensated_scale(kLowPass) : NativeScale{};
  }

  RawBlock next(size_t most) override {
    if (files_) read_images();
    RawBlock block;
    block.count = static_cast<size_t>(std::min<uint64_t>({most, kMostRows, count_ - taken_}));
    const auto rows =
        std::span(rows_).subspan(static_cast<size_t>(taken_) * kRow, block.count * kRow);
    block.bytes.assign(rows.begin(), rows.end());
    taken_ += block.count;
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud;
    cloud.sh_degree = sh_degree_;
    cloud.native = native();
    cloud.position.resize(3 * block.count);
    cloud.log_scale.resize(3 * block.count);
    cloud.rotation.resize(4 * block.count);
    cloud.opacity.resize(block.count);
    cloud.sh.resize(block.count * width());
    for (size_t i = 0; i < block.count; ++i) decode_row(row_of(block.bytes, i), i, cloud);
    return cloud;
  }

 private:
  size_t width() const { return static_cast<size_t>(sh_coefficients(sh_degree_)) * 3; }

  void check_count(uint64_t length) const {
    const uint64_t most = most_gaussians_in(length, meta_.has_sh);
    if (meta_.count > most)
      refuse(
          name_, 0, "count", std::to_string(meta_.count) + " Gaussians",
          "at most " + std::to_string(most) + " in files of " + std::to_string(length) + " bytes");
  }

  void read_images() {
    rows_.resize(static_cast<size_t>(count_) * kRow);
    for (const File file : {kMeansLow, kMeansHigh, kScales, kQuats, kColours, kLabels})
      if (!meta_.files[file].empty()) read_image(file);
    check_labels();
    files_ = nullptr;
  }

  Image decode(const std::string& image, const PixelRange& pixels) const {
    return decode_webp(name_, image, files_->read(image, most_bytes(pixels)), pixels, budget_);
  }

  void read_image(File file) {
    const std::string& name = meta_.files[file];
    const PixelRange range{meta_.count, 2 * meta_.count + kSparePixels};
    const Image image = decode(name, range);
    const auto [at, channels] = kPlaces[file];
    for (uint64_t i = 0; i < count_; ++i)
      std::copy_n(image.pixel(first_ + i), channels,
                  reinterpret_cast<uint8_t*>(rows_.data() + i * kRow + at));
  }

  // Before version 2 only the image says how many there are.
  PixelRange pixels_of_centroids() const {
    if (!meta_.centroids) return {1, kMostCentroidRows * kCentroidsARow * 15};
    const auto each = static_cast<uint64_t>(sh_coefficients(*meta_.sh_degree) - 1);
    const uint64_t least = *meta_.centroids * each;
    return {least, 2 * least + kSparePixels};
  }

  void read_centroids() {
    const std::string& name = meta_.files[kCentroids];
    const Image image = decode(name, pixels_of_centroids());
    sh_degree_ = meta_.sh_degree.value_or(degree_of_width(image.width));
    const auto each = static_cast<uint32_t>(sh_coefficients(sh_degree_) - 1);
    const uint64_t found = uint64_t{image.height} * kCentroidsARow;
    if (image.width != kCentroidsARow * each || meta_.centroids.value_or(1) > found)
      refuse(name_, 0, name,
             std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels",
             "64 centroids a row, each of 3, 8 or 15 pixels as the SH degree says, and a row for "
             "each 64 of shN.count");
    centroid_count_ = meta_.centroids.value_or(found);
    centroids_.resize(static_cast<size_t>(centroid_count_) * 3 * each);
    for (size_t i = 0; i < centroids_.size(); ++i) centroids_[i] = image.pixel(i / 3)[i % 3];
  }

  static int degree_of_width(uint32_t width) {
    int degree = 1;
    while (degree < kMaxShDegree &&
           width > kCentroidsARow * static_cast<uint32_t>(sh_coefficients(degree) - 1))
      ++degree;
    return degree;
  }

  static Row row_of(std::span<const std::byte> rows, size_t i) {
    return rows.subspan(i * kRow).first<kRow>();
  }

  static uint64_t label_of(Row row) { return load<uint16_t>(&row[kPlaces[kLabels].at]); }

  void check_labels() const {
    for (uint64_t i = 0; sh_degree_ > 0 && i < count_; ++i)
      if (const uint64_t label = label_of(row_of(rows_, i)); label >= centroid_count_)
        refuse(name_, 0, meta_.files[kLabels],
               "label " + std::to_string(label) + " of Gaussian " + std::to_string(first_ + i),
               "less than the " + std::to_string(centroid_count_) + " centroids");
  }

  void decode_row(Row row, size_t i, GaussianCloud& cloud) const {
    const auto code = [&](File file, size_t k) { return row[kPlaces[file].at + k]; };
    const auto index = [&](File file, size_t k) { return std::to_integer<size_t>(code(file, k)); };
    float* sh = &cloud.sh[i * width()];
    for (size_t k = 0; k < 3; ++k) {
      cloud.position[3 * i + k] = position_of(code(kMeansLow, k), code(kMeansHigh, k),
                                              meta_.means_least[k], meta_.means_most[k]);
      cloud.log_scale[3 * i + k] = meta_.scales[k][index(kScales, k)];
      sh[k] = meta_.colours[k][index(kColours, k)];
    }
    decode_rotation(row.subspan<kPlaces[kQuats].at, 4>(),
                    std::span<float, 4>(&cloud.rotation[4 * i], 4));
    cloud.opacity[i] = meta_.opacities[index(kColours, 3)];
    const size_t rest = width() - 3;
    if (rest == 0) return;
    const uint8_t* codes = &centroids_[label_of(row) * rest];
    for (size_t k = 0; k < rest; ++k) sh[3 + k] = meta_.sh[codes[k]];
  }

  std::unique_ptr<Files> files_;  // until the images are read
  PixelBudget* budget_;
  std::string name_;
  Meta meta_;
  int sh_degree_ = 0;
  uint64_t first_ = 0, count_ = 0, taken_ = 0;  // Gaussians
  uint64_t centroid_count_ = 0;
  std::vector<uint8_t> centroids_;  // of each the codes of [k - 1][rgb], which fit the cache
  std::vector<std::byte> rows_;     // kRow bytes a Gaussian
};

}  // namespace

// An image of one colour takes some thirty bytes, whatever its size.
uint64_t most_gaussians_in(uint64_t file_bytes, bool has_sh) {
  return most_gaussians(file_bytes,
                        bytes_of_gaussian(has_sh ? kMaxShDegree : 0) + kRow + 4 * kPixelBytes);
}

std::unique_ptr<BlockReader> open_scene(std::unique_ptr<Files> files, uint64_t first,
                                        uint64_t count, PixelBudget* budget) {
  return std::make_unique<Scene>(std::move(files), first, count, budget);
}

std::unique_ptr<BlockReader> open(std::shared_ptr<const ByteSource> source) {
  return open_scene(open_files(std::move(source)));
}

}  // namespace voyager::sog
