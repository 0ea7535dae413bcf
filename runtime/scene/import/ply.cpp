#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/import/ply_header.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

using ply::Element;
using ply::Property;
using ply::Type;

constexpr size_t kBlockBytes = 256 * 1024;  // stays in cache while it is taken apart by columns

// One property of the rows and where its words go.
struct Column {
  const Property* property;
  std::pmr::vector<float>* into;
  size_t width, at;  // word `at` of every `width`
  double minus;      // taken off doubles before they are rounded
};

template <class T>
T load(const std::byte* from, bool big_endian) {
  std::byte bytes[sizeof(T)];
  std::memcpy(bytes, from, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big))
    std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

template <class Take>
void with_type(Type type, const Take& take) {
  switch (type) {
    case Type::i8:
      return take(int8_t{});
    case Type::u8:
      return take(uint8_t{});
    case Type::i16:
      return take(int16_t{});
    case Type::u16:
      return take(uint16_t{});
    case Type::i32:
      return take(int32_t{});
    case Type::u32:
      return take(uint32_t{});
    case Type::f32:
      return take(float{});
    case Type::f64:
      return take(double{});
  }
}

// Bytes of an element; refuses a count whose product with the stride overflows.
uint64_t bytes_of(const PeekReader& input, const Element& element) {
  uint64_t bytes = 0;
  if (__builtin_mul_overflow(element.count, uint64_t{element.stride}, &bytes) || bytes > INT64_MAX)
    refuse(input.name(), input.offset(), "element " + element.name,
           std::to_string(element.count) + " rows of " + std::to_string(element.stride) + " bytes",
           "less than 2^63 bytes in all");
  return bytes;
}

class PlyImport {
 public:
  PlyImport(ByteReader& reader, const ImportOptions& options)
      : input_(reader), options_(options), cloud_(options.memory) {}

  GaussianCloud run() {
    header_ = ply::read_header(input_);
    find_columns();
    check_length();
    for (size_t i = 0; i < header_.vertex; ++i) skip(header_.elements[i]);
    read_vertices();
    skip_the_rest();
    return std::move(cloud_);
  }

 private:
  const Element& vertex() const { return header_.elements[header_.vertex]; }

  void add_column(const std::string& name, std::pmr::vector<float>& into, size_t width, size_t at) {
    const Property* property = vertex().find(name);
    if (!property)
      refuse(input_.name(), input_.offset(), "element vertex", "no property " + name,
             "x y z f_dc_0..2 opacity scale_0..2 rot_0..3, and f_rest_* without gaps");
    columns_.push_back({property, &into, width, at, 0.0});
  }

  void find_columns() {
    const auto is_rest = [](const Property& p) { return p.name.rfind("f_rest_", 0) == 0; };
    const auto rest =
        std::count_if(vertex().properties.begin(), vertex().properties.end(), is_rest);
    while (cloud_.sh_degree <= kMaxShDegree && 3 * (cloud_.coefficients() - 1) != rest)
      ++cloud_.sh_degree;
    if (cloud_.sh_degree > kMaxShDegree)
      refuse(input_.name(), input_.offset(), "properties f_rest_*", std::to_string(rest),
             "0, 9, 24 or 45 (SH degree 0 to 3)");
    const size_t coefficients = static_cast<size_t>(cloud_.coefficients());
    for (size_t i = 0; i < 3; ++i) add_column(std::string(1, "xyz"[i]), cloud_.position, 3, i);
    for (size_t i = 0; i < 3; ++i) add_column("scale_" + std::to_string(i), cloud_.log_scale, 3, i);
    for (size_t i = 0; i < 4; ++i) add_column("rot_" + std::to_string(i), cloud_.rotation, 4, i);
    add_column("opacity", cloud_.opacity, 1, 0);
    for (size_t i = 0; i < 3; ++i)
      add_column("f_dc_" + std::to_string(i), cloud_.sh, coefficients * 3, i);
    for (size_t i = 0; i < 3 * (coefficients - 1); ++i) {
      const size_t channel = i / (coefficients - 1), k = 1 + i % (coefficients - 1);
      add_column("f_rest_" + std::to_string(i), cloud_.sh, coefficients * 3, 3 * k + channel);
    }
  }

  // Where the length of the stream is known, the header is held to it before
  // anything is allocated; then the whole cloud is reserved at once.
  void check_length() {
    uint64_t expected = 0;
    bool open_ended = false;
    for (const Element& element : header_.elements) {
      open_ended = open_ended || element.has_list;
      if (open_ended) continue;
      if (__builtin_add_overflow(expected, bytes_of(input_, element), &expected))
        refuse(input_.name(), input_.offset(), "elements", "more than 2^64 bytes", "less");
    }
    const std::optional<uint64_t> found = input_.remaining();
    if (!found) return;
    if (*found < expected || (*found > expected && !open_ended))
      refuse(input_.name(), input_.offset(), "elements", std::to_string(*found) + " bytes",
             std::to_string(expected) + " bytes (vertex: " + std::to_string(vertex().count) +
                 " rows of " + std::to_string(vertex().stride) + ")");
    reserve(vertex().count, vertex().count);
  }

  void reserve(uint64_t gaussians, uint64_t announced) {
    for (const Column& column : columns_)
      reserve_for(*column.into, gaussians, announced, column.width);
  }

  void resize(uint64_t gaussians) {
    for (const Column& column : columns_)
      column.into->resize(static_cast<size_t>(gaussians) * column.width);
  }

  void skip(const Element& element) {
    const uint64_t expected = bytes_of(input_, element), found = input_.skip(expected);
    if (found != expected)
      refuse(input_.name(), input_.offset(), "element " + element.name,
             std::to_string(found) + " bytes", std::to_string(expected) + " bytes");
  }

  void skip_the_rest() {
    for (size_t i = header_.vertex + 1; i < header_.elements.size(); ++i) {
      if (header_.elements[i].has_list) return;
      skip(header_.elements[i]);
    }
    if (!input_.peek(1).empty())
      refuse(input_.name(), input_.offset(), "elements", "more bytes",
             "the end of the file after the last element");
  }

  void read_vertices() {
    const uint64_t count = vertex().count;
    const size_t stride = vertex().stride, rows = std::max<size_t>(1, kBlockBytes / stride);
    std::vector<std::byte> block(rows * stride);
    for (uint64_t first = 0; first < count;) {
      const size_t n = static_cast<size_t>(std::min<uint64_t>(rows, count - first));
      const size_t got = input_.read(std::span(block).first(n * stride));
      if (got != n * stride)
        refuse(input_.name(), input_.offset(), "element vertex",
               std::to_string(first * stride + got) + " bytes",
               std::to_string(count * stride) + " bytes (" + std::to_string(count) + " rows of " +
                   std::to_string(stride) + ")");
      if (first == 0) choose_origin(block.data(), n);
      reserve(first + n, count);
      resize(first + n);
      for (const Column& column : columns_) take(column, block.data(), first, n);
      first += n;
      report(options_.progress, "reading", first, count);
    }
  }

  // Only doubles can say where on a planet the scene lies to better than a
  // millimetre; words of 32 bits are kept as they are.
  void choose_origin(const std::byte* block, size_t rows) {
    for (size_t row = 0; row < rows; ++row) {
      double world[3] = {0.0, 0.0, 0.0};
      for (size_t axis = 0; axis < 3; ++axis) {
        const Property& p = *columns_[axis].property;
        if (p.type == Type::f64)
          world[axis] = load<double>(block + row * vertex().stride + p.offset, header_.big_endian);
      }
      if (!std::all_of(world, world + 3, [](double v) { return std::fabs(v) < kMaxCoordinate; }))
        continue;
      for (size_t axis = 0; axis < 3; ++axis)
        if (std::fabs(world[axis]) > kOriginReach)
          cloud_.origin[axis] = std::round(world[axis] / kOriginStep) * kOriginStep;
      break;
    }
    for (size_t axis = 0; axis < 3; ++axis) columns_[axis].minus = cloud_.origin[axis];
  }

  void take(const Column& column, const std::byte* block, uint64_t first, size_t rows) const {
    const std::byte* from = block + column.property->offset;
    float* into = column.into->data() + static_cast<size_t>(first) * column.width + column.at;
    with_type(column.property->type, [&]<class T>(T) {
      for (size_t row = 0; row < rows; ++row) {
        const T value = load<T>(from + row * vertex().stride, header_.big_endian);
        if constexpr (std::is_same_v<T, double>)
          into[row * column.width] = static_cast<float>(value - column.minus);
        else
          into[row * column.width] = static_cast<float>(value);
      }
    });
  }

  PeekReader input_;
  const ImportOptions& options_;
  GaussianCloud cloud_;
  ply::Header header_;
  std::vector<Column> columns_;  // x, y, z first
};

}  // namespace

GaussianCloud import_ply(ByteReader& reader, const ImportOptions& options) {
  return PlyImport(reader, options).run();
}

}  // namespace voyager
