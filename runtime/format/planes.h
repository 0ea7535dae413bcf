#pragma once
// Arrays of plain values to and from a payload, in order.
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace voyager {

class PlaneWriter {
 public:
  explicit PlaneWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {}

  template <class T>
  void put(const T* values, size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const size_t start = bytes_.size();
    bytes_.resize(start + count * sizeof(T));
    if (count != 0) std::memcpy(bytes_.data() + start, values, count * sizeof(T));
  }

 private:
  std::vector<std::byte>& bytes_;
};

// The caller has checked that the payload holds what will be taken.
class PlaneReader {
 public:
  explicit PlaneReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  void take(T* values, size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count != 0) std::memcpy(values, bytes_.data(), count * sizeof(T));
    bytes_ = bytes_.subspan(count * sizeof(T));
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace voyager
