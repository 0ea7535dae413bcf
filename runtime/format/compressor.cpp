#include "runtime/format/compressor.h"

#include <new>

#include "runtime/base/error.h"

namespace voyager {
namespace {

// Blocks of a hundred bytes to a few thousand are about entropy, not matches: higher
// levels find no more.
constexpr int kLevel = 1;

}  // namespace

Compressor::Compressor(std::vector<std::byte>& out)
    : context_(ZSTD_createCCtx(), &ZSTD_freeCCtx), out_(out) {
  if (!context_) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kLevel);
}

void Compressor::add(const std::byte* begin, const std::byte* end, bool last) {
  ZSTD_inBuffer in{begin, static_cast<size_t>(end - begin), 0};
  for (size_t left = 1; left != 0;) {
    const size_t start = out_.size();
    out_.resize(start + ZSTD_compressBound(in.size - in.pos));
    ZSTD_outBuffer room{out_.data() + start, out_.size() - start, 0};
    left = ZSTD_compressStream2(context_.get(), &room, &in, last ? ZSTD_e_end : ZSTD_e_flush);
    out_.resize(start + room.pos);
    if (ZSTD_isError(left)) throw Error(ErrorCode::internal, ZSTD_getErrorName(left));
  }
}

}  // namespace voyager
