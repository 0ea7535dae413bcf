#include "plugin/memory.h"

#include <algorithm>
#include <new>

#include "runtime/base/error.h"
#include "runtime/base/megabytes.h"

namespace voyager {

void* HostMemory::do_allocate(size_t size, size_t alignment) {
  void* memory = nullptr;
  try {
    memory = allocator_.allocate(allocator_.user, size, alignment);
  } catch (...) {
    throw std::bad_alloc();
  }
  if (memory == nullptr) throw std::bad_alloc();
  if (reinterpret_cast<uintptr_t>(memory) % alignment != 0) {
    do_deallocate(memory, size, alignment);
    throw Error(ErrorCode::invalid_argument,
                "VoyAllocator.allocate: found memory that is not aligned to the " +
                    std::to_string(alignment) + " bytes asked for");
  }
  return memory;
}

void HostMemory::do_deallocate(void* memory, size_t size, size_t alignment) {
  try {
    allocator_.deallocate(allocator_.user, memory, size, alignment);
  } catch (...) {
    // Called from destructors: there is nobody to tell.
  }
}

void Budget::take(uint64_t bytes) {
  uint64_t used = used_.load(std::memory_order_relaxed);
  do {
    if (limit_ == 0 || (used <= limit_ && bytes <= limit_ - used)) continue;
    const uint64_t needed = used + std::min(bytes, UINT64_MAX - used);
    throw Error(ErrorCode::over_budget, "scene data needs at least " + megabytes_text(needed) +
                                            ", the memory budget allows " + megabytes_text(limit_));
  } while (!used_.compare_exchange_weak(used, used + bytes, std::memory_order_relaxed));
}

uint64_t Budget::left() const {
  const uint64_t used = used_.load(std::memory_order_relaxed);
  return limit_ == 0 ? UINT64_MAX : limit_ - std::min(limit_, used);
}

void SceneMemory::count(uint64_t used, uint64_t reserved) {
  const uint64_t before = std::max(used_, reserved_), now = std::max(used, reserved);
  if (now > before) budget_.take(now - before);
  if (now < before) budget_.give_back(before - now);
  used_ = used;
  reserved_ = reserved;
}

void SceneMemory::reserve(uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  count(used_, bytes);
}

uint64_t SceneMemory::counted() const {
  const std::lock_guard lock(mutex_);
  return std::max(used_, reserved_);
}

void SceneMemory::add(uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  count(used_ + bytes, reserved_);
}

void SceneMemory::subtract(uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  count(used_ - bytes, reserved_);
}

void* SceneMemory::do_allocate(size_t size, size_t alignment) {
  add(size);
  try {
    return upstream_->allocate(size, alignment);
  } catch (...) {
    subtract(size);
    throw;
  }
}

void SceneMemory::do_deallocate(void* memory, size_t size, size_t alignment) {
  upstream_->deallocate(memory, size, alignment);
  subtract(size);
}

}  // namespace voyager
