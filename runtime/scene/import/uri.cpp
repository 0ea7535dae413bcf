#include "runtime/scene/import/uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <string_view>
#include <vector>

#include "runtime/scene/import/refuse.h"

namespace voyager {
namespace {

class OwnedBytes final : public ByteSource {
 public:
  OwnedBytes(std::string name, std::vector<std::byte> bytes)
      : bytes_(std::move(bytes)), view_(std::move(name), bytes_) {}
  const std::string& name() const override { return view_.name(); }
  uint64_t size() const override { return view_.size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override { view_.read(offset, into); }

 private:
  std::vector<std::byte> bytes_;
  MemorySource view_;
};

// 0 to 63, or -1.
int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

// False where there is a character that is no digit, or a lone last one.
bool decode_base64(std::string_view text, std::vector<std::byte>& bytes) {
  for (int i = 0; i < 2 && !text.empty() && text.back() == '='; ++i) text.remove_suffix(1);
  if (text.size() % 4 == 1) return false;
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return false;
    bits = bits << 6 | static_cast<uint32_t>(digit);
    have += 6;
    if (have < 8) continue;
    have -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> have & 255u));
  }
  return true;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const int lower = std::tolower(static_cast<unsigned char>(c));
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

// Without the %20 and the like; "" where one of them is damaged or the end of a string.
std::string decode_percent(std::string_view text) {
  std::string plain;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      plain += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high < 0 ? -1 : hex_digit(text[i + 2]);
    if (low < 0 || high + low == 0) return {};
    plain += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return plain;
}

// "http" of "http://...", in which a path has no colon before a slash.
bool has_scheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon < uri.find('/');
}

std::string shown(const std::string& uri) {
  constexpr size_t kMost = 60;
  return uri.size() <= kMost ? uri : uri.substr(0, kMost) + "...";
}

}  // namespace

bool is_data_uri(const std::string& uri) {
  return uri.rfind("data:", 0) == 0;
}

std::string path_of_uri(const std::string& file, const std::string& place, const std::string& uri) {
  std::string path = decode_percent(uri);
  if (path.empty() || has_scheme(uri))
    refuse(file, 0, place, shown(uri), "a data: URI, or a file in the same folder or below");
  return path;
}

std::shared_ptr<const ByteSource> open_uri(const ByteSource& source, const std::string& place,
                                           const std::string& uri) {
  if (!is_data_uri(uri)) return source.open_beside(path_of_uri(source.name(), place, uri));
  const size_t comma = std::min(uri.find(','), uri.size());
  const std::string_view head = std::string_view(uri).substr(0, comma);
  std::vector<std::byte> bytes;
  if (comma == uri.size() || !head.ends_with(";base64") ||
      !decode_base64(std::string_view(uri).substr(comma + 1), bytes))
    refuse(source.name(), 0, place, shown(uri), "data:TYPE;base64,... in whole digits");
  return std::make_shared<OwnedBytes>(source.name() + ": " + place, std::move(bytes));
}

}  // namespace voyager
