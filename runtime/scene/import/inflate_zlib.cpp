#include <zlib.h>

#include <algorithm>
#include <new>

#include "runtime/scene/import/inflate.h"

namespace voyager {

struct Inflate::State {
  z_stream stream = {};

  State() {
    if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) throw std::bad_alloc();
  }
  // zlib's interface is not const-correct; it only reads from its source.
  State(const State& other) {
    if (inflateCopy(&stream, const_cast<z_stream*>(&other.stream)) != Z_OK) throw std::bad_alloc();
  }
  ~State() { inflateEnd(&stream); }
  State& operator=(const State&) = delete;
};

Inflate::Inflate() : state_(std::make_unique<State>()) {}
Inflate::Inflate(const Inflate& other) : state_(std::make_unique<State>(*other.state_)) {}
Inflate::~Inflate() = default;

Inflate::Step Inflate::step(std::span<const std::byte> in, std::span<std::byte> out) {
  z_stream& stream = state_->stream;
  const size_t room = std::min<size_t>(out.size(), 1u << 30);  // zlib counts in 32 bits
  // zlib does not write to its input.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(in.data()));
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(room);
  const int code = ::inflate(&stream, Z_NO_FLUSH);
  if (code == Z_MEM_ERROR) throw std::bad_alloc();
  const bool sound = code == Z_OK || code == Z_STREAM_END || code == Z_BUF_ERROR;
  const char* problem = stream.msg ? stream.msg : "an error of zlib";
  return {in.size() - stream.avail_in, room - stream.avail_out, code == Z_STREAM_END,
          sound ? nullptr : problem};
}

}  // namespace voyager
