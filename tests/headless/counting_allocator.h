#pragma once
// A host's allocator that knows what it has given.
#include <voyager/voyager.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

// Counts what is out, and refuses the allocation with the number `failing`.
struct CountingAllocator {
  std::atomic<int64_t> bytes_out{0}, most{0}, allocations{0};
  int64_t failing = -1;
  bool throws = false;

  static void* allocate(void* user, size_t size, size_t alignment) {
    auto* self = static_cast<CountingAllocator*>(user);
    if (self->allocations++ == self->failing) {
      if (self->throws) throw std::runtime_error("the host's own trouble");
      return nullptr;
    }
    void* memory = nullptr;
    if (posix_memalign(&memory, alignment < sizeof(void*) ? sizeof(void*) : alignment, size) != 0)
      return nullptr;
    self->most = std::max<int64_t>(self->most, self->bytes_out += static_cast<int64_t>(size));
    return memory;
  }
  static void release(void* user, void* memory, size_t size, size_t) {
    static_cast<CountingAllocator*>(user)->bytes_out -= static_cast<int64_t>(size);
    std::free(memory);
  }
  VoyAllocator desc() { return {VOY_STRUCTURE_TYPE_ALLOCATOR, nullptr, this, allocate, release}; }
};
