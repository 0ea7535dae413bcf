// A .spz keeps each attribute apart, over all Gaussians: one place in the file for
// each brings them together block by block.
#include <algorithm>
#include <array>
#include <limits>

#include "runtime/scene/import/decompress.h"
#include "runtime/scene/import/placed_blocks.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/spz_blocks.h"
#include "runtime/scene/import/spz_decode.h"

namespace voyager {
namespace {

using spz::Attribute;

// Plain bytes of one attribute, from the first Gaussian on.
class AttributeStream {
 public:
  // Of the first attribute.
  explicit AttributeStream(const ByteSource& source)
      : reader_(read_source(source)), input_(*reader_) {
    const std::span<const std::byte> first = input_.peek(1);
    if (!first.empty() && first[0] == std::byte{0x1f}) {
      auto gzip = std::make_unique<GzipReader>(input_);
      gzip_ = gzip.get();
      plain_ = std::move(gzip);
      header_ = spz::read_header(*plain_, spz::kNewestPlanar);
      spz::check_count(input_, header_, true);
      return;
    }
    header_ = spz::read_header(input_, spz::kNewest);
    spz::check_count(input_, header_, false);
    if (header_.version != spz::kNewest) return;
    sizes_ = spz::read_stream_table(input_, header_).compressed;
    open_stream();
  }

  // Of the attribute after that of `before`, which has read nothing of its own yet.
  AttributeStream(const ByteSource& source, const AttributeStream& before)
      : reader_(read_source(source)),
        input_(*reader_),
        header_(before.header_),
        sizes_(before.sizes_),
        attribute_(before.attribute_) {
    input_.skip(before.input_.offset());
    if (before.gzip_) {
      // What comes before it is decompressed once, and not once for each attribute.
      auto gzip = std::make_unique<GzipReader>(input_, *before.gzip_);
      gzip_ = gzip.get();
      plain_ = std::move(gzip);
    }
    if (header_.version == spz::kNewest)
      input_.skip(sizes_[attribute_]);
    else
      PeekReader(plain()).skip(header_.bytes_of_all(static_cast<Attribute>(attribute_)));
    ++attribute_;
    if (header_.version == spz::kNewest) open_stream();
  }

  const spz::Header& header() const { return header_; }

  void read(std::span<std::byte> into, const char* what) {
    ByteReader& bytes = plain();
    const size_t got = bytes.read(into);
    if (got != into.size())
      refuse(bytes.name(), bytes.offset(), what, std::to_string(got) + " bytes",
             std::to_string(into.size()) + " bytes of a block");
  }

  // After the last byte of the attribute: that nothing follows which should not.
  void finish(bool last) {
    if (plain_ && header_.version == spz::kNewest) return plain_->finish();
    if (!last) return;
    spz::read_last_extensions(plain(), header_);
    if (plain_) plain_->finish();
    if (!input_.peek(1).empty())
      refuse(input_.name(), input_.offset(), "length", "more bytes", "the end of the file");
  }

 private:
  void open_stream() {
    plain_ = std::make_unique<ZstdReader>(input_, sizes_[attribute_],
                                          header_.bytes_of_all(static_cast<Attribute>(attribute_)));
  }
  ByteReader& plain() { return plain_ ? static_cast<ByteReader&>(*plain_) : input_; }

  std::unique_ptr<ByteReader> reader_;
  PeekReader input_;
  std::unique_ptr<Decompressor> plain_;
  const GzipReader* gzip_ = nullptr;  // plain_, where it is one
  spz::Header header_;
  std::array<uint64_t, spz::kAttributes> sizes_{};  // of version 4's streams
  size_t attribute_ = 0;
};

class SpzReader final : public BlockReader {
 public:
  SpzReader(std::shared_ptr<const ByteSource> source, const HalfTurn& to_inria)
      : source_(std::move(source)) {
    streams_.push_back(std::make_unique<AttributeStream>(*source_));
    header_ = streams_.front()->header();
    header_.to_inria = to_inria;
    for (int i = 1; i < header_.attributes(); ++i)
      streams_.push_back(std::make_unique<AttributeStream>(*source_, *streams_.back()));
  }

  const std::string& name() const override { return source_->name(); }
  uint64_t count() const override { return header_.count; }
  int sh_degree() const override { return header_.sh_degree; }
  NativeScale native() const override { return header_.native(); }

  RawBlock next(size_t most) override {
    RawBlock block;
    block.count = std::min<size_t>(most, header_.count - taken_);
    if (block.count == 0) {
      for (const auto& stream : streams_) stream->finish(stream == streams_.back());
      streams_.clear();
      return block;
    }
    block.bytes.resize(bytes_before(header_.attributes(), block.count));
    for (int i = 0; i < header_.attributes(); ++i) {
      const size_t begin = bytes_before(i, block.count), end = bytes_before(i + 1, block.count);
      const auto index = static_cast<size_t>(i);
      streams_[index]->read(std::span(block.bytes).subspan(begin, end - begin),
                            spz::kAttributeName[index]);
    }
    taken_ += static_cast<uint32_t>(block.count);
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud;
    cloud.sh_degree = header_.sh_degree;
    cloud.native = header_.native();
    cloud.position.resize(3 * block.count);
    cloud.log_scale.resize(3 * block.count);
    cloud.rotation.resize(4 * block.count);
    cloud.opacity.resize(block.count);
    cloud.sh.resize(block.count * static_cast<size_t>(cloud.coefficients()) * 3);
    for (int i = 0; i < header_.attributes(); ++i) {
      const size_t begin = bytes_before(i, block.count), end = bytes_before(i + 1, block.count);
      spz::decode(header_, static_cast<Attribute>(i),
                  std::span(block.bytes).subspan(begin, end - begin), 0, cloud);
    }
    return cloud;
  }

 private:
  // Of a block of so many Gaussians, where an attribute starts.
  size_t bytes_before(int attribute, size_t gaussians) const {
    size_t bytes = 0;
    for (int i = 0; i < attribute; ++i)
      bytes += header_.bytes_of(static_cast<Attribute>(i)) * gaussians;
    return bytes;
  }

  std::shared_ptr<const ByteSource> source_;
  std::vector<std::unique_ptr<AttributeStream>> streams_;
  spz::Header header_;
  uint32_t taken_ = 0;  // Gaussians
};

}  // namespace

std::unique_ptr<BlockReader> spz::open_in_axes(std::shared_ptr<const ByteSource> source,
                                               const HalfTurn& to_inria) {
  return std::make_unique<SpzReader>(std::move(source), to_inria);
}

spz::Bounds spz::bounds_of_positions(const ByteSource& source) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr uint64_t kAtOnce = 4096;
  Bounds bounds{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  AttributeStream stream(source);
  Header header = stream.header();
  header.to_inria = kNoTurn;
  GaussianCloud cloud;
  std::vector<std::byte> codes;
  for (uint64_t left = header.count; left > 0;) {
    const auto count = static_cast<size_t>(std::min(left, kAtOnce));
    codes.resize(count * header.bytes_of(kPositions));
    cloud.position.resize(3 * count);
    stream.read(codes, kAttributeName[kPositions]);
    decode(header, kPositions, codes, 0, cloud);
    for (size_t i = 0; i < 3 * count; ++i) {
      bounds.least[i % 3] = std::min(bounds.least[i % 3], double{cloud.position[i]});
      bounds.most[i % 3] = std::max(bounds.most[i % 3], double{cloud.position[i]});
    }
    left -= count;
  }
  return bounds;
}

std::vector<std::string> spz::left_out_of(const Announcement& found) {
  std::vector<std::string> unread = found.extensions.unread;
  if (found.header.stored_sh_degree > found.header.sh_degree)
    unread.insert(unread.begin(),
                  "spherical harmonics of degree " + std::to_string(found.header.stored_sh_degree));
  return unread;
}

std::unique_ptr<BlockReader> open_spz_blocks(std::shared_ptr<const ByteSource> source) {
  const spz::Extensions extensions = spz::read_announcement(*source).extensions;
  const std::string what = source->name() + ": coordinate system";
  std::unique_ptr<BlockReader> reader = spz::open_in_axes(std::move(source), spz::kToInria);
  return extensions.turns() ? place_blocks(std::move(reader), extensions.axes, {}, what)
                            : std::move(reader);
}

std::vector<std::string> left_out_of_spz(const ByteSource& source) {
  return spz::left_out_of(spz::read_announcement(source));
}

}  // namespace voyager
