#pragma once
// The places of the set bits of a word, without a branch for each of them.
#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime/math/count_bits.h"

namespace voyager {

template <size_t Bits>
constexpr auto make_set_bits() {
  std::array<std::array<uint8_t, Bits>, (size_t{1} << Bits)> table{};
  for (size_t word = 0; word < table.size(); ++word)
    for (size_t bit = 0, found = 0; bit < Bits; ++bit)
      if ((word >> bit & 1) != 0) table[word][found++] = static_cast<uint8_t>(bit);
  return table;
}

// out[i] = make(place) for the place of each set bit, ascending; returns where it stopped,
// at most `end`. What lies from there to `end` may be written, too: the next call's to overwrite.
template <size_t Bits, class T, class Make>
T* put_set_bits(uint32_t word, T* out, const T* end, const Make& make) {
  static constexpr auto kPlaces = make_set_bits<Bits>();
  constexpr uint32_t kMask = (1u << Bits) - 1;
  for (uint32_t base = 0; word != 0; word >>= Bits, base += Bits) {
    const auto& places = kPlaces[word & kMask];
    const size_t count = count_bits(word & kMask);
    const size_t room = static_cast<size_t>(end - out) < Bits ? count : Bits;
    if (room == Bits)
      for (size_t i = 0; i < Bits; ++i) out[i] = make(base + places[i]);
    else
      for (size_t i = 0; i < room; ++i) out[i] = make(base + places[i]);
    out += count;
  }
  return out;
}

}  // namespace voyager
