#pragma once
// One visit of a subtree: which of its nodes are refined, which are in the cut, and
// how long that can be relied on. judge() decides for every search; visit() is the host's, and a
// device visits by several lanes (cuda/search).
#include <cfloat>
#include <cmath>

#include "runtime/math/screen_size.h"
#include "runtime/select/cut.h"
#include "runtime/select/search_tree.h"
#include "runtime/select/watch.h"

namespace voyager {

// What a search asks of every node.
struct Sight {
  Vec3f centre;        // scene-local metres
  float target_size;   // τ*
  float inverse_size;  // inverse_target_size(τ*), rounded; +inf where that overflows
};

inline Sight make_sight(const CutQuery& query) {
  return {query.centre, query.target_size,
          static_cast<float>(inverse_target_size(query.target_size))};
}

// Error bounds of the slack, derived in docs/lod-selection.md.
inline constexpr float kSlackRounding = 0x1p-18f;  // of distance + reach
inline constexpr float kSlackFloor = 1e-18f;       // metres: squares below it underflow

struct NodeVerdict {
  bool refined;  // size ≥ τ*: its children stand for it
  float slack;   // metres; ≤ 0: none. Of the sum of the centre's way and extent · |Δ 1/τ*|
};

// Where there is slack, distance and reach are so far apart that which of them is the
// longer is the verdict; only without slack the predicate itself must be asked.
VOYAGER_HD NodeVerdict judge(const NodeBounds& b, const Sight& sight) {
  const float squared = squared_distance(sight.centre, b.box_min, b.box_max);
  const float distance = sqrt_near(squared), reach = b.extent * sight.inverse_size;
  const float slack =
      std::fabs(distance - reach) - (kSlackRounding * (distance + reach) + kSlackFloor);
  if (slack > 0.0f && reach <= FLT_MAX) return {distance < reach, slack};
  return {size_at(squared, b.extent) >= sight.target_size, 0.0f};
}

// What a search keeps of a subtree that is open: one whose roots hang from a refined node.
inline constexpr uint32_t kOpen = 0x80000000u;  // beside the bits of refined slots

struct Visit {
  uint32_t refined = kOpen;
  uint32_t cut = 0;        // slots in the cut
  uint32_t stand_ins = 0;  // those of them that would be refined if their children were there
  float slack = INFINITY;  // least over the nodes that decide; +inf where none does
  float extent = 0.0f;     // greatest over the same nodes
  uint32_t tested = 0;
};

// The subtree is open and not missing. Nodes below one that is not refined are not tested:
// they cannot be refined, and their slack cannot end before their parent's. record(i): the i-th
// of the subtree's records.
template <class Record>
Visit visit(const SearchSubtree& subtree, const Sight& sight, const Record& record) {
  Visit v;
  uint32_t reached = subtree.level_slots(0);  // slots whose parent is refined
  uint32_t i = 0;
  for (uint32_t left = subtree.interior; left != 0; left &= left - 1, ++i) {
    const uint32_t slot = left & (~left + 1);
    if ((reached & slot) == 0) continue;
    const SearchRecord& r = record(i);
    const NodeBounds bounds = r.bounds();
    const NodeVerdict verdict = judge(bounds, sight);
    ++v.tested;
    v.slack = verdict.slack < v.slack ? verdict.slack : v.slack;
    v.extent = bounds.extent > v.extent ? bounds.extent : v.extent;
    if (!verdict.refined) continue;
    if (r.children == kBlocked) {
      v.stand_ins |= slot;
      continue;
    }
    v.refined |= slot;
    reached |= r.child_slots();
  }
  v.cut = reached & ~v.refined & subtree.owned();
  return v;
}

}  // namespace voyager
