#pragma once
// .voy and .ply files for tests: of a cloud, as bytes, with a byte changed.
#include <fstream>
#include <iterator>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/format/reader.h"
#include "runtime/format/writer.h"
#include "runtime/lod/build.h"
#include "runtime/scene/export/writer.h"
#include "tests/support/sealed.h"
#include "tests/support/test_support.h"

namespace voyager::test {

inline Bytes file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> chars{std::istreambuf_iterator<char>(file),
                                std::istreambuf_iterator<char>()};
  const auto* first = reinterpret_cast<const std::byte*>(chars.data());
  return Bytes(first, first + chars.size());
}

inline BakedScene bake(const GaussianCloud& cloud, const TreeRule& rule = {}) {
  Workers workers;
  return build_tree(cloud, workers, {}, rule);
}

inline Bytes scene_bytes(const BakedScene& baked, Quality quality, unsigned threads,
                         const Partition& partition) {
  const TempFolder folder;
  Workers workers(threads);
  write_scene_file(baked, partition, folder.file("scene.voy"), quality, workers);
  return file_bytes(folder.file("scene.voy"));
}
inline Bytes scene_bytes(const BakedScene& baked, Quality quality, unsigned threads = 0,
                         uint32_t chunk_bytes = kDefaultChunkBytes) {
  return scene_bytes(baked, quality, threads, partition_tree(baked.tree, chunk_bytes));
}

// Gives two neighbours of a chunk, the last that it can, one subtree, though their roots hang from
// different nodes: counts that are sound by themselves. False where there are none.
inline bool join_strangers(const LodTree& tree, Partition& p) {
  for (size_t chunk = p.chunk_count(); chunk-- > 1;)
    for (uint32_t i = p.chunk_begin[chunk]; i + 1 < p.chunk_begin[chunk + 1]; ++i) {
      Subtree& to = p.subtrees[i];
      const Subtree next = p.subtrees[i + 1];
      if (to.root == 0 || to.repeats_root() || next.repeats_root() ||
          tree.parent[to.root] == tree.parent[next.root] ||
          to.node_count() + next.node_count() > kSubtreeNodes)
        continue;
      if (to.child_count == 0) to.first_child = next.first_child;
      if (to.grandchild_count == 0) to.first_grandchild = next.first_grandchild;
      to.root_count = static_cast<uint8_t>(to.root_count + next.root_count);
      to.child_count = static_cast<uint8_t>(to.child_count + next.child_count);
      to.grandchild_count = static_cast<uint8_t>(to.grandchild_count + next.grandchild_count);
      p.subtrees.erase(p.subtrees.begin() + i + 1);
      for (auto* begins : {&p.chunk_begin, &p.tier_begin})
        for (uint32_t& begin : *begins) begin -= begin > i ? 1 : 0;
      return true;
    }
  return false;
}

inline Bytes ply_bytes(const GaussianCloud& cloud) {
  const TempFolder folder;
  AtomicFile file(folder.file("scene.ply"));
  const auto sink = sink_to(file);
  const auto writer = write_ply(*sink, cloud.size(), cloud.sh_degree, false);
  writer->append(cloud);
  writer->finish();
  file.commit();
  return file_bytes(folder.file("scene.ply"));
}

inline std::shared_ptr<const ByteSource> source_of(const Bytes& bytes) {
  return std::make_shared<MemorySource>("test.voy", bytes);
}

// A source whose bytes are another's with the bits of one of them flipped.
class FlippedSource final : public ByteSource {
 public:
  FlippedSource(const Bytes& bytes, uint64_t at, std::byte flip)
      : bytes_(bytes), at_(at), flip_(flip) {}
  const std::string& name() const override { return name_; }
  uint64_t size() const override { return bytes_.size(); }
  void read(uint64_t offset, std::span<std::byte> into) const override {
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), into.size(), into.begin());
    if (at_ >= offset && at_ - offset < into.size()) into[at_ - offset] ^= flip_;
  }

 private:
  std::string name_ = "flipped.voy";
  const Bytes& bytes_;
  uint64_t at_;
  std::byte flip_;
};

// Random Gaussians over a tree: what the format needs of a scene, not what merging makes.
inline BakedScene baked_of(LodTree tree) {
  BakedScene baked;
  std::vector<uint32_t> leaves;
  const auto nodes = static_cast<uint32_t>(tree.size());
  uint32_t merged = 0;
  for (uint32_t n = 0; n < nodes; ++n) {
    if (tree.is_leaf(n)) leaves.push_back(n);
    baked.gaussian.push_back(tree.is_leaf(n) ? static_cast<uint32_t>(leaves.size()) - 1 : merged++);
  }
  baked.leaves = random_cloud(leaves.size(), 1, 0);
  baked.merged = random_cloud(merged, 2, 0);
  for (float& opacity : baked.merged.opacity) opacity = std::fabs(opacity);
  baked.node_code.resize(nodes);
  baked.kind = TreeKind::hierarchicalgs;  // which asks nothing of nodes of one child
  baked.tree = std::move(tree);
  return baked;
}

inline bool holds(const std::vector<NodeRange>& ranges, uint32_t node) {
  for (const NodeRange& range : ranges)
    if (node >= range.first && node - range.first < range.count) return true;
  return false;
}

// The code of the Error that `action` throws; a failure if it throws none.
template <class Action>
ErrorCode error_code(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error was thrown";
  return ErrorCode::internal;
}

}  // namespace voyager::test
