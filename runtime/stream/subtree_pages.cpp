#include "runtime/stream/subtree_pages.h"

#include <string>

#include "runtime/base/error.h"

namespace voyager {

SubtreePages::SubtreePages(uint32_t subtrees, uint32_t room, uint64_t kept)
    : room_(room), kept_(kept), places_(pages_of(subtrees)), chunks_(pages_of(subtrees)) {}

bool SubtreePages::take(uint32_t first, uint32_t count, uint64_t version,
                        std::vector<uint32_t>& moved) {
  const uint32_t begin = first / kPageSubtrees, end = pages_of(first + count);
  for (uint32_t page = begin; page < end; ++page) {
    const uint8_t chunks = chunks_[page];
    chunks_.set(page, static_cast<uint8_t>(chunks + 1));
    if (chunks == 0)
      if (const auto released = released_at_.find(page); released != released_at_.end()) {
        released_.erase({released->second, page});
        released_at_.erase(released);
      }
  }
  bool followed = true;
  for (uint32_t page = begin; page < end; ++page)
    if (places_[page] == 0) followed &= place_page(page, version, moved);
  return followed;
}

void SubtreePages::release(uint32_t first, uint32_t count, uint64_t version) {
  const uint32_t begin = first / kPageSubtrees, end = pages_of(first + count);
  for (uint32_t page = begin; page < end; ++page) {
    const auto chunks = static_cast<uint8_t>(chunks_[page] - 1);
    chunks_.set(page, chunks);
    if (chunks != 0) continue;
    released_.insert({version, page});
    released_at_[page] = version;
  }
}

std::vector<PageChange> SubtreePages::changes(const std::vector<uint32_t>& moved) const {
  std::vector<PageChange> changes;
  changes.reserve(moved.size());
  for (const uint32_t page : moved) changes.push_back({page, places_[page]});
  return changes;
}

bool SubtreePages::place_page(uint32_t page, uint64_t version, std::vector<uint32_t>& moved) {
  moved.push_back(page);
  if (used_ < room_) {
    places_.set(page, ++used_);
    return true;
  }
  if (released_.empty())
    throw Error(ErrorCode::internal, "streaming: found no place for subtrees in " +
                                         std::to_string(room_) + " pages, expected one");
  const auto [gone_with, gone] = *released_.begin();
  released_.erase(released_.begin());
  released_at_.erase(gone);
  const uint32_t place = places_[gone];
  places_.set(gone, 0);
  places_.set(page, place);
  moved.push_back(gone);
  return gone_with + kept_ <= version;
}

}  // namespace voyager
