#pragma once
// An array that takes memory only where something was set: an eighth of a byte a place elsewhere.
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace voyager {

template <class Value>
class SparseArray {
 public:
  explicit SparseArray(size_t size) : pages_((size + kPlaces - 1) / kPlaces) {}

  // Value{} where nothing was set.
  Value operator[](size_t i) const {
    const auto& page = pages_[i / kPlaces];
    return page ? page->values[i % kPlaces] : Value{};
  }
  // Value{}: as if it had never been set.
  void set(size_t i, Value value) {
    auto& page = pages_[i / kPlaces];
    if (!page) {
      if (value == Value{}) return;
      page = std::make_unique<Page>();
    }
    Value& old = page->values[i % kPlaces];
    page->set += (value != Value{}) - (old != Value{});
    old = value;
    if (page->set == 0) page.reset();
  }

 private:
  static constexpr size_t kPlaces = 64;
  struct Page {
    std::array<Value, kPlaces> values{};
    int set = 0;
  };

  std::vector<std::unique_ptr<Page>> pages_;
};

}  // namespace voyager
