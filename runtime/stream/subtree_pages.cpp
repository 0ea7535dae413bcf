#include "runtime/stream/subtree_pages.h"

#include <algorithm>
#include <string>

#include "runtime/base/error.h"

namespace voyager {

SubtreePages::SubtreePages(uint32_t subtrees, uint32_t room, uint64_t kept)
    : room_(room), kept_(kept), pages_(pages_of(subtrees)) {}

bool SubtreePages::take(uint32_t first, uint32_t count, uint64_t version,
                        std::vector<uint32_t>& moved) {
  const uint32_t begin = first / kPageSubtrees, end = pages_of(first + count);
  // The chunk is counted on all of its pages first: none of them is to make room for another.
  for (uint32_t page = begin; page < end; ++page) {
    Page state = pages_[page];
    ++state.chunks;
    pages_.set(page, state);
  }
  bool followed = true;
  for (uint32_t page = begin; page < end; ++page)
    if (pages_[page].place == 0) followed &= place_page(page, version, moved);
  return followed;
}

void SubtreePages::release(uint32_t first, uint32_t count, uint64_t version) {
  const uint32_t begin = first / kPageSubtrees, end = pages_of(first + count);
  for (uint32_t page = begin; page < end; ++page) {
    Page state = pages_[page];
    if (--state.chunks == 0 && state.released_at != version) {
      state.released_at = version;
      released_.push_back({version, page});
      if (version == sorted_) sorted_ = 0;
    }
    pages_.set(page, state);
  }
  // A page may have older entries. They go here, so that no more is left than one for each place.
  if (released_.size() > 2 * size_t{used_})
    std::erase_if(released_, [&](const Released& released) { return forget_if_taken(released); });
}

std::vector<PageChange> SubtreePages::changes(const std::vector<uint32_t>& moved) const {
  std::vector<PageChange> changes;
  changes.reserve(moved.size());
  for (const uint32_t page : moved) changes.push_back({page, pages_[page].place});
  return changes;
}

bool SubtreePages::forget_if_taken(const Released& released) {
  Page page = pages_[released.page];
  if (page.released_at != released.at) return true;
  if (page.chunks == 0) return false;
  page.released_at = 0;
  pages_.set(released.page, page);
  return true;
}

// The one that went first; of several the first in the file.
std::optional<SubtreePages::Released> SubtreePages::take_released() {
  while (!released_.empty()) {
    if (const uint64_t at = released_.front().at; at != sorted_) {
      const auto end = std::find_if(released_.begin(), released_.end(),
                                    [&](const Released& other) { return other.at != at; });
      std::sort(released_.begin(), end,
                [](const Released& a, const Released& b) { return a.page < b.page; });
      sorted_ = at;
    }
    const Released first = released_.front();
    released_.pop_front();
    if (!forget_if_taken(first)) return first;
  }
  return std::nullopt;
}

bool SubtreePages::place_page(uint32_t page, uint64_t version, std::vector<uint32_t>& moved) {
  moved.push_back(page);
  Page state = pages_[page];
  if (used_ < room_) {
    state.place = ++used_;
    pages_.set(page, state);
    return true;
  }
  const std::optional<Released> gone = take_released();
  if (!gone)
    throw Error(ErrorCode::internal, "streaming: found no place for subtrees in " +
                                         std::to_string(room_) + " pages, expected one");
  state.place = pages_[gone->page].place;
  pages_.set(gone->page, {});
  pages_.set(page, state);
  moved.push_back(gone->page);
  return gone->at + kept_ <= version;
}

}  // namespace voyager
