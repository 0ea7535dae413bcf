#include "tools/training_cameras/byte_window.h"

#include <fmt/core.h>

#include <algorithm>

#include "runtime/base/error.h"

namespace voyager::tools {

std::string_view ByteWindow::peek() {
  constexpr uint64_t kMost = 1 << 16;
  if (at_ == bytes_.size()) {
    start_ += at_;
    at_ = 0;
    bytes_.resize(std::min(kMost, source_.size() - start_));
    source_.read(start_, std::as_writable_bytes(std::span(bytes_)));
  }
  return {bytes_.data() + at_, bytes_.size() - at_};
}

void ByteWindow::skip(uint64_t count) {
  if (count <= bytes_.size() - at_) {
    at_ += count;
    return;
  }
  start_ += at_ + count;
  at_ = 0;
  bytes_.clear();
}

bool ByteWindow::skip_past(char end, std::string* into, size_t most) {
  for (;;) {
    const std::string_view bytes = peek();
    if (bytes.empty()) return false;
    const size_t found = bytes.find(end);
    const std::string_view before = bytes.substr(0, found);
    if (into) into->append(before.substr(0, most - std::min(most, into->size())));
    skip(found == std::string_view::npos ? bytes.size() : found + 1);
    if (found != std::string_view::npos) return true;
  }
}

void ByteWindow::take_bytes(char* into, size_t count, const char* what) {
  if (left() < count)
    refuse_cameras(fmt::format("{}: offset {}", name(), offset()),
                   fmt::format("the end of the file after {} bytes", left()),
                   fmt::format("{} of {} bytes", what, count));
  while (count > 0) {
    const std::string_view bytes = peek().substr(0, count);
    std::memcpy(into, bytes.data(), bytes.size());
    skip(bytes.size());
    into += bytes.size();
    count -= bytes.size();
  }
}

void refuse_cameras(const std::string& place, const std::string& found,
                    const std::string& expected) {
  throw Error(ErrorCode::refused_input,
              fmt::format("{}: found {}, expected {}", place, found, expected));
}

}  // namespace voyager::tools
