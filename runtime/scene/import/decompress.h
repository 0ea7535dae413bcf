#pragma once
// Compressed streams as plain ones. name() and offset() are those of the plain
// bytes; refusals of the compressed ones name the file and its own offset.
// Memory is bounded whatever the input says: one block, and a window of at
// most 32 KiB (gzip), or 8 MiB or what the stream holds, up to 128 MiB (zstd).
#include <zlib.h>
#include <zstd.h>

#include <memory>

#include "runtime/scene/import/peek_reader.h"

namespace voyager {

class Decompressor : public ByteReader {
 public:
  explicit Decompressor(PeekReader& input);
  // Refuses plain or compressed bytes beyond those that were read.
  void finish();

  const std::string& name() const override { return name_; }
  size_t read(std::span<std::byte> into) override;
  std::optional<uint64_t> remaining() const override { return std::nullopt; }
  uint64_t offset() const override { return offset_; }

 protected:
  // One that goes on where another stands.
  Decompressor(PeekReader& input, const Decompressor& other);

  struct Step {
    size_t taken, made;
  };
  // Consumes from `in`, fills `out`; sets ended_ where the stream ends. Neither
  // taken nor made means that it needs more input.
  virtual Step step(std::span<const std::byte> in, std::span<std::byte> out) = 0;
  // Compressed bytes that belong to this stream and are still to come, at most.
  virtual uint64_t bytes_left() const = 0;
  virtual bool has_more() = 0;  // compressed bytes after the stream's end
  virtual void consumed(uint64_t) {}
  [[noreturn]] void refuse_stream(const std::string& found, const std::string& expected) const;

  PeekReader& input_;
  bool ended_ = false;

 private:
  std::string name_;
  uint64_t offset_ = 0;
};

// One gzip member that runs to the end of the file.
class GzipReader final : public Decompressor {
 public:
  explicit GzipReader(PeekReader& input);
  // Goes on where `other` stands. So must `input`, in the same bytes.
  GzipReader(PeekReader& input, const GzipReader& other);
  ~GzipReader() override;
  GzipReader(const GzipReader&) = delete;
  GzipReader& operator=(const GzipReader&) = delete;

 private:
  Step step(std::span<const std::byte> in, std::span<std::byte> out) override;
  uint64_t bytes_left() const override { return UINT64_MAX; }
  bool has_more() override { return !input_.peek(1).empty(); }

  z_stream stream_ = {};
};

// One zstd frame in `compressed_size` bytes, which decompress to `plain_size`.
class ZstdReader final : public Decompressor {
 public:
  ZstdReader(PeekReader& input, uint64_t compressed_size, uint64_t plain_size);

 private:
  Step step(std::span<const std::byte> in, std::span<std::byte> out) override;
  uint64_t bytes_left() const override { return left_; }
  bool has_more() override { return left_ > 0; }
  void consumed(uint64_t count) override { left_ -= count; }

  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  std::unique_ptr<ZSTD_DCtx, Free> context_;
  uint64_t left_;
};

}  // namespace voyager
