#include "runtime/scene/import/peek_reader.h"

#include <algorithm>

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
  const uint64_t first = std::min<uint64_t>(count, ahead().size());
  taken_ += static_cast<size_t>(first);
  return first + (first == count ? 0 : inner_.skip(count - first));
}

std::optional<uint64_t> PeekReader::remaining() const {
  const std::optional<uint64_t> inner = inner_.remaining();
  if (!inner) return std::nullopt;
  return *inner + ahead().size();
}

}  // namespace voyager
