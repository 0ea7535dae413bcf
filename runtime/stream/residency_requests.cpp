// In which order what a plan asks for is read.
#include <algorithm>
#include <utility>

#include "runtime/stream/residency.h"

namespace voyager {

void Residency::set_shown(ShownChunks shown) {
  shown_ = std::move(shown);
  order_requests();
}

// The last request is read first. asked_ ends with what will be seen soon and what is seen: hidden
// chunks only move in front of these, and nothing is sorted.
void Residency::order_requests() {
  std::erase_if(asked_, [&](uint32_t chunk) { return known(chunk).state != State::absent; });
  find_hidden();
  requests_ = asked_;
  std::stable_partition(requests_.begin(), requests_.end(),
                        [&](uint32_t chunk) { return turn(chunk) <= Turn::hidden; });
}

Residency::Turn Residency::turn(uint32_t chunk) const {
  constexpr Turn kByClass[] = {Turn::around, Turn::turned, Turn::soon, Turn::seen};
  if (chunk < pinned_) return Turn::pinned;
  if (known(chunk).hidden) return Turn::hidden;
  return kByClass[static_cast<size_t>(ChunkLooks::class_of(known(chunk).urgency))];
}

// Nothing comes before what it hangs from: that is behind it in asked_, and hides it where it is
// hidden itself.
void Residency::find_hidden() {
  for (size_t i = asked_.size(); i-- > 0;) know(asked_[i]).hidden = is_hidden(asked_[i]);
  for (const uint32_t chunk : asked_)
    if (turn(chunk) > Turn::hidden)
      for (const uint32_t p : graph_->parents(chunk))
        if (known(p).hidden) know(p).hidden = false;
}

// In the place of a chunk that is not there its parents are drawn.
bool Residency::is_hidden(uint32_t chunk) const {
  using Class = ChunkLooks::Class;
  if (!wants_shown() || chunk < pinned_ ||
      ChunkLooks::class_of(known(chunk).urgency) != Class::seen)
    return false;
  bool hidden = false;
  for (const uint32_t p : graph_->parents(chunk)) {
    const Known& parent = known(p);
    Shown shown = parent.hidden ? Shown::no : Shown::yes;
    if (parent.state == State::resident)
      shown = parent.slot < shown_.size() ? shown_[parent.slot] : Shown::unknown;
    if (shown == Shown::yes) return false;
    hidden = hidden || shown == Shown::no;
  }
  return hidden;
}

}  // namespace voyager
