#pragma once
// Aligned memory for reads past the page cache: one buffer a read in flight, kept for the next.
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace voyager {

class BounceBuffers {
 public:
  // What direct reads must be a multiple of, on every device that has 4 KiB blocks or smaller.
  static constexpr size_t kAlign = 4096;
  static constexpr size_t kBytes = size_t{1} << 20;

 private:
  struct Free {
    void operator()(std::byte* bytes) const { ::operator delete (bytes, std::align_val_t{kAlign}); }
  };
  using Memory = std::unique_ptr<std::byte, Free>;

 public:
  // Goes back when it dies, so not after the BounceBuffers.
  class Buffer {
   public:
    Buffer(BounceBuffers& from, Memory memory) : from_(from), memory_(std::move(memory)) {}
    ~Buffer() { from_.give_back(std::move(memory_)); }
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    std::span<std::byte> bytes() const { return {memory_.get(), kBytes}; }

   private:
    BounceBuffers& from_;
    Memory memory_;
  };

  // Thread-safe. Throws std::bad_alloc.
  Buffer take() {
    {
      const std::lock_guard lock(mutex_);
      if (!spare_.empty()) {
        Memory memory = std::move(spare_.back());
        spare_.pop_back();
        return Buffer(*this, std::move(memory));
      }
      spare_.reserve(++made_);  // so that giving back allocates nothing
    }
    return Buffer(
        *this, Memory(static_cast<std::byte*>(::operator new (kBytes, std::align_val_t{kAlign}))));
  }

 private:
  void give_back(Memory memory) noexcept {
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(memory));
  }

  std::mutex mutex_;
  std::vector<Memory> spare_;
  size_t made_ = 0;
};

}  // namespace voyager
