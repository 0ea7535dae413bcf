#pragma once
// Pieces of mapped memory, each for some chunks on their way to a device.
#include <condition_variable>
#include <deque>
#include <mutex>

#include "cuda/device/mapped_memory.h"
#include "cuda/device/stream.h"

namespace voyager::cuda {

class UploadRing {
 public:
  UploadRing(size_t piece_bytes, size_t pieces);

  // One that nobody else has, and that the device has read; given back where it goes out of scope.
  class Piece {
   public:
    Piece(UploadRing& ring, size_t index) : ring_(ring), index_(index) {}
    ~Piece() { ring_.give_back(index_); }
    Piece(const Piece&) = delete;
    Piece& operator=(const Piece&) = delete;

    unsigned char* host() const { return ring_.memory_.host() + index_ * ring_.piece_bytes_; }
    const unsigned char* device() const {
      return ring_.memory_.device() + index_ * ring_.piece_bytes_;
    }
    // What was launched on the stream so far has to end before anyone has the piece again.
    void read_by(cudaStream_t stream) const { ring_.read_[index_].record(stream); }

   private:
    UploadRing& ring_;
    size_t index_;
  };
  // Waits until there is one. Any thread, whose context is the device's.
  Piece take() { return Piece(*this, take_index()); }

 private:
  size_t take_index();
  void give_back(size_t index);

  const size_t piece_bytes_;
  MappedMemory memory_;
  std::deque<Event> read_;  // of each piece
  std::mutex mutex_;
  std::condition_variable given_back_;
  std::deque<size_t> free_;  // those that the device may still read; the oldest first
};

}  // namespace voyager::cuda
