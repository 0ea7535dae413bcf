// Headers as a server may send them: ranges that make sense, answers that fit what was asked, or
// one line that says what is wrong. An empty line ends an answer; the first that is accepted says
// which version the others must have.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "http/reply.h"
#include "runtime/base/error.h"
#include "runtime/base/url.h"
#include "tests/fuzz/memory_limit.h"

namespace voyager::fuzz {
namespace {

using http::Accepted, http::ByteRange, http::FileVersion, http::ReplyHead;

void expect(bool right) {
  if (!right) std::abort();
}

void check_range(std::string_view text) {
  const auto found = http::parse_content_range(text);
  if (found && found->range)
    expect(found->range->first <= found->range->last && found->range->last < found->size);
}

// The bytes that follow fit where they are wanted.
void check_accepted(const Accepted& accepted, const ByteRange& asked) {
  expect(accepted.body <= asked.size());
  expect(accepted.body == 0 || accepted.version.size >= asked.first + accepted.body);
}

void check_message(const Error& error) {
  using Code = ErrorCode;
  constexpr Code kRight[] = {Code::io_transient, Code::file_not_found, Code::io,
                             Code::refused_input};
  expect(std::find(std::begin(kRight), std::end(kRight), error.code()) != std::end(kRight));
  const std::string text = error.what();
  expect(text.size() < 1000 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }));
}

ByteRange take_range(std::string_view& bytes) {
  uint64_t ends[2] = {0, 0};
  const size_t count = std::min(bytes.size(), sizeof ends);
  std::memcpy(ends, bytes.data(), count);
  bytes.remove_prefix(count);
  return {std::min(ends[0], ends[1]), std::max(ends[0], ends[1])};
}

void read_heads(std::string_view bytes) {
  const ByteRange asked = take_range(bytes);
  if (asked.size() == 0) return;  // of all 2^64 bytes: nobody asks for that
  std::optional<FileVersion> known;
  ReplyHead head;
  while (!bytes.empty()) {
    const size_t end = std::min(bytes.find('\n'), bytes.size());
    const std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    if (!line.empty() && line != "\r") {
      head.add_line(line);
      check_range(line);
      shown_path(line);
      continue;
    }
    if (!head.is_final()) continue;
    try {
      const Accepted accepted =
          http::check_reply("http://fuzz/scene.voy", head, asked, known ? &*known : nullptr);
      check_accepted(accepted, asked);
      if (!known) known = accepted.version;
    } catch (const Error& error) {
      check_message(error);
    }
  }
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const voyager::fuzz::MemoryLimit limit(size);
  voyager::fuzz::read_heads({reinterpret_cast<const char*>(data), size});
  return 0;
}
