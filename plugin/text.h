#pragma once
// Text in UTF-8 for a room of fixed size. What is too long ends where a character ends.
#include <algorithm>
#include <cstddef>
#include <string_view>

namespace voyager {

// Bytes of `text` without a character at its end of which only a part is there.
size_t whole_characters(std::string_view text) noexcept;

// `into` starts as zeros, of which one stays behind the text.
template <size_t size>
void put_text(std::string_view text, char (&into)[size]) noexcept {
  text = text.substr(0, size - 1);
  text.copy(into, whole_characters(text));
}

}  // namespace voyager
