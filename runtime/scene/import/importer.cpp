#include "runtime/scene/import/importer.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "runtime/scene/import/peek_reader.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

struct Format {
  std::string_view first_bytes;
  GaussianCloud (*import)(ByteReader&, const ImportOptions&);
};
constexpr Format kFormats[] = {
    {"ply\n", import_ply},
    {"ply\r", import_ply},
    {"\x1f\x8b", import_spz},
    {"NGSP", import_spz},
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

}  // namespace

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
  return cloud;
}

}  // namespace voyager
