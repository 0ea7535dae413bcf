#pragma once
// Memory that says how much of it is out.
#include <atomic>
#include <cstddef>
#include <memory_resource>

namespace voyager::test {

class CountingMemory final : public std::pmr::memory_resource {
 public:
  size_t used() const { return used_; }

 private:
  void* do_allocate(size_t bytes, size_t alignment) override {
    used_ += bytes;
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* p, size_t bytes, size_t alignment) override {
    used_ -= bytes;
    std::pmr::new_delete_resource()->deallocate(p, bytes, alignment);
  }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
  std::atomic<size_t> used_{0};
};

}  // namespace voyager::test
