#pragma once
#include <array>
#include <cstdint>

#include "runtime/select/cut.h"
#include "runtime/select/watch.h"

namespace voyager {

// The places that verdicts were found at, in a ring. A frame at the place of the
// frame before shares its reference, so that nothing expires while nothing moves.
class References {
 public:
  // Forgets all: what was noted against them is to be visited again.
  void clear() { used_ = 0; }

  // Enters a frame. Where it takes over the slot of the oldest reference, what is
  // noted against that slot has to be noted anew: it is due, since travel() says +inf
  // for it, but where slack is left after retired() it may keep that instead.
  void begin_frame(const CutQuery& query);

  // Against which subtrees visited in this frame are noted.
  uint32_t current() const { return current_; }
  const std::array<Travel, kReferences>& travel() const { return travel_; }
  // From the reference whose slot current() has taken over in this frame; +inf: none.
  const Travel& retired() const { return retired_; }
  // How far all frames have gone, which no way between two of them exceeds.
  const Journey& journey() const { return journey_; }

 private:
  std::array<CutQuery, kReferences> references_{};
  std::array<Travel, kReferences> travel_{};
  Travel retired_{};
  Journey journey_{};
  uint32_t used_ = 0;  // slots in use
  uint32_t current_ = 0;
};

}  // namespace voyager
