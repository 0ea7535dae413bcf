#pragma once
// What the mutators of structured inputs share.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>

#include "tests/support/sealed.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed);

namespace voyager::fuzz {

using test::Bytes;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  size_t below(size_t end) { return end == 0 ? 0 : engine_() % end; }
  bool once_in(size_t times) { return below(times) == 0; }

 private:
  std::minstd_rand engine_;
};

// As libFuzzer mutates plain bytes.
inline void mutate(Bytes& bytes, size_t most) {
  const size_t size = std::min(bytes.size(), most);
  bytes.resize(std::max<size_t>(most, 1));
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(bytes.data()), size, most));
}

// The same without a change of length.
inline void mutate_in_place(std::span<std::byte> bytes) {
  if (bytes.empty()) return;
  Bytes copy(bytes.begin(), bytes.end());
  mutate(copy, copy.size());
  std::copy(copy.begin(), copy.end(), bytes.begin());
}

// A word of four bytes becomes one close to it, an edge of its range or of a float's, or another
// word of the same bytes.
inline void mutate_word(std::span<std::byte> bytes, size_t at, Random& random) {
  if (bytes.size() < 4 || at > bytes.size() - 4) return;
  constexpr uint32_t kEdges[] = {0,          1,          0x7fffffff, 0x80000000, 0xffffffff,
                                 0xfffffffe, 0x7f800000, 0xff800000, 0x7fc00000, 0x7f7fffff,
                                 0xff7fffff, 0x5d5e0b6b, 0x3f800000, 0x00000100, 0x00010000};
  uint32_t word;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  switch (random.below(4)) {
    case 0:
      word = kEdges[random.below(std::size(kEdges))];
      break;
    case 1:
      word += static_cast<uint32_t>(random.below(9)) - 4;
      break;
    case 2:
      word ^= 1u << random.below(32);
      break;
    default:
      std::memcpy(&word, bytes.data() + random.below(bytes.size() / 4) * 4, sizeof word);
  }
  std::memcpy(bytes.data() + at, &word, sizeof word);
}

// What a mutator hands back; the input where the result does not fit.
inline size_t hand_back(const Bytes& bytes, uint8_t* data, size_t size, size_t max_size) {
  if (bytes.size() > max_size || bytes.empty()) return size;
  std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}

}  // namespace voyager::fuzz
