#pragma once
// Random numbers that are the same on every machine: the distributions of the
// standard library are not. SplitMix64 over a counter; integers and exactly
// rounded arithmetic only.
#include <cstdint>

namespace voyager::synth {

inline uint64_t scramble(uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// One stream name out of several numbers.
inline uint64_t combine(uint64_t a, uint64_t b) {
  return scramble(a * 0x9e3779b97f4a7c15u + scramble(b + 0x632be59bd9b4e019u));
}
inline uint64_t combine(uint64_t a, uint64_t b, uint64_t c) {
  return combine(combine(a, b), c);
}

// Draw one number a full expression, or inside braces: elsewhere the order of
// evaluation, and so the city, would be the compiler's choice.
class Random {
 public:
  explicit Random(uint64_t seed) : counter_(seed) {}

  uint64_t bits() { return scramble(counter_ += 0x9e3779b97f4a7c15u); }
  // [0, 1), 32 bits of it.
  double uniform() { return static_cast<double>(bits() >> 32) * 0x1p-32; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  // Mean 0, variance 1, |x| < 3.47: the sum of four uniform numbers.
  double bell() {
    const uint64_t b = bits();
    const uint64_t sum = (b & 0xffff) + ((b >> 16) & 0xffff) + ((b >> 32) & 0xffff) + (b >> 48);
    return (static_cast<double>(sum) * 0x1p-16 - 2.0) * 1.7320508075688772;
  }
  // [0, n)
  int below(int n) { return static_cast<int>(uniform() * n); }
  bool chance(double probability) { return uniform() < probability; }

 private:
  uint64_t counter_;
};

}  // namespace voyager::synth
