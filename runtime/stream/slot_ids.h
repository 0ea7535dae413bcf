#pragma once
// Which nodes a slot holds. They lie in it in the order of their ids, of which a chunk has few
// runs: one for each level of its tier, and where it goes on into the next tier two more.
#include <cstdint>
#include <span>

#include "runtime/math/host_device.h"

namespace voyager {

struct SlotIds {
  static constexpr uint32_t kRuns = 5;

  uint32_t offset[kRuns];     // of each run: a node's id less its place, modulo 2^32
  uint16_t begin[kRuns - 1];  // places where the later runs begin: a chunk has 2^15 at most

  VOYAGER_HD uint32_t id(uint32_t place) const {
    uint32_t run = 0;
    for (uint32_t i = 0; i + 1 < kRuns; ++i) run += place >= begin[i];
    return place + offset[run];
  }
};

// ids: by place, fewer than 2^16. False where they have more runs.
inline bool make_slot_ids(std::span<const uint32_t> ids, SlotIds& out) {
  constexpr uint16_t kNone = 0xffff;
  for (uint16_t& begin : out.begin) begin = kNone;
  for (uint32_t& offset : out.offset) offset = 0;
  uint32_t run = 0;
  for (uint32_t place = 0; place < ids.size(); ++place) {
    if (place != 0 && ids[place] != ids[place - 1] + 1) {
      if (++run == SlotIds::kRuns) return false;
      out.begin[run - 1] = static_cast<uint16_t>(place);
    }
    out.offset[run] = ids[place] - place;
  }
  return true;
}

}  // namespace voyager
