#include <algorithm>
#include <cstring>
#include <span>

#include "runtime/math/byte_code.h"
#include "runtime/math/half.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/ksplat_format.h"
#include "runtime/scene/import/load.h"
#include "runtime/scene/import/peek_reader.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::ksplat {
namespace {

constexpr size_t kCentre = 3 * sizeof(float);

using Bytes = std::span<const std::byte>;

// `i` counts values from `from` on, each as wide as the level says.
float real(Level level, Bytes from, size_t i) {
  return level == Level::floats ? load<float>(&from[4 * i])
                                : half_to_float(load<uint16_t>(&from[2 * i]));
}

// A band has all red coefficients, then all green, then all blue: the place of value i in
// [k - 1][rgb].
size_t place_of(size_t i) {
  const size_t before = i < 9 ? 0 : 9, each = i < 9 ? 3 : 5;
  const size_t channel = (i - before) / each, k = before / 3 + (i - before) % each;
  return 3 * k + channel;
}

// The buckets of the section that is read, by which its positions are told.
class Buckets {
 public:
  void read(ByteReader& input, const Section& section) {
    section_ = &section;
    lengths_ = read_as_they_come(input, 4 * section.partial_buckets);
    centres_ = read_as_they_come(input, section.centre_bytes * section.buckets);
    const size_t expected =
        static_cast<size_t>(4 * section.partial_buckets + section.centre_bytes * section.buckets);
    if (lengths_.size() + centres_.size() != expected)
      refuse(input.name(), input.offset(), "buckets",
             std::to_string(lengths_.size() + centres_.size()) + " bytes",
             std::to_string(expected) + " bytes");
    bucket_ = 0;
    left_ = length_of(0);
  }

  // The centre of the next Gaussian's bucket; null where all buckets are full.
  const std::byte* next() {
    while (left_ == 0 && bucket_ < section_->buckets) left_ = length_of(++bucket_);
    if (bucket_ >= section_->buckets) return nullptr;
    --left_;
    return centres_.data() + bucket_ * section_->centre_bytes;
  }

 private:
  uint64_t length_of(uint64_t bucket) const {
    if (bucket < section_->full_buckets) return section_->bucket_size;
    const uint64_t partial = bucket - section_->full_buckets;
    if (partial >= section_->partial_buckets) return 0;
    return load<uint32_t>(lengths_.data() + 4 * partial);
  }

  const Section* section_ = nullptr;
  std::vector<std::byte> lengths_, centres_;
  uint64_t bucket_ = 0, left_ = 0;
};

class Reader final : public BlockReader {
 public:
  explicit Reader(std::unique_ptr<ByteReader> reader)
      : reader_(std::move(reader)), input_(*reader_), header_(read_header(input_)) {}

  const std::string& name() const override { return input_.name(); }
  uint64_t count() const override { return header_.count; }
  int sh_degree() const override { return header_.sh_degree(); }
  NativeScale native() const override { return {}; }

  // A block is the number of its section, the rows, and where positions are told by the centres of
  // buckets, that of each row.
  RawBlock next(size_t most) override {
    if (!find_rows()) return {};
    const Section& section = header_.sections[section_];
    const size_t row = header_.row_bytes(section), width = row + centre_bytes();
    RawBlock block;
    block.count = static_cast<size_t>(
        std::min<uint64_t>({most, kMostBlockBytes / width, section.count - taken_}));
    block.bytes.resize(sizeof section_ + block.count * width);
    std::memcpy(block.bytes.data(), &section_, sizeof section_);
    const auto rest = std::span(block.bytes).subspan(sizeof section_);
    read_rows(rest.first(block.count * row), section);
    for (size_t at = block.count * row; at < rest.size(); at += kCentre)
      copy_centre(rest.data() + at);
    taken_ += block.count;
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud;
    cloud.sh_degree = sh_degree();
    cloud.position.resize(3 * block.count);
    cloud.log_scale.resize(3 * block.count);
    cloud.rotation.resize(4 * block.count);
    cloud.opacity.resize(block.count);
    cloud.sh.resize(block.count * sh_width());
    const Section& section = header_.sections[load<size_t>(block.bytes.data())];
    const size_t row = header_.row_bytes(section), centre = centre_bytes();
    const Bytes rows = Bytes(block.bytes).subspan(sizeof section_);
    const Bytes centres = rows.subspan(block.count * row);
    for (size_t i = 0; i < block.count; ++i)
      decode_row(section, rows.subspan(i * row, row), centres.subspan(i * centre, centre), i,
                 cloud);
    return cloud;
  }

 private:
  size_t centre_bytes() const { return header_.compressed() ? kCentre : 0; }
  size_t sh_width() const { return static_cast<size_t>(sh_coefficients(sh_degree())) * 3; }

  // Stands at the next row that is used, if there is one; else at the end of the file.
  bool find_rows() {
    for (;; ++section_, taken_ = 0, in_section_ = false) {
      if (section_ == header_.sections.size()) break;
      const Section& section = header_.sections[section_];
      if (!in_section_) buckets_.read(input_, section);
      in_section_ = true;
      if (taken_ < section.count) return true;
      skip_unused(section);
    }
    if (!input_.peek(1).empty())
      refuse(name(), input_.offset(), "sections", "more bytes", "the end of the file");
    return false;
  }

  void skip_unused(const Section& section) {
    const uint64_t unused = (section.rows - taken_) * header_.row_bytes(section);
    const uint64_t found = input_.skip(unused);
    if (found != unused)
      refuse(name(), input_.offset(), "unused rows", std::to_string(found) + " bytes",
             std::to_string(unused) + " bytes");
  }

  void read_rows(std::span<std::byte> into, const Section& section) {
    const size_t got = input_.read(into), row = header_.row_bytes(section);
    if (got != into.size())
      refuse(name(), input_.offset(), "rows", std::to_string(taken_ * row + got) + " bytes",
             std::to_string(section.count * row) + " bytes");
  }

  void copy_centre(std::byte* into) {
    const std::byte* centre = buckets_.next();
    if (!centre)
      refuse(name(), input_.offset(), "buckets", "fewer Gaussians in all",
             std::to_string(header_.sections[section_].count));
    std::memcpy(into, centre, kCentre);
  }

  void decode_row(const Section& section, Bytes row, Bytes centre, size_t i,
                  GaussianCloud& cloud) const {
    const Level level = header_.level;
    const size_t each = level == Level::floats ? 4 : 2;
    for (size_t k = 0; k < 3; ++k) {
      cloud.position[3 * i + k] = position(section, row, centre, k);
      cloud.log_scale[3 * i + k] = log_of_scale(real(level, row.subspan(3 * each), k));
    }
    for (size_t k = 0; k < 4; ++k)
      cloud.rotation[4 * i + k] = real(level, row.subspan(6 * each), k);
    const Bytes colour = row.subspan(10 * each);
    float* sh = &cloud.sh[i * sh_width()];
    for (size_t k = 0; k < 3; ++k) sh[k] = sh_of_colour(integer(colour[k]) / 255.0);
    cloud.opacity[i] = logit_of_byte(integer(colour[3]));
    const size_t rest = 3 * (static_cast<size_t>(sh_coefficients(section.sh_degree)) - 1);
    for (size_t k = 0; k < rest; ++k) sh[3 + place_of(k)] = coefficient(colour.subspan(4), k);
  }

  float position(const Section& section, Bytes row, Bytes centre, size_t axis) const {
    if (!header_.compressed()) return load<float>(&row[4 * axis]);
    const double code = load<uint16_t>(&row[2 * axis]), steps = section.position_steps;
    const double half = static_cast<double>(section.bucket_width) / 2;
    return static_cast<float>(static_cast<double>(load<float>(&centre[4 * axis])) +
                              (code - steps) / steps * half);
  }

  float coefficient(Bytes from, size_t k) const {
    if (header_.level != Level::halves_and_bytes) return real(header_.level, from, k);
    return between(header_.sh_least, header_.sh_most, std::to_integer<uint32_t>(from[k]), 255);
  }

  std::unique_ptr<ByteReader> reader_;
  PeekReader input_;
  Header header_;
  Buckets buckets_;
  size_t section_ = 0;
  bool in_section_ = false;  // its buckets were read
  uint64_t taken_ = 0;       // Gaussians of the section
};

}  // namespace
}  // namespace voyager::ksplat

namespace voyager {

std::unique_ptr<BlockReader> open_ksplat_blocks(std::unique_ptr<ByteReader> reader) {
  return std::make_unique<ksplat::Reader>(std::move(reader));
}

}  // namespace voyager
