#pragma once
// The host's allocator and the device's memory budget as std::pmr sees them.
#include <atomic>
#include <cstdint>
#include <memory_resource>
#include <mutex>

#include "voyager/voyager.h"

namespace voyager {

class HostMemory final : public std::pmr::memory_resource {
 public:
  explicit HostMemory(const VoyAllocator& allocator) : allocator_(allocator) {}

 private:
  // std::bad_alloc where the host returns NULL, throws, or ignores the alignment.
  void* do_allocate(size_t size, size_t alignment) override;
  void do_deallocate(void* memory, size_t size, size_t alignment) override;
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  VoyAllocator allocator_;
};

// Bytes of scene data on one device. Thread-safe.
class Budget {
 public:
  explicit Budget(uint64_t limit) : limit_(limit) {}
  void take(uint64_t bytes);  // throws Error(over_budget)
  // All where there is no limit.
  uint64_t left() const;
  void give_back(uint64_t bytes) { used_.fetch_sub(bytes, std::memory_order_relaxed); }

 private:
  const uint64_t limit_;  // 0: none
  std::atomic<uint64_t> used_{0};
};

// The memory of one scene: counted, and held to the device's budget. Thread-safe.
class SceneMemory final : public std::pmr::memory_resource {
 public:
  SceneMemory(std::pmr::memory_resource* upstream, Budget& budget)
      : upstream_(upstream), budget_(budget) {}
  ~SceneMemory() override { budget_.give_back(counted()); }
  // Counts so many bytes at least: of a scene that is streamed, what its views have not taken yet,
  // and what comes from elsewhere. Throws Error(over_budget), and nothing has changed.
  void reserve(uint64_t bytes);
  // What it takes of the budget.
  uint64_t counted() const;

 private:
  void* do_allocate(size_t size, size_t alignment) override;
  void do_deallocate(void* memory, size_t size, size_t alignment) override;
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  // With the lock held; no call of the host's is made then.
  void count(uint64_t used, uint64_t reserved);
  void add(uint64_t bytes);
  void subtract(uint64_t bytes);

  std::pmr::memory_resource* upstream_;
  Budget& budget_;
  mutable std::mutex mutex_;
  uint64_t used_ = 0, reserved_ = 0;  // the greater counts
};

}  // namespace voyager
