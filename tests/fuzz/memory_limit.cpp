#include "tests/fuzz/memory_limit.h"

// Of Clang's AddressSanitizer, which the fuzzers are built with: GCC's comes without the header.
#if defined(__has_feature) && defined(__has_include)
#if __has_feature(address_sanitizer) && __has_include(<sanitizer/allocator_interface.h>)
#define VOYAGER_COUNTS_MEMORY
#endif
#endif

#ifdef VOYAGER_COUNTS_MEMORY
#include <sanitizer/allocator_interface.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#endif

namespace voyager::fuzz {

#ifdef VOYAGER_COUNTS_MEMORY
namespace {

std::atomic<int64_t> in_use{0}, most{INT64_MAX};

void on_malloc(const volatile void*, size_t bytes) {
  const int64_t now = in_use += static_cast<int64_t>(bytes);
  if (now <= most) return;
  most = INT64_MAX;  // saying so takes memory, too
  std::fprintf(stderr, "memory: found %zu bytes asked for, beyond what the input justifies\n",
               bytes);
  std::abort();
}

void on_free(const volatile void* at) {
  in_use -= static_cast<int64_t>(__sanitizer_get_allocated_size(at));
}

}  // namespace

MemoryLimit::MemoryLimit(size_t input_bytes) {
  static const int installed = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
  if (installed == 0) std::abort();
  most = in_use + (int64_t{64} << 20) + int64_t{64} * static_cast<int64_t>(input_bytes);
}

MemoryLimit::~MemoryLimit() {
  most = INT64_MAX;
}
#else
MemoryLimit::MemoryLimit(size_t) {}
MemoryLimit::~MemoryLimit() = default;
#endif

}  // namespace voyager::fuzz
