#include "runtime/stream/chunk_looks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace voyager {
namespace {

uint32_t make_urgency(ChunkLooks::Class of, float error) {
  return ChunkLooks::least_of(of) | std::bit_cast<uint32_t>(error) >> 1 | ChunkLooks::kOwn;
}

ChunkLooks::Class class_at(const Viewer& viewer, const EntryHull& hull) {
  using Class = ChunkLooks::Class;
  if (viewer.sees(hull)) return viewer.ahead ? Class::soon : Class::seen;
  return viewer.sees_turned(hull) ? Class::turned : Class::around;
}

}  // namespace

float ChunkLooks::error_of(uint32_t urgency) {
  return std::bit_cast<float>((urgency & 0x3fffffffu) << 1);
}

void ChunkLooks::begin(std::vector<Viewer> viewers) {
  viewers_ = std::move(viewers);
  for (const uint32_t chunk : looked_) looks_.set(chunk, kNotLooked);
  looked_.clear();
}

uint32_t ChunkLooks::look(uint32_t chunk) const {
  const EntryHull hull = chunks_->hull(chunk);
  uint32_t urgency = 0;
  bool now = false;
  for (const Viewer& viewer : viewers_) {
    const float size = hull.screen_size(viewer.query.centre);
    if (!(size >= viewer.query.target_size)) continue;
    const float error = size / viewer.query.target_size;
    now = now || !viewer.ahead;
    urgency =
        std::max(urgency, make_urgency(class_at(viewer, hull), error >= 1.0f ? error : INFINITY));
  }
  if (urgency == 0) return kNobody;
  return now ? urgency | kNow : urgency & ~kNow;
}

}  // namespace voyager
