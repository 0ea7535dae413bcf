#include "runtime/scene/export/gzip_sink.h"

#include <algorithm>
#include <limits>
#include <new>
#include <string>

#include "runtime/base/error.h"

namespace voyager {
namespace {

constexpr int kGzip = 16;  // that zlib adds to the window's bits
constexpr int kMemoryLevel = 8;

}  // namespace

GzipSink::GzipSink(ByteSink& inner) : inner_(inner), block_(1 << 16) {
  const int result = deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS + kGzip,
                                  kMemoryLevel, Z_DEFAULT_STRATEGY);
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  if (result != Z_OK) throw Error(ErrorCode::internal, "zlib: deflateInit2 failed");
}

GzipSink::~GzipSink() {
  deflateEnd(&stream_);
}

void GzipSink::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {  // zlib counts in 32 bits
    const size_t count = std::min<size_t>(bytes.size(), std::numeric_limits<uInt>::max());
    compress(bytes.first(count), Z_NO_FLUSH);
    bytes = bytes.subspan(count);
  }
}

void GzipSink::close() {
  compress({}, Z_FINISH);
}

void GzipSink::compress(std::span<const std::byte> bytes, int flush) {
  stream_.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
  stream_.avail_in = static_cast<uInt>(bytes.size());
  do {
    stream_.next_out = reinterpret_cast<Bytef*>(block_.data());
    stream_.avail_out = static_cast<uInt>(block_.size());
    if (deflate(&stream_, flush) == Z_STREAM_ERROR)
      throw Error(ErrorCode::internal, "zlib: deflate failed");
    inner_.write(std::span(block_).first(block_.size() - stream_.avail_out));
  } while (stream_.avail_out == 0);
}

}  // namespace voyager
