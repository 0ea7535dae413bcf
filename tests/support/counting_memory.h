#pragma once
// Memory that says how much of it is out, and was at most.
#include <atomic>
#include <cstddef>
#include <memory_resource>

namespace voyager::test {

class CountingMemory final : public std::pmr::memory_resource {
 public:
  size_t used() const { return used_; }
  // Since it was made, or since start_again().
  size_t most() const { return most_; }
  void start_again() { most_ = used_.load(); }

 private:
  void* do_allocate(size_t bytes, size_t alignment) override {
    const size_t now = used_ += bytes;
    for (size_t most = most_; most < now && !most_.compare_exchange_weak(most, now);) continue;
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* p, size_t bytes, size_t alignment) override {
    used_ -= bytes;
    std::pmr::new_delete_resource()->deallocate(p, bytes, alignment);
  }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
  std::atomic<size_t> used_{0}, most_{0};
};

}  // namespace voyager::test
