#pragma once
#include <zstd.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace voyager {

// Appends one zstd frame to `out`; what is added at once ends a block, and so has
// entropy tables of its own.
class Compressor {
 public:
  explicit Compressor(std::vector<std::byte>& out);
  void add(const std::byte* begin, const std::byte* end, bool last);

 private:
  std::unique_ptr<ZSTD_CCtx, size_t (*)(ZSTD_CCtx*)> context_;
  std::vector<std::byte>& out_;
};

}  // namespace voyager
