#pragma once
#include <vector>

#include "runtime/format/byte_planes.h"
#include "runtime/format/plane_order.h"

namespace voyager {

// Planes of the Gaussians, and after them those of doubles: differences to their children's.
class GaussianPlanes {
 public:
  GaussianPlanes(std::byte* at, const GaussianOrder& order, size_t gaussian_bytes)
      : plain_(at, order.plain),
        told_(at + order.plain * gaussian_bytes, order.child.size()),
        order_(order),
        values_(order.item.size()) {}

  template <class Value>
  void put(size_t width, const Value& value) {
    plain_.put(width, [&](size_t at) -> uint32_t { return value(order_.item[at]); });
    told_.put(width, [&](size_t at) -> uint32_t {
      return value(order_.item[order_.plain + at]) - value(order_.child[at]);
    });
  }

  template <class Store>
  void take(size_t width, const Store& store) {
    const auto set = [&](uint32_t i, uint32_t v) { store(i, values_[i] = v); };
    plain_.take(width, [&](size_t at, uint32_t v) { set(order_.item[at], v); });
    const uint32_t mask = 0xffffffffu >> (32 - 8 * width);
    told_.take(width, [&](size_t at, uint32_t v) {
      set(order_.item[order_.plain + at], (v + values_[order_.child[at]]) & mask);
    });
  }

  // Where the planes so far end, but the last group ends with those of doubles.
  std::byte* position() const { return plain_.position(); }
  std::byte* end() const { return told_.position(); }

 private:
  BytePlanes plain_, told_;
  const GaussianOrder& order_;
  std::vector<uint32_t> values_;
};

}  // namespace voyager
