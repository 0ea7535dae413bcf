#pragma once
// When any of 32 neighbouring subtrees has to be looked at again: what is known of all of them
// together, so that a frame reads the watches of few.
#include "runtime/select/watch.h"

namespace voyager {

inline constexpr uint32_t kRowSubtrees = 32;

// 16 bytes. While the journey's way is less than `way`, its turns are `turns` and its moves fewer
// than `moves`, no subtree of the row is due, and none is noted against a reference that has gone.
// way = 0: not known, the row is to be looked at.
struct WatchRow {
  double way;
  uint32_t turns, moves;
};

// Written so that a NaN means a look.
VOYAGER_HD bool is_quiet(const WatchRow& row, const Journey& now) {
  return now.way < row.way && row.turns == now.turns &&
         static_cast<int32_t>(row.moves - now.moves) > 0;
}

// What a look finds of one subtree: whether it is due, else for how many metres of way it is not,
// while τ* stays, and for how many moves its reference stays. As it is: a closed subtree.
struct Look {
  bool due = false;
  float slack = INFINITY;
  uint32_t moves = 1u << 30;
};

// current, travel, retired: of References. A subtree whose reference goes in this frame keeps what
// slack is left. So does, where `renews`, one whose reference is half as old: else each subtree
// would have its row looked at again soon.
VOYAGER_HD Look look_at(Watch& watch, const Travel* travel, const Travel& retired, uint32_t current,
                        bool renews) {
  if (watch.slack == INFINITY) return {};
  const uint32_t reference = watch_reference(watch);
  const uint32_t age = (current + kReferences - reference) % kReferences;
  const bool is_due = due(watch, travel), goes = is_due && reference == current;
  const float slack = slack_left(watch, goes ? retired : travel[reference]);
  if (is_due && !(goes && slack > 0.0f)) return {true, INFINITY, kReferences};
  if (!goes && !(renews && age > kReferences / 2 && slack > 0.0f))
    return {false, slack, kReferences - age};
  watch = {slack, (watch.extent_and_reference & ~0xfffu) | current};
  return {false, slack, kReferences};
}

}  // namespace voyager
