#include "runtime/base/printable.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace voyager {
namespace {

uint8_t byte_at(std::string_view text, size_t i) {
  return i < text.size() ? static_cast<uint8_t>(text[i]) : 0;
}

// Bytes of the character of UTF-8 at the start of `text`, 0 where there is none. Whether it is
// written as short as can be is nobody's concern but for U+0080 to U+009F, which are controls.
size_t length_of_character(std::string_view text) {
  const uint8_t first = byte_at(text, 0);
  if (first < 0x80) return 1;
  const auto length = static_cast<size_t>(std::countl_one(first));
  if (length < 2 || length > 4 || first == 0xc0 || first == 0xc1) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte_at(text, i) & 0xc0) != 0x80) return 0;
  return length;
}

bool is_control(std::string_view character) {
  const uint8_t first = byte_at(character, 0);
  return first < 0x20 || first == 0x7f || (first == 0xc2 && byte_at(character, 1) < 0xa0);
}

void append_codes(std::string_view bytes, std::string& out) {
  constexpr char kDigits[] = "0123456789abcdef";
  for (const char c : bytes) {
    const auto byte = static_cast<uint8_t>(c);
    out += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
  }
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const size_t length = length_of_character(text);
    const std::string_view character = text.substr(0, std::max<size_t>(length, 1));
    if (length == 0 || is_control(character))
      append_codes(character, out);
    else
      out += character;
    text.remove_prefix(character.size());
  }
  return out;
}

}  // namespace voyager
