// Places of pages, against a model that sorts all that is free.
#include "runtime/stream/subtree_pages.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace voyager::subtree_pages_test {
namespace {

constexpr uint32_t kPages = 40, kRoom = 12;
constexpr uint64_t kKept = 4;

// Each chunk is one page.
class Model {
 public:
  bool take(uint32_t page, uint64_t version, std::vector<uint32_t>& moved) {
    if (const auto at = released_.find(page); at != released_.end()) {
      released_.erase(at);
      return true;
    }
    moved.push_back(page);
    if (placed_.insert(page).second && placed_.size() <= kRoom) return true;
    std::pair<uint64_t, uint32_t> first{UINT64_MAX, 0};
    for (const auto& [other, at] : released_) first = std::min(first, {at, other});
    released_.erase(first.second);
    placed_.erase(first.second);
    moved.push_back(first.second);
    return first.first + kKept <= version;
  }
  void release(uint32_t page, uint64_t version) { released_[page] = version; }

 private:
  std::map<uint32_t, uint64_t> released_;
  std::set<uint32_t> placed_;
};

// Also where several changes have the same number, as one that changes nothing has the next one's.
TEST(SubtreePages, WhatWentFirstMakesRoom) {
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    SubtreePages pages(kPages * kPageSubtrees, kRoom, kKept);
    Model model;
    std::set<uint32_t> there;
    size_t moves = 0;
    uint64_t version = 1;
    for (int i = 0; i < 2000; ++i) {
      version += random() % 3 == 0 ? 1 : 0;
      // Now and then the same few go and come, so that none makes room.
      const uint32_t among = i / 250 % 2 == 0 ? kPages : kRoom / 2;
      const uint32_t page = random() % among, first = page * kPageSubtrees;
      if (there.erase(page) != 0) {
        pages.release(first, kPageSubtrees, version);
        model.release(page, version);
      } else if (there.size() < kRoom) {
        there.insert(page);
        std::vector<uint32_t> moved, expected;
        const bool followed = pages.take(first, kPageSubtrees, version, moved);
        ASSERT_EQ(followed, model.take(page, version, expected));
        ASSERT_EQ(moved, expected);
        moves += moved.size();
      }
    }
    EXPECT_GT(moves, kRoom);
  }
}

}  // namespace
}  // namespace voyager::subtree_pages_test
