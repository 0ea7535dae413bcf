#pragma once
// What is known of a few of a scene's chunks.
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/stream/sparse_array.h"

namespace voyager {

template <class Known>
class ByChunk {
 public:
  explicit ByChunk(size_t chunks) : at_(chunks), known_(1) {}
  // So many can be known before it takes more memory.
  void reserve(size_t most) { known_.reserve(most + 1); }

  // Known{} where nothing is known of the chunk. No reference outlives know() or forget().
  const Known& operator[](uint32_t chunk) const { return known_[at_[chunk]].of; }
  // To be changed; from now on it is known.
  Known& know(uint32_t chunk) {
    if (const uint32_t at = at_[chunk]; at != 0) return known_[at].of;
    if (known_.size() == known_.capacity()) known_.reserve(2 * known_.size());
    at_.set(chunk, static_cast<uint32_t>(known_.size()));
    known_.push_back({chunk, {}});  // throws nothing, so that the place is never another's
    return known_.back().of;
  }
  // To be changed, of one that is known.
  Known& known(uint32_t chunk) { return known_[at_[chunk]].of; }
  void forget(uint32_t chunk) {
    const uint32_t at = at_[chunk];
    if (at == 0) return;
    at_.set(chunk, 0);
    if (at + 1 != known_.size()) {
      known_[at] = std::move(known_.back());
      at_.set(known_[at].chunk, at);
    }
    known_.pop_back();
  }
  // What one takes that is known.
  static constexpr size_t known_bytes() { return sizeof(Entry); }
  // Those that are known, in any order: visit(chunk, Known&), which neither makes one known nor
  // forgets one.
  template <class Visit>
  void each(const Visit& visit) {
    for (size_t i = 1; i < known_.size(); ++i) visit(known_[i].chunk, known_[i].of);
  }

 private:
  struct Entry {
    uint32_t chunk = 0;
    Known of{};
  };
  SparseArray<uint32_t> at_;  // by chunk, its place in known_; 0 where nothing is known
  std::vector<Entry> known_;  // the first is Known{}
};

}  // namespace voyager
