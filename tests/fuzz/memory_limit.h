#pragma once
// Holds what one input may take to what its bytes justify: a small file that costs much is a
// finding, whatever the program took before. Only under Clang's AddressSanitizer, with which the
// fuzzers are built.
#include <cstddef>

namespace voyager::fuzz {

// While it lives, memory taken beyond what was in use at its start, by any thread, ends the run
// with the stack that asked for it: above 64 MiB and 64 bytes for each byte of the input.
class MemoryLimit {
 public:
  explicit MemoryLimit(size_t input_bytes);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;
};

}  // namespace voyager::fuzz
