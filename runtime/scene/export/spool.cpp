#include "runtime/scene/export/spool.h"

#include <cerrno>
#include <cstring>
#include <new>
#include <string>

#include "runtime/base/error.h"

namespace voyager {
namespace {

[[noreturn]] void fail_io(const char* doing) {
  throw Error(ErrorCode::io, std::string("temporary file: ") + doing + ": " + std::strerror(errno));
}

void check_zstd(size_t code) {
  if (ZSTD_isError(code))
    throw Error(ErrorCode::internal, std::string("zstd: ") + ZSTD_getErrorName(code));
}

class DecompressingSink final : public ByteSink {
 public:
  DecompressingSink(ZSTD_DCtx& context, ByteSink& inner)
      : context_(context), inner_(inner), block_(ZSTD_DStreamOutSize()) {}

  void write(std::span<const std::byte> bytes) override {
    ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
    ZSTD_outBuffer out{};
    do {
      out = {block_.data(), block_.size(), 0};
      check_zstd(ZSTD_decompressStream(&context_, &out, &in));
      inner_.write(std::span(block_).first(out.pos));
    } while (in.pos < in.size || out.pos == out.size);
  }

 private:
  ZSTD_DCtx& context_;
  ByteSink& inner_;
  std::vector<std::byte> block_;
};

}  // namespace

Spool::Spool(uint64_t uncompressed_size)
    : context_(ZSTD_createCCtx()), file_(std::tmpfile()), block_(ZSTD_CStreamOutSize()) {
  if (!file_) fail_io("create");
  if (!context_) throw std::bad_alloc();
  check_zstd(ZSTD_CCtx_setPledgedSrcSize(context_.get(), uncompressed_size));
}

void Spool::write(std::span<const std::byte> bytes) {
  compress(bytes, ZSTD_e_continue);
}
void Spool::close() {
  compress({}, ZSTD_e_end);
}

void Spool::compress(std::span<const std::byte> bytes, ZSTD_EndDirective end) {
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  size_t left = 0;
  do {
    ZSTD_outBuffer out{block_.data(), block_.size(), 0};
    left = ZSTD_compressStream2(context_.get(), &out, &in, end);
    check_zstd(left);
    if (std::fwrite(block_.data(), 1, out.pos, file_.get()) != out.pos) fail_io("write");
    compressed_ += out.pos;
  } while (in.pos < in.size || (end == ZSTD_e_end && left > 0));
}

void Spool::copy_to(ByteSink& sink) {
  if (std::fflush(file_.get()) != 0) fail_io("write");
  std::rewind(file_.get());
  for (uint64_t left = compressed_; left > 0;) {
    const size_t got = std::fread(block_.data(), 1, block_.size(), file_.get());
    if (got == 0) fail_io("read");
    sink.write(std::span(block_).first(got));
    left -= got;
  }
}

void Spool::copy_decompressed_to(ByteSink& sink) {
  const std::unique_ptr<ZSTD_DCtx, Free> context(ZSTD_createDCtx());
  if (!context) throw std::bad_alloc();
  DecompressingSink decompressing(*context, sink);
  copy_to(decompressing);
}

}  // namespace voyager
