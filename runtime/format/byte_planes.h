#pragma once
#include <cstddef>
#include <cstdint>

namespace voyager {

// Planes of n bytes, filled and read in the order of the file. A value of several
// bytes takes a plane for each, lowest first.
class BytePlanes {
 public:
  BytePlanes(std::byte* bytes, size_t n) : next_(bytes), n_(n) {}

  template <class Value>
  void put(size_t width, const Value& value) {
    for (size_t i = 0; i < n_; ++i) {
      const uint32_t v = value(i);
      for (size_t b = 0; b < width; ++b) next_[b * n_ + i] = static_cast<std::byte>(v >> (8 * b));
    }
    next_ += width * n_;
  }

  template <class Store>
  void take(size_t width, const Store& store) {
    for (size_t i = 0; i < n_; ++i) {
      uint32_t v = 0;
      for (size_t b = 0; b < width; ++b)
        v |= std::to_integer<uint32_t>(next_[b * n_ + i]) << (8 * b);
      store(i, v);
    }
    next_ += width * n_;
  }

  std::byte* position() const { return next_; }

 private:
  std::byte* next_;
  size_t n_;
};

}  // namespace voyager
