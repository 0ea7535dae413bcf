// How large a cut of what is linked may be.
#include "runtime/stream/linker.h"

#include <gtest/gtest.h>

#include <numeric>

#include "runtime/stream/scene_stream.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::linker_test {
namespace {

// Every chunk has the slot of its own number, and its records are in its own blocks.
class Linked {
 public:
  Linked(const SceneFile& file, uint64_t cut_nodes)
      : file_(file),
        shape_{kDefaultChunkBytes, kDefaultChunkBytes},
        graph_(file.chunks(), file.tiers()),
        next_block_(file.chunks().size() * shape_.records),
        linker_(graph_, shape_, next_block_) {
    std::iota(next_block_.begin(), next_block_.end(), 1);
    linker_.make_room(graph_.size(), cut_nodes);
  }

  uint32_t chunks() const { return graph_.size(); }
  const Linker& linker() const { return linker_; }
  void arrive(uint32_t chunk) {
    StagedChunk staged = stage_chunk(file_.read_chunk(chunk), chunk, file_.tiers(), file_.name());
    std::vector<uint32_t> blocks(staged.record_blocks());
    std::iota(blocks.begin(), blocks.end(), chunk * shape_.records);
    staged.put(chunk, std::move(blocks));
    LinkPatch patch;
    linker_.arrive(std::move(staged), patch);
    linked_ += patch.linked.size();
  }
  void evict(uint32_t chunk) {
    LinkPatch patch;
    linker_.evict(chunk, patch);
    linked_ -= patch.unlinked.size();
  }
  size_t linked() const { return linked_; }

 private:
  const SceneFile& file_;
  SlotShape shape_;
  ChunkGraph graph_;
  std::vector<uint32_t> next_block_;
  Linker linker_;
  size_t linked_ = 0;
};

// Of a whole tree: its leaves.
TEST(Linker, LeavesOutWhatCouldMakeACutTooLarge) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    SCOPED_TRACE(test::name_of(shape));
    const LodTree tree = test::random_tree(shape, 2000, 4);
    const test::Bytes bytes =
        test::scene_bytes(test::baked_of(tree), Quality::compact, 0, kMinChunkBytes);
    const SceneFile file(test::source_of(bytes));
    const uint64_t leaves = file.info().leaf_count;
    const uint32_t top = SceneStream::top_chunks(file);
    Linked all(file, leaves), fewer(file, leaves - 1);
    for (uint32_t chunk = 0; chunk < top; ++chunk) all.arrive(chunk);
    // Also those that go and come again.
    for (int round = 0; round < 2; ++round) {
      for (uint32_t chunk = top; chunk < all.chunks(); ++chunk) all.arrive(chunk);
      EXPECT_EQ(all.linked(), file.info().subtree_count);
      EXPECT_FALSE(all.linker().lacks_room_for_cut());
      for (uint32_t chunk = all.chunks(); chunk-- > top;) all.evict(chunk);
    }
    if (top == all.chunks()) continue;
    for (uint32_t chunk = 0; chunk < fewer.chunks(); ++chunk) fewer.arrive(chunk);
    EXPECT_TRUE(fewer.linker().lacks_room_for_cut());
    EXPECT_LT(fewer.linked(), file.info().subtree_count);
  }
}

}  // namespace
}  // namespace voyager::linker_test
