#pragma once
#include <zlib.h>

#include <vector>

#include "runtime/scene/export/writer.h"

namespace voyager {

// Passes on what is written as one gzip stream.
class GzipSink final : public ByteSink {
 public:
  // `inner` must outlive it.
  explicit GzipSink(ByteSink& inner);
  ~GzipSink() override;
  GzipSink(const GzipSink&) = delete;
  GzipSink& operator=(const GzipSink&) = delete;

  void write(std::span<const std::byte> bytes) override;
  // Ends the stream; nothing may be written after it.
  void close();

 private:
  void compress(std::span<const std::byte> bytes, int flush);

  ByteSink& inner_;
  z_stream stream_{};
  std::vector<std::byte> block_;
};

}  // namespace voyager
