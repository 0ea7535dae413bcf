#include "runtime/scene/import/importer.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "runtime/base/name_ending.h"
#include "runtime/scene/append.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/format_name.h"
#include "runtime/scene/import/import_blocks.h"
#include "runtime/scene/import/json_value.h"
#include "runtime/scene/import/peek_reader.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/import/shared_reader.h"
#include "runtime/scene/import/spz_header.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

using FirstBytes = std::span<const std::byte>;

// A format is told by the end of the file's name, where nothing in the file tells it, or else by
// its first bytes. The name comes first: any bytes may begin a file without a mark.
struct Format {
  std::string_view ending, first_bytes;  // one of them
  // From a stream at once, where that takes less memory than block by block.
  GaussianCloud (*import)(ByteReader&, const ImportOptions&);
  // One of them at least: in blocks from any stream, or from a source.
  std::unique_ptr<BlockReader> (*open_stream)(std::unique_ptr<ByteReader>);
  std::unique_ptr<BlockReader> (*open_source)(std::shared_ptr<const ByteSource>);
  bool is_json = false;  // all of the file is
};
constexpr Format kFormats[] = {
    {".splat", "", nullptr, open_splat_blocks, nullptr},
    {".ksplat", "", nullptr, open_ksplat_blocks, nullptr},
    {".hier", "", nullptr, nullptr, open_hier_blocks},
    {".hier_opt", "", nullptr, nullptr, open_hier_blocks},
    {".lcc", "", nullptr, nullptr, open_lcc_blocks, true},
    {"lod-meta.json", "", nullptr, nullptr, open_streamed_sog_blocks, true},
    {"meta.json", "", nullptr, nullptr, open_sog_blocks, true},
    {"", "ply\n", import_ply, open_ply_blocks, open_ply_blocks},
    {"", "ply\r", import_ply, open_ply_blocks, open_ply_blocks},
    {"", "\x1f\x8b", import_spz, nullptr, open_spz_blocks},
    {"", "NGSP", import_spz, nullptr, open_spz_blocks},
    {"", "PK\x03\x04", nullptr, nullptr, open_sog_blocks},
    {"", "RAD0", nullptr, nullptr, open_rad_blocks},
    {"", "glTF", nullptr, nullptr, open_glb_blocks},
    {"", "{", nullptr, nullptr, open_json_blocks, true},
};
constexpr const char* kKnown =
    "a .ply or .compressed.ply (first bytes \"ply\"), a .spz (gzip 1f 8b, or \"NGSP\"), a .sog "
    "(a zip), a .rad (\"RAD0\"), a .glb (\"glTF\"), a .gltf or tileset.json (\"{\"), or by its "
    "name a .splat, a .ksplat, a .hier, a .lcc, or the meta.json or lod-meta.json of a SOG folder";

// Formats that are known and not read.
struct Unread {
  std::string_view ending, first_bytes;
  const char* why;
};
constexpr Unread kUnread[] = {
    {".lcc2", "",
     "LCC2 is not read, because it has no specification; other programs convert it to .ply"},
    {"", "RADC", "a chunk of Spark's .rad is not read alone; give the .rad that names it"},
};

// JSON may begin with white space.
std::span<const std::byte> without_space(std::span<const std::byte> bytes) {
  const auto is_space = [](std::byte b) {
    return b == std::byte{' '} || b == std::byte{'\t'} || b == std::byte{'\n'} ||
           b == std::byte{'\r'};
  };
  const auto rest = std::find_if_not(bytes.begin(), bytes.end(), is_space);
  return bytes.subspan(static_cast<size_t>(rest - bytes.begin()));
}

// An ending without a dot is a whole name.
bool ends_with(std::string_view name, std::string_view ending) {
  if (!has_ending(name, ending)) return false;
  const size_t begin = name.size() - ending.size();
  return ending.front() == '.' || begin == 0 || name[begin - 1] == '/';
}

bool begins_with(FirstBytes bytes, std::string_view first) {
  return bytes.size() >= first.size() &&
         std::equal(first.begin(), first.end(), bytes.begin(),
                    [](char a, std::byte b) { return static_cast<std::byte>(a) == b; });
}

template <class Row, size_t count>
const Row* find(const Row (&rows)[count], FirstBytes first, std::string_view name) {
  const Row* found = std::find_if(rows, rows + count, [&](const Row& row) {
    if (!row.ending.empty()) return ends_with(name, row.ending);
    return begins_with(row.first_bytes == "{" ? without_space(first) : first, row.first_bytes);
  });
  return found == rows + count ? nullptr : found;
}

// An unread one may begin as another does: LCC2's is JSON.
const Format* known_format(FirstBytes first, std::string_view name) {
  return find(kUnread, first, name) ? nullptr : find(kFormats, first, name);
}

std::string in_hex(FirstBytes bytes) {
  if (bytes.empty()) return "an empty input";
  std::string text = "the bytes";
  for (const std::byte b : bytes) {
    char digits[4];
    std::snprintf(digits, sizeof digits, " %02x", std::to_integer<unsigned>(b));
    text += digits;
  }
  return text;
}

const Format& format_of(FirstBytes first, const std::string& name, uint64_t offset) {
  const Format* format = known_format(first, name);
  if (!format) refuse(name, offset, "format", in_hex(first), expected_format(first, name));
  return *format;
}

const Format& format_of(const ByteSource& source) {
  std::byte bytes[kFormatBytes];
  const auto first =
      std::span(bytes).first(static_cast<size_t>(std::min<uint64_t>(sizeof bytes, source.size())));
  source.read(0, first);
  const Format& format = format_of(first, source.name(), 0);
  if (format.is_json && source.size() > kMostJsonBytes)
    refuse(source.name(), 0, "JSON", std::to_string(source.size()) + " bytes",
           "at most " + std::to_string(kMostJsonBytes));
  return format;
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
  FirstBytes peek(size_t count) { return peek_.peek(count); }

 private:
  std::unique_ptr<ByteReader> inner_;
  PeekReader peek_{*inner_};
};

// Another's stream, for what wants one of its own.
class BorrowedReader final : public ByteReader {
 public:
  explicit BorrowedReader(ByteReader& inner) : inner_(inner) {}
  const std::string& name() const override { return inner_.name(); }
  size_t read(std::span<std::byte> into) override { return inner_.read(into); }
  uint64_t skip(uint64_t count) override { return inner_.skip(count); }
  std::optional<uint64_t> remaining() const override { return inner_.remaining(); }
  uint64_t offset() const override { return inner_.offset(); }

 private:
  ByteReader& inner_;
};

[[noreturn]] void refuse_stream(const ByteReader& input, FirstBytes first, const char* expected) {
  refuse(input.name(), input.offset(), "format", in_hex(first), expected);
}

GaussianCloud finished(GaussianCloud cloud) {
  sanitise(cloud);
  leave_out_zero_bands(cloud);
  return cloud;
}

}  // namespace

std::unique_ptr<BlockReader> open_blocks(std::unique_ptr<ByteReader> reader) {
  auto input = std::make_unique<OwnedPeek>(std::move(reader));
  const FirstBytes first = input->peek(kFormatBytes);
  const Format* format = known_format(first, input->name());
  if (!format || !format->open_stream)
    refuse_stream(
        *input, first,
        "the first bytes of a .ply (\"ply\"), or a .splat or .ksplat by its name: no other "
        "format can be read from a stream");
  return format->open_stream(std::move(input));
}

std::unique_ptr<BlockReader> open_blocks(std::shared_ptr<const ByteSource> source) {
  const Format& format = format_of(*source);
  if (format.open_source) return format.open_source(std::move(source));
  return format.open_stream(std::make_unique<SharedReader>(std::move(source)));
}

bool is_importable(FirstBytes first_bytes, std::string_view name) {
  return known_format(first_bytes, name) != nullptr;
}

std::vector<std::string> left_out_of(const ByteSource& source) {
  const auto open = format_of(source).open_source;
  if (open == open_spz_blocks) return left_out_of_spz(source);
  if (open == open_lcc_blocks) return left_out_of_lcc(source);
  // Borrowed: nothing of it is kept.
  if (open == open_glb_blocks || open == open_json_blocks)
    return left_out_of_gltf(std::shared_ptr<const ByteSource>(&source, [](const ByteSource*) {}));
  return {};
}

std::string format_name(const ByteSource& source) {
  const Format& format = format_of(source);
  if (format.open_source == open_spz_blocks)
    return "SPZ " + std::to_string(spz::read_announcement(source).header.version);
  if (format.first_bytes.starts_with("ply")) return ".ply";
  if (format.open_source == open_sog_blocks) return "SOG";
  if (format.open_source == open_streamed_sog_blocks) return "SOG, streamed";
  if (format.open_source == open_rad_blocks) return ".rad";
  if (format.open_source == open_glb_blocks) return "glTF, binary";
  if (format.open_source == open_json_blocks) return "glTF or 3D Tiles, JSON";
  return std::string(format.ending);
}

bool is_hier_name(std::string_view name) {
  return ends_with(name, ".hier") || ends_with(name, ".hier_opt");
}

std::string expected_format(FirstBytes first_bytes, std::string_view name) {
  const Unread* unread = find(kUnread, first_bytes, name);
  return unread ? std::string(kKnown) + ": " + unread->why : kKnown;
}

GaussianCloud import_gaussians(ByteReader& reader, const ImportOptions& options) {
  PeekReader input(reader);
  const FirstBytes first = input.peek(kFormatBytes);
  const Format& format = format_of(first, input.name(), input.offset());
  if (format.import) return finished(format.import(input, options));
  if (!format.open_stream)
    refuse_stream(input, first, "a file: the format cannot be read from a stream");
  return finished(
      import_blocks(*format.open_stream(std::make_unique<BorrowedReader>(input)), options));
}

GaussianCloud import_gaussians(std::shared_ptr<const ByteSource> source,
                               const ImportOptions& options) {
  const Format& format = format_of(*source);
  if (format.import) return finished(format.import(*read_source(*source), options));
  return finished(import_blocks(*open_blocks(std::move(source)), options));
}

GaussianCloud import_gaussians(BlockReader& reader, const ImportOptions& options) {
  return finished(import_blocks(reader, options));
}

}  // namespace voyager
