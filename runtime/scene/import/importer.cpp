#include "runtime/scene/import/importer.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/peek_reader.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

struct Format {
  std::string_view first_bytes;
  GaussianCloud (*import)(ByteReader&, const ImportOptions&);
  // One of them: in blocks from any stream, or from a source alone.
  std::unique_ptr<BlockReader> (*open_stream)(std::unique_ptr<ByteReader>);
  std::unique_ptr<BlockReader> (*open_source)(std::shared_ptr<const ByteSource>);
};
constexpr Format kFormats[] = {
    {"ply\n", import_ply, open_ply_blocks, nullptr},
    {"ply\r", import_ply, open_ply_blocks, nullptr},
    {"\x1f\x8b", import_spz, nullptr, open_spz_blocks},
    {"NGSP", import_spz, nullptr, open_spz_blocks},
};
constexpr const char* kKnown =
    "the first bytes of INRIA .ply (\"ply\") or .spz (gzip 1f 8b, or \"NGSP\")";

const Format* format_of(std::span<const std::byte> bytes) {
  const auto begins = [&](const Format& format) {
    return bytes.size() >= format.first_bytes.size() &&
           std::equal(format.first_bytes.begin(), format.first_bytes.end(), bytes.begin(),
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
  const auto first =
      std::span(bytes).first(static_cast<size_t>(std::min<uint64_t>(sizeof bytes, source->size())));
  source->read(0, first);
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
  GaussianCloud cloud = format->import(input, options);
  sanitise(cloud);
  leave_out_zero_bands(cloud);
  return cloud;
}

}  // namespace voyager
