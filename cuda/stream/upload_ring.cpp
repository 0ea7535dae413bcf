#include "cuda/stream/upload_ring.h"

#include "cuda/interop/external_ring.h"

namespace voyager::cuda {

UploadRing::UploadRing(size_t piece_bytes, size_t pieces)
    : piece_bytes_(piece_bytes), memory_(piece_bytes * pieces) {
  for (size_t i = 0; i < pieces; ++i) {
    read_.emplace_back(kWaitedFor);
    free_.push_back(i);
  }
}

size_t UploadRing::take_index() {
  size_t index = 0;
  {
    std::unique_lock lock(mutex_);
    given_back_.wait(lock, [&] { return !free_.empty(); });
    index = free_.front();
    free_.pop_front();
  }
  try {
    wait_for_host(read_[index]);
  } catch (...) {
    give_back(index);
    throw;
  }
  return index;
}

void UploadRing::give_back(size_t index) {
  {
    const std::lock_guard lock(mutex_);
    free_.push_back(index);
  }
  given_back_.notify_one();
}

}  // namespace voyager::cuda
