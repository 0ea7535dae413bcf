#include "runtime/scene/import/decompress.h"

#include <algorithm>
#include <bit>
#include <new>

#include "runtime/scene/import/refuse.h"

namespace voyager {
namespace {

constexpr size_t kCompressedBytes = 64 * 1024;
constexpr int kMaxWindowLog = 27;
// Of what encoders take by themselves up to level 19, whatever the stream's length.
constexpr int kOrdinaryWindowLog = 23;

// A window beyond the stream's end would only cost memory, which a small file may ask for.
int window_log(uint64_t plain_size) {
  return std::clamp(static_cast<int>(std::bit_width(plain_size)), kOrdinaryWindowLog,
                    kMaxWindowLog);
}

}  // namespace

Decompressor::Decompressor(PeekReader& input)
    : input_(input), name_(input.name() + " (decompressed)") {}

Decompressor::Decompressor(PeekReader& input, const Decompressor& other)
    : input_(input), ended_(other.ended_), name_(other.name_), offset_(other.offset_) {}

void Decompressor::refuse_stream(const std::string& found, const std::string& expected) const {
  refuse(input_.name(), input_.offset(), "compressed stream", found, expected);
}

size_t Decompressor::read(std::span<std::byte> into) {
  size_t made = 0;
  while (made < into.size() && !ended_) {
    const size_t wanted = static_cast<size_t>(std::min<uint64_t>(kCompressedBytes, bytes_left()));
    const std::span<const std::byte> in = input_.peek(wanted);
    const Step done = step(in, into.subspan(made));
    if (!ended_ && done.taken == 0 && done.made == 0) {
      input_.skip(in.size());
      refuse_stream("the end of the stream", "more compressed bytes");
    }
    input_.skip(done.taken);
    consumed(done.taken);
    made += done.made;
  }
  offset_ += made;
  return made;
}

void Decompressor::finish() {
  std::byte one;
  if (read(std::span(&one, 1)) != 0)
    refuse(name_, offset_ - 1, "length", "more bytes", "the end, as the header says");
  if (has_more()) refuse_stream("more bytes after its end", "none");
}

GzipReader::GzipReader(PeekReader& input) : Decompressor(input) {
  if (inflateInit2(&stream_, 16 + MAX_WBITS) != Z_OK) throw std::bad_alloc();
}

GzipReader::GzipReader(PeekReader& input, const GzipReader& other) : Decompressor(input, other) {
  // zlib's interface is not const-correct; it only reads from its source.
  if (inflateCopy(&stream_, const_cast<z_stream*>(&other.stream_)) != Z_OK) throw std::bad_alloc();
}

GzipReader::~GzipReader() {
  inflateEnd(&stream_);
}

Decompressor::Step GzipReader::step(std::span<const std::byte> in, std::span<std::byte> out) {
  const size_t room = std::min<size_t>(out.size(), 1u << 30);  // zlib counts in 32 bits
  // zlib's interface is not const-correct; it does not write to its input.
  stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(in.data()));
  stream_.avail_in = static_cast<uInt>(in.size());
  stream_.next_out = reinterpret_cast<Bytef*>(out.data());
  stream_.avail_out = static_cast<uInt>(room);
  const int code = inflate(&stream_, Z_NO_FLUSH);
  if (code == Z_MEM_ERROR) throw std::bad_alloc();
  if (code != Z_OK && code != Z_STREAM_END && code != Z_BUF_ERROR)
    refuse_stream(stream_.msg ? stream_.msg : "an error of zlib", "gzip data that matches its CRC");
  ended_ = code == Z_STREAM_END;
  return {in.size() - stream_.avail_in, room - stream_.avail_out};
}

ZstdReader::ZstdReader(PeekReader& input, uint64_t compressed_size, uint64_t plain_size)
    : Decompressor(input), context_(ZSTD_createDCtx()), left_(compressed_size) {
  if (!context_) throw std::bad_alloc();
  ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, window_log(plain_size));
}

Decompressor::Step ZstdReader::step(std::span<const std::byte> in, std::span<std::byte> out) {
  ZSTD_inBuffer source{in.data(), in.size(), 0};
  ZSTD_outBuffer target{out.data(), out.size(), 0};
  const size_t code = ZSTD_decompressStream(context_.get(), &target, &source);
  if (ZSTD_isError(code)) refuse_stream(ZSTD_getErrorName(code), "a valid zstd frame");
  ended_ = code == 0;
  return {source.pos, target.pos};
}

}  // namespace voyager
