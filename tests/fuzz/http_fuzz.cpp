// What a server sends, byte by byte, through libcurl: a source that reads what it was sent, or one
// line that says what is wrong.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "http/source.h"
#include "runtime/base/error.h"
#include "tests/fuzz/canned_server.h"
#include "tests/fuzz/memory_limit.h"

namespace voyager::fuzz {
namespace {

constexpr char kSeparator = '\x1e';
constexpr uint64_t kMost = 100'000;  // bytes of a read

void check(const Error& error) {
  using Code = ErrorCode;
  constexpr Code kRight[] = {Code::io_transient, Code::file_not_found, Code::io,
                             Code::refused_input};
  const std::string text = error.what();
  if (std::find(std::begin(kRight), std::end(kRight), error.code()) != std::end(kRight) &&
      text.size() < 1000 && text.find('\n') == std::string::npos)
    return;
  std::fprintf(stderr, "error %d: %s\n", static_cast<int>(error.code()), text.c_str());
  std::abort();
}

http::Options options() {
  http::Options options;
  options.connections = 1;
  options.stall_time = options.deadline = std::chrono::milliseconds(1000);
  options.tries = 2;
  options.first_wait = std::chrono::milliseconds(0);
  options.redirects = 2;
  return options;
}

// A piece from the end and a piece from the start, of whatever size the server claims.
void read(const http::Source& source) {
  for (const bool from_end : {true, false}) {
    const uint64_t count = std::min(source.size(), kMost);
    std::vector<std::byte> bytes(count);
    try {
      source.read(from_end ? source.size() - count : 0, bytes);
    } catch (const Error& error) {
      check(error);
    }
  }
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace voyager;
  static auto& server = *new fuzz::CannedServer;
  const fuzz::MemoryLimit limit(size);
  server.answer({reinterpret_cast<const char*>(data), size}, fuzz::kSeparator);
  try {
    fuzz::read(http::Source("http://fuzz/scene.voy", fuzz::options()));
  } catch (const Error& error) {
    fuzz::check(error);
  }
  server.answer({}, fuzz::kSeparator);
  return 0;
}
