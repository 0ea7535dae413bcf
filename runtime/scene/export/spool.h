#pragma once
// One zstd frame that grows on disk until its turn in the file comes.
#include <zstd.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <vector>

#include "runtime/scene/export/writer.h"

namespace voyager {

class Spool {
 public:
  // uncompressed_size is what will be written in all. Throws Error(io).
  explicit Spool(uint64_t uncompressed_size);
  void write(std::span<const std::byte> bytes);
  // Ends the frame; nothing may be written after it.
  void close();
  uint64_t compressed_size() const { return compressed_; }
  void copy_to(ByteSink& sink);
  // What was written, as it was.
  void copy_decompressed_to(ByteSink& sink);

 private:
  struct Free {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void compress(std::span<const std::byte> bytes, ZSTD_EndDirective end);

  std::unique_ptr<ZSTD_CCtx, Free> context_;
  std::unique_ptr<std::FILE, Free> file_;
  std::vector<std::byte> block_;
  uint64_t compressed_ = 0;
};

}  // namespace voyager
