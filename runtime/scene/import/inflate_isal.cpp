#include <isa-l/igzip_lib.h>

#include <algorithm>

#include "runtime/scene/import/inflate.h"

namespace voyager {
namespace {

const char* problem_of(int code) {
  switch (code) {
    case ISAL_DECOMP_OK:
      return nullptr;
    case ISAL_INVALID_WRAPPER:
    case ISAL_UNSUPPORTED_METHOD:
      return "no gzip header";
    case ISAL_INCORRECT_CHECKSUM:
      return "another checksum or length";
    default:
      return "damaged data";
  }
}

}  // namespace

// No pointer in it points into it, so that it can be copied.
struct Inflate::State {
  inflate_state stream;

  State() {
    isal_inflate_init(&stream);
    stream.crc_flag = ISAL_GZIP;
  }
};

Inflate::Inflate() : state_(std::make_unique<State>()) {}
Inflate::Inflate(const Inflate& other) : state_(std::make_unique<State>(*other.state_)) {}
Inflate::~Inflate() = default;

Inflate::Step Inflate::step(std::span<const std::byte> in, std::span<std::byte> out) {
  inflate_state& stream = state_->stream;
  const size_t room = std::min<size_t>(out.size(), 1u << 30);  // ISA-L counts in 32 bits
  // ISA-L's interface is not const-correct; it does not write to its input.
  stream.next_in = reinterpret_cast<uint8_t*>(const_cast<std::byte*>(in.data()));
  stream.avail_in = static_cast<uint32_t>(in.size());
  stream.next_out = reinterpret_cast<uint8_t*>(out.data());
  stream.avail_out = static_cast<uint32_t>(room);
  const int code = isal_inflate(&stream);
  const bool ended = code == ISAL_DECOMP_OK && stream.block_state == ISAL_BLOCK_FINISH;
  return {in.size() - stream.avail_in, room - stream.avail_out, ended, problem_of(code)};
}

}  // namespace voyager
