#include "runtime/scene/import/importer.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "runtime/scene/append.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/peek_reader.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

struct Format {
  std::string_view first_bytes;
  GaussianCloud (*import)(ByteReader&, const ImportOptions&);
  // One of them: in blocks from any stream, or from a source alone. Without `import` a file is
  // only read from a source.
  std::unique_ptr<BlockReader> (*open_stream)(std::unique_ptr<ByteReader>);
  std::unique_ptr<BlockReader> (*open_source)(std::shared_ptr<const ByteSource>);
};
constexpr Format kFormats[] = {
    {"ply\n", import_ply, open_ply_blocks, nullptr},
    {"ply\r", import_ply, open_ply_blocks, nullptr},
    {"\x1f\x8b", import_spz, nullptr, open_spz_blocks},
    {"NGSP", import_spz, nullptr, open_spz_blocks},
    {"glTF", nullptr, nullptr, open_glb_blocks},
    {"{", nullptr, nullptr, open_json_blocks},
};
constexpr const char* kKnown =
    "the first bytes of INRIA .ply (\"ply\"), .spz (gzip 1f 8b, or \"NGSP\"), .glb (\"glTF\"), "
    ".gltf or a tileset.json (\"{\")";

// JSON may begin with white space.
std::span<const std::byte> without_space(std::span<const std::byte> bytes) {
  const auto is_space = [](std::byte b) {
    return b == std::byte{' '} || b == std::byte{'\t'} || b == std::byte{'\n'} ||
           b == std::byte{'\r'};
  };
  const auto rest = std::find_if_not(bytes.begin(), bytes.end(), is_space);
  return bytes.subspan(static_cast<size_t>(rest - bytes.begin()));
}

const Format* format_of(std::span<const std::byte> bytes) {
  const auto begins = [&](const Format& format) {
    const auto first = format.first_bytes == "{" ? without_space(bytes) : bytes;
    return first.size() >= format.first_bytes.size() &&
           std::equal(format.first_bytes.begin(), format.first_bytes.end(), first.begin(),
                      [](char a, std::byte b) { return static_cast<std::byte>(a) == b; });
  };
  const Format* found = std::find_if(std::begin(kFormats), std::end(kFormats), begins);
  return found == std::end(kFormats) ? nullptr : found;
}

std::string in_hex(std::span<const std::byte> bytes) {
  if (bytes.empty()) return "an empty input";
  std::string text = "the bytes";
  for (const std::byte b : bytes) {
    char digits[4];
    std::snprintf(digits, sizeof digits, " %02x", std::to_integer<unsigned>(b));
    text += digits;
  }
  return text;
}

// A stream from its first byte on, and what of it was looked at.
class OwnedPeek final : public ByteReader {
 public:
  explicit OwnedPeek(std::unique_ptr<ByteReader> inner) : inner_(std::move(inner)) {}
  const std::string& name() const override { return peek_.name(); }
  size_t read(std::span<std::byte> into) override { return peek_.read(into); }
  uint64_t skip(uint64_t count) override { return peek_.skip(count); }
  std::optional<uint64_t> remaining() const override { return peek_.remaining(); }
  uint64_t offset() const override { return peek_.offset(); }
  std::span<const std::byte> peek(size_t count) { return peek_.peek(count); }

 private:
  std::unique_ptr<ByteReader> inner_;
  PeekReader peek_{*inner_};
};

// A source's bytes as a stream that keeps it alive.
class SharedReader final : public ByteReader {
 public:
  explicit SharedReader(std::shared_ptr<const ByteSource> source)
      : source_(std::move(source)), reader_(read_source(*source_)) {}
  const std::string& name() const override { return reader_->name(); }
  size_t read(std::span<std::byte> into) override { return reader_->read(into); }
  uint64_t skip(uint64_t count) override { return reader_->skip(count); }
  std::optional<uint64_t> remaining() const override { return reader_->remaining(); }
  uint64_t offset() const override { return reader_->offset(); }

 private:
  std::shared_ptr<const ByteSource> source_;
  std::unique_ptr<ByteReader> reader_;
};

std::span<const std::byte> first_bytes(const ByteSource& source, std::span<std::byte> into) {
  const auto first =
      into.first(static_cast<size_t>(std::min<uint64_t>(into.size(), source.size())));
  source.read(0, first);
  return first;
}

GaussianCloud finished(GaussianCloud cloud) {
  sanitise(cloud);
  leave_out_zero_bands(cloud);
  return cloud;
}

// So that many appends copy little.
void make_room(GaussianCloud& cloud, uint64_t gaussians, uint64_t announced) {
  reserve_for(cloud.position, gaussians, announced, 3);
  reserve_for(cloud.log_scale, gaussians, announced, 3);
  reserve_for(cloud.rotation, gaussians, announced, 4);
  reserve_for(cloud.opacity, gaussians, announced, 1);
  reserve_for(cloud.sh, gaussians, announced, static_cast<size_t>(cloud.coefficients()) * 3);
}

}  // namespace

std::unique_ptr<BlockReader> open_blocks(std::unique_ptr<ByteReader> reader) {
  auto input = std::make_unique<OwnedPeek>(std::move(reader));
  const std::span<const std::byte> first = input->peek(kFormatBytes);
  const Format* format = format_of(first);
  if (!format || !format->open_stream)
    refuse(input->name(), input->offset(), "format", in_hex(first),
           "the first bytes of INRIA .ply (\"ply\"): no other format can be read from a stream");
  return format->open_stream(std::move(input));
}

std::unique_ptr<BlockReader> open_blocks(std::shared_ptr<const ByteSource> source) {
  std::byte bytes[kFormatBytes];
  const auto first = first_bytes(*source, bytes);
  const Format* format = format_of(first);
  if (!format) refuse(source->name(), 0, "format", in_hex(first), kKnown);
  if (format->open_source) return format->open_source(std::move(source));
  return format->open_stream(std::make_unique<SharedReader>(std::move(source)));
}

bool is_importable(std::span<const std::byte> first_bytes) {
  return format_of(first_bytes) != nullptr;
}

GaussianCloud import_gaussians(ByteReader& reader, const ImportOptions& options) {
  PeekReader input(reader);
  const std::span<const std::byte> first = input.peek(kFormatBytes);
  const Format* format = format_of(first);
  if (!format) refuse(input.name(), input.offset(), "format", in_hex(first), kKnown);
  if (!format->import)
    refuse(input.name(), input.offset(), "format", "a file whose parts are apart from one another",
           "a .ply or a .spz: no other format can be read from a stream");
  return finished(format->import(input, options));
}

GaussianCloud import_gaussians(const ByteSource& source, const ImportOptions& options) {
  std::byte bytes[kFormatBytes];
  const Format* format = format_of(first_bytes(source, bytes));
  if (!format || format->import) return import_gaussians(*read_source(source), options);
  // The readers are gone before this returns.
  const std::shared_ptr<const ByteSource> borrowed(std::shared_ptr<void>(), &source);
  return import_blocks(*open_blocks(borrowed), options);
}

GaussianCloud import_blocks(BlockReader& reader, const ImportOptions& options) {
  constexpr size_t kAtOnce = 1 << 14;
  GaussianCloud cloud(options.memory);
  cloud.sh_degree = reader.sh_degree();
  cloud.native = reader.native();
  for (uint64_t done = 0;;) {
    const RawBlock block = reader.next(kAtOnce);
    if (block.count == 0) break;
    GaussianCloud more = reader.decode(block);
    if (done == 0) cloud.origin = more.origin;
    make_room(cloud, done + block.count, reader.count());
    append(cloud, std::move(more), reader.name());
    done += block.count;
    report(options.progress, "reading", done, reader.count());
  }
  return finished(std::move(cloud));
}

}  // namespace voyager
