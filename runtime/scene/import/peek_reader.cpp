#include "runtime/scene/import/peek_reader.h"

#include <algorithm>
#include <array>

namespace voyager {

std::span<const std::byte> PeekReader::peek(size_t count) {
  if (ahead().size() < count) {
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(taken_));
    taken_ = 0;
    const size_t had = buffer_.size();
    buffer_.resize(count);
    buffer_.resize(had + inner_.read(std::span(buffer_).subspan(had)));
  }
  return ahead().first(std::min(count, ahead().size()));
}

size_t PeekReader::read(std::span<std::byte> into) {
  const auto first = ahead().first(std::min(into.size(), ahead().size()));
  std::copy(first.begin(), first.end(), into.begin());
  taken_ += first.size();
  const auto rest = into.subspan(first.size());
  return first.size() + (rest.empty() ? 0 : inner_.read(rest));
}

uint64_t PeekReader::skip(uint64_t count) {
  std::array<std::byte, 16384> unused;
  uint64_t skipped = 0;
  while (skipped < count) {
    const size_t wanted = static_cast<size_t>(std::min<uint64_t>(unused.size(), count - skipped));
    const size_t got = read(std::span(unused).first(wanted));
    skipped += got;
    if (got < wanted) break;
  }
  return skipped;
}

std::optional<uint64_t> PeekReader::remaining() const {
  const std::optional<uint64_t> inner = inner_.remaining();
  if (!inner) return std::nullopt;
  return *inner + ahead().size();
}

}  // namespace voyager
