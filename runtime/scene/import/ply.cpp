#include <algorithm>
#include <cmath>

#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/compressed_ply.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/import_blocks.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/import/ply_elements.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/shared_reader.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/transform.h"

namespace voyager {
namespace {

using ply::Element;
using ply::Property;
using ply::Type;

constexpr size_t kRowBytes = 256 * 1024;  // stays in cache while it is taken apart by columns

// One property of the rows and where its words go.
struct Column {
  const Property* property;
  std::pmr::vector<float> GaussianCloud::*into;
  size_t width, at;  // word `at` of every `width`
};

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

class PlyReader final : public BlockReader {
 public:
  explicit PlyReader(std::unique_ptr<ply::Input> opened)
      : opened_(std::move(opened)), input_(opened_->bytes), header_(opened_->header) {
    find_columns();
    ply::check_length(input_, header_);
    for (size_t i = 0; i < header_.vertex; ++i) ply::skip(input_, header_.elements[i]);
    choose_origin();
  }

  const std::string& name() const override { return input_.name(); }
  uint64_t count() const override { return vertex().count; }
  int sh_degree() const override { return sh_degree_; }
  NativeScale native() const override { return header_.native; }
  std::array<double, 3> origin() const override { return origin_; }

  RawBlock next(size_t most) override {
    RawBlock block;
    next(most, block);
    return block;
  }

  // The same in place of another block, whose memory is used again.
  void next(size_t most, RawBlock& block) {
    const size_t stride = vertex().stride;
    const uint64_t rows = std::min<uint64_t>(most, std::max<size_t>(1, kMostBlockBytes / stride));
    block.count = static_cast<size_t>(std::min(rows, count() - taken_));
    if (block.count == 0) return ply::skip_the_rest(input_, header_, header_.vertex + 1);
    block.bytes.resize(block.count * stride);
    const size_t got = input_.read(block.bytes);
    if (got != block.bytes.size())
      refuse(input_.name(), input_.offset(), "element vertex",
             std::to_string(taken_ * stride + got) + " bytes",
             std::to_string(count() * stride) + " bytes (" + std::to_string(count()) + " rows of " +
                 std::to_string(stride) + ")");
    taken_ += block.count;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud;
    cloud.sh_degree = sh_degree_;
    cloud.native = header_.native;
    resize(cloud, block.count);
    store(block, 0, cloud);
    return cloud;
  }

  // The rows that stay in cache while they are taken apart by columns.
  size_t rows_at_once() const { return std::max<size_t>(1, kRowBytes / vertex().stride); }

  void reserve(GaussianCloud& cloud, uint64_t gaussians) const {
    for (const Column& column : columns_)
      reserve_for(cloud.*column.into, gaussians, count(), column.width);
  }

  void resize(GaussianCloud& cloud, size_t gaussians) const {
    for (const Column& column : columns_) (cloud.*column.into).resize(gaussians * column.width);
  }

  // The cloud's arrays already hold first + block.count Gaussians.
  void store(const RawBlock& block, size_t first, GaussianCloud& cloud) const {
    cloud.origin = origin_;
    const size_t step = rows_at_once();
    for (size_t begin = 0; begin < block.count; begin += step)
      for (size_t i = 0; i < columns_.size(); ++i)
        take(columns_[i], i < 3 ? origin_[i] : 0.0, block.bytes.data() + begin * vertex().stride,
             std::min(step, block.count - begin), cloud, first + begin);
  }

 private:
  const Element& vertex() const { return header_.elements[header_.vertex]; }

  void add_column(const std::string& name, std::pmr::vector<float> GaussianCloud::*into,
                  size_t width, size_t at) {
    const Property* property = vertex().find(name);
    if (!property)
      refuse(input_.name(), input_.offset(), "element vertex", "no property " + name,
             "x y z f_dc_0..2 opacity scale_0..2 rot_0..3, and f_rest_* without gaps");
    columns_.push_back({property, into, width, at});
  }

  // 2DGS trains flat ellipses: their files lack the third scale alone.
  void refuse_2dgs() const {
    if (vertex().find("scale_0") && vertex().find("scale_1") && !vertex().find("scale_2"))
      refuse(input_.name(), input_.offset(), "element vertex",
             "scale_0 and scale_1 without scale_2: a file of 2DGS, which is not supported",
             "one of 3DGS, with scale_2");
  }

  void find_columns() {
    refuse_2dgs();
    const auto is_rest = [](const Property& p) { return p.name.rfind("f_rest_", 0) == 0; };
    const auto rest =
        std::count_if(vertex().properties.begin(), vertex().properties.end(), is_rest);
    while (sh_degree_ <= kMaxShDegree && 3 * (sh_coefficients(sh_degree_) - 1) != rest)
      ++sh_degree_;
    if (sh_degree_ > kMaxShDegree)
      refuse(input_.name(), input_.offset(), "properties f_rest_*", std::to_string(rest),
             "0, 9, 24 or 45 (SH degree 0 to 3)");
    using Cloud = GaussianCloud;
    const size_t coefficients = static_cast<size_t>(sh_coefficients(sh_degree_));
    for (size_t i = 0; i < 3; ++i) add_column(std::string(1, "xyz"[i]), &Cloud::position, 3, i);
    for (size_t i = 0; i < 3; ++i)
      add_column("scale_" + std::to_string(i), &Cloud::log_scale, 3, i);
    for (size_t i = 0; i < 4; ++i) add_column("rot_" + std::to_string(i), &Cloud::rotation, 4, i);
    add_column("opacity", &Cloud::opacity, 1, 0);
    for (size_t i = 0; i < 3; ++i)
      add_column("f_dc_" + std::to_string(i), &Cloud::sh, coefficients * 3, i);
    for (size_t i = 0; i < 3 * (coefficients - 1); ++i) {
      const size_t channel = i / (coefficients - 1), k = 1 + i % (coefficients - 1);
      add_column("f_rest_" + std::to_string(i), &Cloud::sh, coefficients * 3, 3 * k + channel);
    }
  }

  // Only doubles can say where on a planet the scene lies to better than a
  // millimetre; words of 32 bits are kept as they are. The same rows are looked at whatever the
  // size of blocks will be.
  void choose_origin() {
    const uint64_t rows = std::min<uint64_t>(count(), rows_at_once());
    const std::span<const std::byte> block =
        input_.peek(static_cast<size_t>(rows) * vertex().stride);
    for (size_t row = 0; row < block.size() / vertex().stride; ++row) {
      double world[3] = {0.0, 0.0, 0.0};
      for (size_t axis = 0; axis < 3; ++axis) {
        const Property& p = *columns_[axis].property;
        if (p.type == Type::f64)
          world[axis] =
              load<double>(block.data() + row * vertex().stride + p.offset, header_.big_endian);
      }
      if (!std::all_of(world, world + 3, [](double v) { return std::fabs(v) < kMaxCoordinate; }))
        continue;
      origin_ = origin_near({world[0], world[1], world[2]});
      break;
    }
  }

  // `minus` is taken off doubles before they are rounded.
  void take(const Column& column, double minus, const std::byte* block, size_t rows,
            GaussianCloud& cloud, size_t first) const {
    const std::byte* from = block + column.property->offset;
    float* into = (cloud.*column.into).data() + first * column.width + column.at;
    with_type(column.property->type, [&]<class T>(T) {
      for (size_t row = 0; row < rows; ++row) {
        const T value = load<T>(from + row * vertex().stride, header_.big_endian);
        if constexpr (std::is_same_v<T, double>)
          into[row * column.width] = static_cast<float>(value - minus);
        else
          into[row * column.width] = static_cast<float>(value);
      }
    });
  }

  std::unique_ptr<ply::Input> opened_;
  PeekReader& input_;
  const ply::Header& header_;
  int sh_degree_ = 0;
  std::array<double, 3> origin_{0, 0, 0};
  std::vector<Column> columns_;  // x, y, z first
  uint64_t taken_ = 0;           // Gaussians
};

}  // namespace

GaussianCloud import_ply(ByteReader& reader, const ImportOptions& options) {
  auto input = std::make_unique<ply::Input>(reader);
  if (ply::is_compressed(input->header))
    return import_blocks(*ply::open_compressed(std::move(input), nullptr), options);
  PlyReader rows(std::move(input));
  GaussianCloud cloud(options.memory);
  cloud.sh_degree = rows.sh_degree();
  cloud.native = rows.native();
  RawBlock block;
  for (uint64_t done = 0;;) {
    rows.next(rows.rows_at_once(), block);
    if (block.count == 0) return cloud;
    rows.reserve(cloud, done + block.count);
    rows.resize(cloud, done + block.count);
    rows.store(block, done, cloud);
    done += block.count;
    report(options.progress, "reading", done, rows.count());
  }
}

std::unique_ptr<BlockReader> open_ply_blocks(std::unique_ptr<ByteReader> reader) {
  auto input = std::make_unique<ply::Input>(std::move(reader));
  if (ply::is_compressed(input->header)) return ply::open_compressed(std::move(input), nullptr);
  return std::make_unique<PlyReader>(std::move(input));
}

std::unique_ptr<BlockReader> open_ply_blocks(std::shared_ptr<const ByteSource> source) {
  auto input = std::make_unique<ply::Input>(std::make_unique<SharedReader>(source));
  if (ply::is_compressed(input->header))
    return ply::open_compressed(std::move(input),
                                std::make_unique<SharedReader>(std::move(source)));
  return std::make_unique<PlyReader>(std::move(input));
}

}  // namespace voyager
