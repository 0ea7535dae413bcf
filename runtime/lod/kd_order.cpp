#include "runtime/lod/kd_order.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>

#include "runtime/lod/baked_scene.h"
#include "runtime/lod/summarise.h"

namespace voyager {
namespace {

// The coordinate lies beside the index: a selection then reads memory in order.
struct Entry {
  float key;
  uint32_t index;
};

bool before(const Entry& a, const Entry& b) {
  return a.key < b.key || (a.key == b.key && a.index < b.index);
}

constexpr uint32_t kSerialSize = 8192;  // Gaussians; a task below this costs more than it gains

class KdSorter {
 public:
  KdSorter(const GaussianCloud& cloud, const std::array<double, 3>& origin, const KdRule& rule)
      : cloud_(cloud), origin_(origin), rule_(rule) {}

  void sort(Entry* entries, uint32_t size) const {
    if (size <= rule_.block) {
      std::sort(entries, entries + size,
                [](const Entry& a, const Entry& b) { return a.index < b.index; });
      return;
    }
    const uint32_t lower = lower_part(size, rule_);
    const int axis = longest_side(entries, size);
    for (uint32_t i = 0; i < size; ++i) entries[i].key = mean(entries[i])[axis];
    std::nth_element(entries, entries + lower, entries + size, before);
    const auto low = [&] { sort(entries, lower); };
    const auto high = [&] { sort(entries + lower, size - lower); };
    if (size <= kSerialSize) {
      low();
      high();
      return;
    }
    const auto guarded = [](const auto& half) {
      const FloatingPointMode mode;
      half();
    };
    tbb::parallel_invoke([&] { guarded(low); }, [&] { guarded(high); });
  }

 private:
  Vec3f mean(const Entry& entry) const { return local_mean(cloud_, entry.index, origin_); }

  Box bounds(const Entry& entry) const {
    const Vec3f m = mean(entry);
    if (!rule_.boxes) return {m, m};
    GaussianWords words = cloud_.words(entry.index);
    words.mean = m;
    return leaf_box(activate(words, true));
  }

  int longest_side(const Entry* entries, uint32_t size) const {
    auto [least, most] = bounds(entries[0]);
    for (uint32_t i = 1; i < size; ++i) {
      const Box box = bounds(entries[i]);
      for (int axis = 0; axis < 3; ++axis) {
        least[axis] = std::min(least[axis], box.least[axis]);
        most[axis] = std::max(most[axis], box.most[axis]);
      }
    }
    const Vec3f side = most - least;
    return side.x >= side.y ? (side.x >= side.z ? 0 : 2) : (side.y >= side.z ? 1 : 2);
  }

  const GaussianCloud& cloud_;
  const std::array<double, 3>& origin_;
  const KdRule& rule_;
};

}  // namespace

std::vector<uint32_t> kd_order(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                               const KdRule& rule, Workers& workers) {
  const uint32_t size = static_cast<uint32_t>(cloud.size());
  std::vector<Entry> entries(size);
  for (uint32_t i = 0; i < size; ++i) entries[i] = {0.0f, i};
  workers.run([&] {
    const FloatingPointMode mode;
    KdSorter(cloud, origin, rule).sort(entries.data(), size);
  });
  std::vector<uint32_t> order(size);
  for (uint32_t i = 0; i < size; ++i) order[i] = entries[i].index;
  return order;
}

}  // namespace voyager
