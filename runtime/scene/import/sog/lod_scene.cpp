// The finest level of a streamed SOG scene: one file after the other, of which only the one that
// is read is held.
#include <algorithm>
#include <cstring>
#include <optional>

#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/sog/lod_meta.h"
#include "runtime/scene/import/sog/scene.h"
#include "runtime/scene/sh_bands.h"

namespace voyager::sog {
namespace {

// A Gaussian takes six pixels, and its position alone several bytes.
constexpr uint64_t kFreePixels = 1 << 24, kPixelsOfAByte = 64;

class LodScene final : public BlockReader {
 public:
  explicit LodScene(std::shared_ptr<const ByteSource> source)
      : source_(std::move(source)), parts_(finest_level(*source_)) {
    for (Part& part : parts_) check(part);
    check_total();
  }

  const std::string& name() const override { return source_->name(); }
  uint64_t count() const override { return count_; }
  int sh_degree() const override { return sh_degree_; }
  NativeScale native() const override {
    return antialiased_.value_or(false) ? compensated_scale(kLowPass) : NativeScale{};
  }

  // A block is decoded already: its file may be closed when decode() is called.
  RawBlock next(size_t most) override {
    const uint64_t rows = kMostBlockBytes / bytes_of_gaussian(sh_degree_);
    const RawBlock codes = next_codes(static_cast<size_t>(std::min<uint64_t>(rows, most)));
    RawBlock block;
    block.count = codes.count;
    if (block.count == 0) return block;
    GaussianCloud cloud = (scene_ ? scene_ : done_)->decode(codes);
    change_sh_degree(cloud.sh, cloud.sh_degree, sh_degree_);
    for (const auto array : kArrays) append(cloud.*array, block.bytes);
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud;
    cloud.sh_degree = sh_degree_;
    cloud.native = native();
    const size_t widths[] = {3, 3, 4, 1, static_cast<size_t>(cloud.coefficients()) * 3};
    const std::byte* from = block.bytes.data();
    for (size_t i = 0; i < std::size(kArrays); ++i) {
      auto& values = cloud.*kArrays[i];
      values.resize(block.count * widths[i]);
      std::memcpy(values.data(), from, values.size() * sizeof(float));
      from += values.size() * sizeof(float);
    }
    return cloud;
  }

 private:
  static constexpr std::pmr::vector<float> GaussianCloud::*kArrays[] = {
      &GaussianCloud::position, &GaussianCloud::log_scale, &GaussianCloud::rotation,
      &GaussianCloud::opacity, &GaussianCloud::sh};

  static void append(const std::pmr::vector<float>& values, std::vector<std::byte>& bytes) {
    const auto more = std::as_bytes(std::span(values));
    bytes.insert(bytes.end(), more.begin(), more.end());
  }

  std::unique_ptr<Files> files_of(const Part& part) const {
    return open_files(source_->open_beside(part.file));
  }

  void take_meta(const Files& files) {
    checked_ = read_meta(files);
    bytes_.merge(files.bytes(checked_.named_files()));
    whole_count_ += checked_.count;
    has_sh_ = has_sh_ || checked_.has_sh;
  }

  // Files may share images, and each alone is worth some Gaussians whatever its size.
  void check_total() {
    const uint64_t bytes = sum_of(bytes_), most = most_gaussians_in(bytes, has_sh_);
    if (whole_count_ > most)
      refuse(name(), 0, "Gaussians of the files", std::to_string(whole_count_),
             "at most " + std::to_string(most) + " in " + std::to_string(bytes) + " bytes");
    budget_.most = kFreePixels + kPixelsOfAByte * bytes;
  }

  // What is asked of a file's meta.json before any image is read.
  void check(Part& part) {
    const bool again = &part != parts_.data() && (&part)[-1].file == part.file;
    if (!again) take_meta(*files_of(part));
    const Meta& meta = checked_;
    if (meta.has_sh && !meta.sh_degree)
      refuse(name(), 0, part.file, "version 1", "version 2 in a streamed scene");
    if (part.count == UINT64_MAX) part.count = meta.count;
    if (part.first > meta.count || part.count > meta.count - part.first)
      refuse(name(), 0, part.file, "Gaussians up to " + std::to_string(part.first + part.count),
             "at most the " + std::to_string(meta.count) + " that it has");
    if (antialiased_.value_or(meta.antialiased) != meta.antialiased)
      refuse(name(), 0, part.file, "another value of antialias", "that of the other files");
    antialiased_ = meta.antialiased;
    sh_degree_ = std::max(sh_degree_, meta.sh_degree.value_or(0));
    count_ += part.count;
  }

  // Parts of one file that follow one another in it are read in one pass: its images are decoded
  // once.
  void open_next() {
    done_ = nullptr;
    last_ = part_;
    while (last_ + 1 < parts_.size() && parts_[last_ + 1].file == parts_[part_].file &&
           parts_[last_ + 1].first >= end_of(parts_[last_]))
      ++last_;
    at_ = parts_[part_].first;
    scene_ = open_scene(files_of(parts_[part_]), at_, end_of(parts_[last_]) - at_, &budget_);
  }

  static uint64_t end_of(const Part& part) { return part.first + part.count; }

  // Of the part that is being read, or else of the next that has any.
  RawBlock next_codes(size_t most) {
    while (part_ < parts_.size()) {
      if (!scene_) open_next();
      const Part& part = parts_[part_];
      while (at_ < part.first) at_ += rows_of(part.first - at_, most).count;  // nobody wants these
      RawBlock codes = rows_of(end_of(part) - at_, most);
      at_ += codes.count;
      if (at_ == end_of(part) && part_++ == last_) done_ = std::move(scene_);
      if (codes.count > 0) return codes;
    }
    return {};
  }

  // A file that has fewer than its meta.json said a moment ago has been changed.
  RawBlock rows_of(uint64_t count, size_t most) {
    RawBlock rows = scene_->next(static_cast<size_t>(std::min<uint64_t>(count, most)));
    if (rows.count == 0 && count > 0)
      refuse(name(), 0, parts_[part_].file, std::to_string(at_) + " Gaussians",
             std::to_string(count) + " more, as before it was read");
    return rows;
  }

  std::shared_ptr<const ByteSource> source_;
  std::vector<Part> parts_;
  uint64_t count_ = 0;
  int sh_degree_ = 0;
  std::optional<bool> antialiased_;
  Meta checked_;              // the file's of the part that was checked last
  FileBytes bytes_;           // of all images
  uint64_t whole_count_ = 0;  // Gaussians of the files, wanted or not
  bool has_sh_ = false;
  PixelBudget budget_{0};
  size_t part_ = 0;                            // that is read
  size_t last_ = 0;                            // of those that the open file is read for
  uint64_t at_ = 0;                            // Gaussian of that file
  std::unique_ptr<BlockReader> scene_, done_;  // whose last block may still be decoded
};

}  // namespace

std::unique_ptr<BlockReader> open_streamed(std::shared_ptr<const ByteSource> source) {
  return std::make_unique<LodScene>(std::move(source));
}

}  // namespace voyager::sog
