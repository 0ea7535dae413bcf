#include "plugin/text.h"

#include <bit>
#include <cstdint>

namespace voyager {

size_t whole_characters(std::string_view text) noexcept {
  constexpr size_t kLongest = 4;
  for (size_t back = 1; back <= std::min(text.size(), kLongest); ++back) {
    const auto byte = static_cast<uint8_t>(text[text.size() - back]);
    const auto ones = static_cast<size_t>(std::countl_one(byte));
    if (ones == 1) continue;  // within a character
    return ones > back ? text.size() - back : text.size();
  }
  return text.size();
}

}  // namespace voyager
