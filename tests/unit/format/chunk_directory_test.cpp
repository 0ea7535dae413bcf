#include "runtime/format/chunk_directory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>
#include <vector>

namespace voyager::chunk_directory_test {
namespace {

EntryHull random_hull(std::mt19937& random) {
  std::uniform_real_distribution<float> at(-1e4f, 1e4f), side(0, 100);
  EntryHull hull{};
  for (int axis = 0; axis < 3; ++axis) {
    hull.box_min[axis] = at(random);
    hull.box_max[axis] = hull.box_min[axis] + side(random);
  }
  hull.extent = random() % 8 == 0 ? INFINITY : side(random);
  return hull;
}

// As the files of bakes have them; now and then one that is large in some number.
std::vector<ChunkEntry> random_entries(uint32_t seed, size_t count) {
  std::mt19937 random(seed);
  const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
  std::vector<ChunkEntry> entries;
  ChunkEntry next{};
  next.offset = uint64_t{1} << 40;
  while (entries.size() < count) {
    const bool large = below(20) == 0;
    next.checksum = uint64_t{random()} << 32 | random();
    next.bytes = 64 * (1 + (large && below(2) == 0 ? 70'000 : below(300)));
    next.subtree_count = 1 + below(30);
    next.node_count = 1 + (large && below(2) == 0 ? 32'767 : below(107));
    next.record_count = next.node_count + below(3);
    next.place.listed_children = below(3) == 0 ? below(large ? 1000 : 200) : 0;
    next.place.listed_grandchildren = below(3) == 0 ? below(200) : 0;
    next.hull = random_hull(random);
    entries.push_back(next);
    next.offset += next.bytes;
    next.first_subtree += next.subtree_count;
    for (uint32_t& node : next.place.next) node += below(50) + (large ? below(3'000'000) : 0);
  }
  return entries;
}

ChunkDirectory directory_of(const std::vector<ChunkEntry>& entries) {
  ChunkDirectory directory;
  for (const ChunkEntry& entry : entries) directory.add(entry);
  directory.close();
  return directory;
}

bool is_same(const ChunkEntry& a, const ChunkEntry& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(ChunkDirectory, HasEveryEntryAsItWasButForARoundedHullAndHalfOfTheChecksum) {
  for (uint32_t seed = 0; seed < 20; ++seed)
    for (const size_t count : {0u, 1u, 31u, 32u, 33u, 1000u}) {
      const std::vector<ChunkEntry> entries = random_entries(seed, count);
      const ChunkDirectory directory = directory_of(entries);
      ASSERT_EQ(directory.size(), count);
      size_t visited = 0;
      ChunkDirectory::Totals all;
      for (const ChunkEntry& entry : directory) {
        ChunkEntry expected = entries[visited];
        expected.hull = round_bounds(expected.hull);
        expected.checksum = kept_checksum(expected.checksum);
        ASSERT_TRUE(is_same(entry, expected)) << seed << " " << count << " " << visited;
        ASSERT_TRUE(is_same(directory.at(visited), expected));
        ASSERT_EQ(directory.bytes(visited), expected.bytes);
        ASSERT_EQ(directory.first_subtree(visited), expected.first_subtree);
        ASSERT_EQ(directory.place(visited), expected.place);
        all.bytes += expected.bytes, all.nodes += expected.node_count;
        all.records += expected.record_count;
        all.most_nodes = std::max(all.most_nodes, expected.node_count);
        all.most_records = std::max(all.most_records, expected.record_count);
        const EntryHull hull = directory.hull(visited++);
        ASSERT_EQ(std::memcmp(&hull, &expected.hull, sizeof hull), 0);
      }
      EXPECT_EQ(visited, count);
      EXPECT_EQ(directory.totals(), all);
      EXPECT_THROW(directory.at(count), std::out_of_range);
    }
}

}  // namespace
}  // namespace voyager::chunk_directory_test
