#include "runtime/scene/import/compressed_ply.h"

#include <algorithm>
#include <array>
#include <optional>

#include "runtime/math/byte_code.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::ply {
namespace {

constexpr uint64_t kChunkGaussians = 256;
constexpr size_t kIndexBytes = sizeof(uint64_t);

enum Word { kPosition, kScale, kColour, kRotation, kWords };
constexpr std::array<const char*, kWords> kWordName = {"packed_position", "packed_scale",
                                                       "packed_color", "packed_rotation"};
// Of the first three, between which values their codes run in a chunk.
constexpr std::array<std::array<const char*, 3>, kRotation> kAxes = {
    {{"x", "y", "z"}, {"scale_x", "scale_y", "scale_z"}, {"r", "g", "b"}}};

struct Range {
  const Property *low = nullptr, *high = nullptr;  // null: 0 to 1
};

uint32_t bits(uint32_t word, int shift, int count) {
  return word >> shift & ((1u << count) - 1);
}

float sh_of_code(int code) {
  const float share = code == 0     ? 0.0f
                      : code == 255 ? 1.0f
                                    : (static_cast<float>(code) + 0.5f) / 256;
  return (share - 0.5f) * 8.0f;
}

// Two bits say which component is the largest; the others follow in the order w, x, y, z.
void decode_rotation(uint32_t word, float* wxyz) {
  SmallestThree three{static_cast<int>(word >> 30), {}};
  for (int i = 0; i < 3; ++i)
    three.others[static_cast<size_t>(i)] =
        between(-kSqrtHalf, kSqrtHalf, bits(word, 20 - 10 * i, 10), 1023);
  const std::array<float, 4> q = quaternion_of(three);
  std::copy(q.begin(), q.end(), wxyz);
}

class CompressedReader final : public BlockReader {
 public:
  CompressedReader(std::unique_ptr<Input> opened, std::unique_ptr<ByteReader> again)
      : opened_(std::move(opened)), again_(std::move(again)), header_(opened_->header) {
    find_elements();
    find_words();
    find_sh();
    check_length(opened_->bytes, header_);
    const uint64_t start = opened_->bytes.offset();
    chunks_ = read_all(opened_->bytes, header_.elements[0]);
    rows_ = sh_rows_ = &opened_->bytes;
    if (sh_degree_ == 0) return;
    if (again_)
      find_sh_again(start + chunks_.size() + bytes_of(opened_->bytes, vertex()));
    else
      hold_vertices();
  }

  const std::string& name() const override { return opened_->bytes.name(); }
  uint64_t count() const override { return vertex().count; }
  int sh_degree() const override { return sh_degree_; }
  NativeScale native() const override { return header_.native; }

  // A block is the index of its first Gaussian, the rows of the vertices and those of the SH bands.
  RawBlock next(size_t most) override {
    const size_t width = vertex().stride + sh_stride();
    const uint64_t rows = std::min<uint64_t>(most, std::max<size_t>(1, kMostBlockBytes / width));
    RawBlock block;
    block.count = static_cast<size_t>(std::min(rows, count() - taken_));
    if (block.count == 0) {
      skip_the_rest(*sh_rows_, header_, header_.elements.size());
      return block;
    }
    block.bytes.resize(kIndexBytes + block.count * width);
    std::memcpy(block.bytes.data(), &taken_, kIndexBytes);
    const auto rest = std::span(block.bytes).subspan(kIndexBytes);
    const size_t split = block.count * vertex().stride;
    read(*rows_, vertex(), rest.first(split));
    if (sh_degree_ > 0) read(*sh_rows_, header_.elements[2], rest.subspan(split));
    taken_ += block.count;
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud;
    cloud.sh_degree = sh_degree_;
    cloud.native = header_.native;
    cloud.position.resize(3 * block.count);
    cloud.log_scale.resize(3 * block.count);
    cloud.rotation.resize(4 * block.count);
    cloud.opacity.resize(block.count);
    cloud.sh.resize(block.count * sh_width());
    uint64_t first = 0;
    std::memcpy(&first, block.bytes.data(), kIndexBytes);
    const std::byte* vertices = block.bytes.data() + kIndexBytes;
    const std::byte* coefficients = vertices + block.count * vertex().stride;
    for (size_t i = 0; i < block.count; ++i) {
      decode_words(vertices + i * vertex().stride, first + i, i, cloud);
      decode_sh(coefficients + i * sh_stride(), &cloud.sh[i * sh_width()]);
    }
    return cloud;
  }

 private:
  const Element& chunk() const { return header_.elements[0]; }
  const Element& vertex() const { return header_.elements[1]; }
  size_t sh_stride() const { return sh_degree_ > 0 ? header_.elements[2].stride : 0; }
  size_t sh_width() const { return static_cast<size_t>(sh_coefficients(sh_degree_)) * 3; }

  [[noreturn]] void refuse_header(const std::string& field, const std::string& found,
                                  const std::string& expected) const {
    refuse(name(), opened_->bytes.offset(), field, found, expected);
  }

  void find_elements() const {
    const auto& elements = header_.elements;
    std::string found;
    for (const Element& element : elements)
      found += element.name + (element.has_list ? ", with a list, " : " ");
    if (found != "chunk vertex " && found != "chunk vertex sh ")
      refuse_header("elements", found, "chunk, vertex and perhaps sh, in this order");
    const uint64_t chunks = count() / kChunkGaussians + (count() % kChunkGaussians == 0 ? 0 : 1);
    if (chunk().count != chunks)
      refuse_header("element chunk", std::to_string(chunk().count) + " rows",
                    std::to_string(chunks) + " rows, one for each 256 vertices");
    if (elements.size() == 3 && elements[2].count != count())
      refuse_header("element sh", std::to_string(elements[2].count) + " rows",
                    std::to_string(count()) + " rows, one for each vertex");
  }

  const Property* need(const Element& element, const std::string& property, Type type,
                       const char* type_name) const {
    const Property* found = element.find(property);
    if (!found || found->type != type)
      refuse_header("element " + element.name,
                    (found ? "another type of " : "no property ") + property,
                    std::string(type_name) + " " + property);
    return found;
  }

  void find_words() {
    for (size_t word = 0; word < kWords; ++word)
      words_[word] = need(vertex(), kWordName[word], Type::u32, "uint");
    for (size_t word = 0; word < kRotation; ++word) {
      if (word == kColour && !chunk().find("min_r") && !chunk().find("max_r")) continue;
      for (size_t axis = 0; axis < 3; ++axis)
        for (const auto& [prefix, bound] :
             {std::pair("min_", &Range::low), std::pair("max_", &Range::high)})
          ranges_[word][axis].*bound =
              need(chunk(), std::string(prefix) + kAxes[word][axis], Type::f32, "float");
    }
  }

  void find_sh() {
    if (header_.elements.size() < 3) return;
    const Element& element = header_.elements[2];
    const size_t properties = element.properties.size();
    sh_degree_ = 1;
    while (sh_degree_ < kMaxShDegree && sh_width() - 3 < properties) ++sh_degree_;
    if (sh_width() - 3 != properties)
      refuse_header("element sh", std::to_string(properties) + " properties",
                    "9, 24 or 45 (SH degree 1 to 3)");
    for (size_t i = 0; i < properties; ++i)
      sh_.push_back(need(element, "f_rest_" + std::to_string(i), Type::u8, "uchar"));
  }

  // All rows of an element, in memory that is taken as they come.
  std::vector<std::byte> read_all(PeekReader& input, const Element& element) const {
    const uint64_t expected = bytes_of(input, element);
    std::vector<std::byte> bytes = read_as_they_come(input, expected);
    if (bytes.size() != expected) refuse_end(input, element, bytes.size());
    return bytes;
  }

  void read(PeekReader& input, const Element& element, std::span<std::byte> into) const {
    const size_t got = input.read(into);
    if (got != into.size()) refuse_end(input, element, taken_ * element.stride + got);
  }

  [[noreturn]] void refuse_end(const PeekReader& input, const Element& element,
                               uint64_t bytes) const {
    refuse(name(), input.offset(), "element " + element.name, std::to_string(bytes) + " bytes",
           std::to_string(element.count * element.stride) + " bytes (" +
               std::to_string(element.count) + " rows of " + std::to_string(element.stride) + ")");
  }

  void find_sh_again(uint64_t start) {
    sh_rows_ = &sh_input_.emplace(*again_);
    sh_rows_->skip(start);
  }

  void hold_vertices() {
    held_ = read_all(opened_->bytes, vertex());
    held_source_.emplace(name(), held_);
    held_reader_ = read_source(*held_source_);
    rows_ = &held_input_.emplace(*held_reader_);
  }

  float bound(const Property& property, uint64_t index) const {
    const size_t row = static_cast<size_t>(index / kChunkGaussians) * chunk().stride;
    return load<float>(chunks_.data() + row + property.offset, header_.big_endian);
  }

  float value(Word word, size_t axis, uint64_t index, uint32_t code, uint32_t most) const {
    const Range& range = ranges_[word][axis];
    if (!range.low) return between(0.0f, 1.0f, code, most);
    return between(bound(*range.low, index), bound(*range.high, index), code, most);
  }

  void decode_words(const std::byte* row, uint64_t index, size_t i, GaussianCloud& cloud) const {
    uint32_t code[kWords];
    for (size_t word = 0; word < kWords; ++word)
      code[word] = load<uint32_t>(row + words_[word]->offset, header_.big_endian);
    constexpr int kShift[3] = {21, 11, 0}, kBits[3] = {11, 10, 11};
    for (size_t axis = 0; axis < 3; ++axis) {
      const uint32_t most = (1u << kBits[axis]) - 1;
      const auto of = [&](Word word) {
        return value(word, axis, index, bits(code[word], kShift[axis], kBits[axis]), most);
      };
      cloud.position[3 * i + axis] = of(kPosition);
      cloud.log_scale[3 * i + axis] = of(kScale);
      const int shift = 24 - 8 * static_cast<int>(axis);
      cloud.sh[i * sh_width() + axis] =
          sh_of_colour(value(kColour, axis, index, bits(code[kColour], shift, 8), 255));
    }
    cloud.opacity[i] = logit_of_byte(static_cast<int>(code[kColour] & 255));
    decode_rotation(code[kRotation], &cloud.rotation[4 * i]);
  }

  // The file has all red coefficients, then all green, then all blue.
  void decode_sh(const std::byte* row, float* sh) const {
    const size_t each = sh_.size() / 3;
    for (size_t i = 0; i < sh_.size(); ++i)
      sh[3 * (1 + i % each) + i / each] = sh_of_code(std::to_integer<int>(row[sh_[i]->offset]));
  }

  std::unique_ptr<Input> opened_;
  std::unique_ptr<ByteReader> again_;
  const Header& header_;
  int sh_degree_ = 0;
  std::array<const Property*, kWords> words_{};
  std::array<std::array<Range, 3>, kRotation> ranges_;
  std::vector<const Property*> sh_;  // f_rest_0 first
  std::vector<std::byte> chunks_;    // all rows
  std::vector<std::byte> held_;      // rows of the vertices, where `again` is null
  std::optional<MemorySource> held_source_;
  std::unique_ptr<ByteReader> held_reader_;
  std::optional<PeekReader> held_input_, sh_input_;
  PeekReader *rows_ = nullptr, *sh_rows_ = nullptr;
  uint64_t taken_ = 0;  // Gaussians
};

}  // namespace

bool is_compressed(const Header& header) {
  return header.elements[header.vertex].find("packed_position") != nullptr;
}

std::unique_ptr<BlockReader> open_compressed(std::unique_ptr<Input> input,
                                             std::unique_ptr<ByteReader> again) {
  return std::make_unique<CompressedReader>(std::move(input), std::move(again));
}

}  // namespace voyager::ply
