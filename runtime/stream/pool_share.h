#pragma once
// A view's part in the budget of a scene that is streamed: room for what an instance's search
// keeps.
#include "runtime/stream/scene_stream.h"

namespace voyager {

class PoolShare {
 public:
  // The pool may lose some of its room for it, and then all but the top of the tree. Throws
  // Error(over_budget), whose message names what it takes, and what SceneStream::set_budget()
  // throws; nothing has changed then. Both outlive it.
  PoolShare(SceneStream& stream, PoolReaderState& state, Workers& workers)
      : stream_(stream), state_(state) {
    stream_.add_state(state_, workers);
  }
  ~PoolShare() { stream_.remove_state(state_); }
  PoolShare(const PoolShare&) = delete;
  PoolShare& operator=(const PoolShare&) = delete;

 private:
  SceneStream& stream_;
  PoolReaderState& state_;
};

}  // namespace voyager
