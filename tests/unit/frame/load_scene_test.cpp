#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "runtime/base/checksum.h"
#include "runtime/format/tree_check.h"
#include "runtime/frame/scene.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/frame/whole_tree.h"
#include "runtime/lod/nesting.h"
#include "runtime/math/bounds_code.h"
#include "runtime/scene/import/importer.h"
#include "tests/support/random_trees.h"
#include "tests/support/rounded_tree.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_rules.h"

namespace voyager::load_scene_test {
namespace {

using test::Bytes;

std::shared_ptr<const Scene> load(std::shared_ptr<const ByteSource> source) {
  Workers workers;
  return load_scene(std::move(source), std::pmr::get_default_resource(), workers);
}

std::shared_ptr<const Scene> load(const Bytes& bytes) {
  return load(test::source_of(bytes));
}

std::vector<float> sh_of(const Scene& scene, uint32_t i) {
  std::vector<float> sh(static_cast<size_t>(scene.coefficients()) * 3);
  copy_sh(scene, i, sh.data());
  return sh;
}

void expect_leaves_equal_flat(const Scene& baked, const Scene& flat) {
  ASSERT_TRUE(flat.flat());
  ASSERT_FALSE(baked.flat());
  ASSERT_EQ(baked.leaves.size(), flat.gaussians.size());
  EXPECT_EQ(std::memcmp(&baked.origin, &flat.origin, sizeof flat.origin), 0);
  for (uint32_t i = 0; i < flat.gaussians.size(); ++i) {
    const uint32_t node = baked.leaves[i];
    ASSERT_EQ(std::memcmp(&baked.gaussians[node], &flat.gaussians[i], sizeof(Gaussian)), 0);
    ASSERT_EQ(sh_of(baked, node), sh_of(flat, i));
  }
}

TEST(LoadScene, LeavesOfALosslessBakeEqualTheFlatScene) {
  for (const float offset : {0.0f, 2.0e6f}) {
    GaussianCloud cloud = test::random_cloud(3000, 40, 2);
    for (size_t i = 0; i < cloud.size(); ++i) cloud.position[3 * i + 2] += offset;
    cloud.position[4] = -0.0f;
    const auto flat = load(test::ply_bytes(cloud));
    const auto baked = load(test::scene_bytes(test::bake(cloud), Quality::lossless));
    EXPECT_EQ(flat->origin.z != 0, offset != 0);
    expect_leaves_equal_flat(*baked, *flat);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(flat->bounds_min[axis], baked->bounds_min[axis]);
      EXPECT_EQ(flat->bounds_max[axis], baked->bounds_max[axis]);
    }
  }
}

// A compact scene keeps what the file stores, and draws what the file restores.
TEST(LoadScene, GaussiansOfACompactSceneAreTheFilesToTheBit) {
  for (const int degree : {0, 1, 2, 3}) {
    const auto bytes = test::scene_bytes(test::bake(test::random_cloud(3000, 43, degree)),
                                         Quality::compact, 0, kMinChunkBytes);
    const auto scene = load(bytes);
    const size_t floats = static_cast<size_t>(scene->coefficients()) * 3;
    EXPECT_TRUE(scene->sh.empty());
    EXPECT_TRUE(scene->gaussians.empty());
    const GaussianArrays arrays = gaussian_arrays(*scene);
    const SceneFile file(test::source_of(bytes));
    for (uint32_t i = 0; i < file.info().chunk_count; ++i) {
      const Chunk chunk = file.read_chunk(i);
      for (size_t n = 0; n < chunk.node.size(); ++n) {
        const std::vector<float> stored(
            chunk.sh.begin() + static_cast<std::ptrdiff_t>(n * floats),
            chunk.sh.begin() + static_cast<std::ptrdiff_t>((n + 1) * floats));
        ASSERT_EQ(sh_of(*scene, chunk.node[n]), stored) << degree;
        const Gaussian found = arrays.gaussian(chunk.node[n]),
                       expected = activate(chunk.words[n], chunk.is_leaf(n));
        ASSERT_EQ(std::memcmp(&found, &expected, sizeof found), 0) << chunk.node[n];
        ASSERT_EQ(arrays.node_code(chunk.node[n]), chunk.node_code[n]);
      }
    }
  }
}

TEST(LoadScene, BringsTheTreeBack) {
  const BakedScene baked = test::bake(test::random_cloud(5000, 41, 0));
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const auto scene = load(test::scene_bytes(baked, quality));
    const auto whole = whole_tree(*scene);
    const LodTree searched = test::rounded(baked.tree);
    ASSERT_EQ(whole->size(), baked.tree.size());
    EXPECT_EQ(scene->tree.parent, baked.tree.parent);
    EXPECT_EQ(whole->parent, baked.tree.parent);
    EXPECT_EQ(scene->tree.records.empty(), !scene->search.leaves_have_extent);
    const GaussianArrays arrays = gaussian_arrays(*scene);
    for (uint32_t n = 0; n < baked.tree.size(); ++n)
      ASSERT_EQ(arrays.node_code(n), baked.node_code[n]);
    for (uint32_t n = 0; n < baked.tree.size(); ++n) {
      if (baked.tree.is_leaf(n)) {
        ASSERT_EQ(scene->leaves[baked.gaussian[n]], n);
      } else {
        ASSERT_EQ(whole->first_child[n], baked.tree.first_child[n]);
        ASSERT_TRUE(is_same(whole->records[n], searched.records[n])) << n;
      }
    }
    EXPECT_TRUE(scene->damaged.empty());
    EXPECT_EQ(scene->storage, quality == Quality::compact ? Storage::compact : Storage::lossless);
  }
}

TEST(LoadScene, ADamagedChunkIsReportedAndTheRestIsThere) {
  const BakedScene baked = test::bake(test::random_cloud(4000, 42, 0));
  const Bytes bytes = test::scene_bytes(baked, Quality::lossless);
  const SceneFile file(test::source_of(bytes));
  ASSERT_GE(file.chunks().size(), 3u);
  const ChunkEntry& bad = file.chunks()[1];
  const auto scene =
      load(std::make_shared<test::FlippedSource>(bytes, bad.offset + 200, std::byte{1}));
  ASSERT_EQ(scene->damaged_chunks.size(), 1u);
  EXPECT_EQ(scene->damaged_chunks[0].chunk, 1u);
  EXPECT_NE(scene->damaged_chunks[0].message.find("chunk 1"), std::string::npos);
  const std::vector<NodeRange> lost = file.nodes_of(1);
  ASSERT_EQ(scene->damaged.size(), lost.size());
  for (size_t i = 0; i < lost.size(); ++i) {
    EXPECT_EQ(scene->damaged[i].first, lost[i].first);
    EXPECT_EQ(scene->damaged[i].count, lost[i].count);
    EXPECT_EQ(scene->damaged[i].message, scene->damaged_chunks[0].message);
  }
  for (uint32_t n = 0; n < baked.tree.size(); ++n) {
    const uint32_t parent = baked.tree.parent[n];
    const uint32_t found = scene->tree.parent[n];
    ASSERT_TRUE(found == parent || (found == kNoNode && test::holds(lost, parent))) << n;
    if (test::holds(lost, n)) {
      ASSERT_EQ(scene->gaussians[n].opacity, 0.0f);
      ASSERT_EQ(scene->tree.records[n].child_count, 0u);
    }
    if (baked.tree.is_leaf(n)) {
      ASSERT_EQ(scene->leaves[baked.gaussian[n]], test::holds(lost, n) ? kNoNode : n);
    }
  }
}

TEST(LoadScene, ADamagedScenesProfileIsOfWhatWasRead) {
  const Bytes bytes = test::scene_bytes(test::bake(test::random_cloud(4000, 43, 0)),
                                        Quality::lossless, 0, kMinChunkBytes);
  const SceneFile file(test::source_of(bytes));
  const auto sound = load(bytes);
  for (uint32_t index = 1; index < file.chunks().size(); index += 7) {
    const uint64_t at = file.chunks()[index].offset + 70;
    const auto damaged = load(std::make_shared<test::FlippedSource>(bytes, at, std::byte{1}));
    const std::vector<NodeRange> lost = file.nodes_of(index);
    float least = INFINITY, greatest = 0;
    uint64_t above_one = 0;
    for (uint32_t n = 0; n < sound->gaussians.size(); ++n) {
      if (test::holds(lost, n)) continue;
      const Gaussian& g = sound->gaussians[n];
      const auto [thin, thick] = std::minmax({g.scale.x, g.scale.y, g.scale.z});
      least = std::min(least, thick / thin);
      greatest = std::max(greatest, thick / thin);
      above_one += g.opacity > 1;
    }
    ASSERT_EQ(damaged->profile.least_anisotropy, least) << index;
    ASSERT_EQ(damaged->profile.greatest_anisotropy, greatest);
    ASSERT_EQ(damaged->profile.opacities_above_one, above_one);
  }
}

void expect_same_partition(const Partition& loaded, const Partition& baked) {
  EXPECT_EQ(loaded.first_tier_levels, baked.first_tier_levels);
  EXPECT_EQ(loaded.chunk_bytes, baked.chunk_bytes);
  EXPECT_EQ(loaded.level_begin, baked.level_begin);
  EXPECT_EQ(loaded.tier_begin, baked.tier_begin);
  EXPECT_EQ(loaded.chunk_begin, baked.chunk_begin);
  ASSERT_EQ(loaded.chunk_hull.size(), baked.chunk_hull.size());
  for (size_t chunk = 0; chunk < loaded.chunk_hull.size(); ++chunk) {
    const EntryHull rounded = round_bounds(baked.chunk_hull[chunk]);
    EXPECT_EQ(std::memcmp(&loaded.chunk_hull[chunk], &rounded, sizeof rounded), 0);
  }
  ASSERT_EQ(loaded.subtrees.size(), baked.subtrees.size());
  EXPECT_TRUE(loaded.subtrees == baked.subtrees);
}

TEST(LoadScene, ThePartitionAndTheTreeComeBackForTreesOfEveryShape) {
  for (const test::TreeShape shape : test::kTreeShapes)
    for (const test::Extents extents : {test::Extents::longest_side, test::Extents::any}) {
      const BakedScene baked = test::baked_of(test::random_tree(shape, 4000, 8, extents));
      const LodTree searched = test::rounded(baked.tree);
      for (const uint32_t chunk_bytes : {kMinChunkBytes, kDefaultChunkBytes, 65536u}) {
        const Partition partition = partition_tree(baked.tree, chunk_bytes);
        for (const Quality quality : {Quality::lossless, Quality::compact}) {
          const auto scene = load(test::scene_bytes(baked, quality, 0, chunk_bytes));
          expect_same_partition(scene->partition, partition);
          EXPECT_EQ(scene->tree.parent, baked.tree.parent) << test::name_of(shape);
          const auto whole = whole_tree(*scene);
          ASSERT_EQ(whole->size(), baked.tree.size());
          for (uint32_t n = 0; n < baked.tree.size(); ++n) {
            const NodeRecord &found = whole->records[n], &expected = searched.records[n];
            // Of a leaf without an extent the box is not kept.
            const bool kept = !baked.tree.is_leaf(n) || scene->search.leaves_have_extent;
            ASSERT_TRUE(kept ? is_same(found, expected)
                             : found.child_count == 0 && found.extent == expected.extent)
                << test::name_of(shape) << " " << n;
          }
        }
      }
    }
}

// Whatever chunk is lost, the subtrees of all others keep their indices, and what is
// lost is told.
TEST(LoadScene, EachChunkOfTreesOfEveryShapeCanBeLost) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    const BakedScene baked = test::baked_of(test::random_tree(shape, 600, 9));
    const Partition partition = partition_tree(baked.tree, kMinChunkBytes);
    const Bytes bytes = test::scene_bytes(baked, Quality::lossless, 0, kMinChunkBytes);
    const SceneFile file(test::source_of(bytes));
    for (uint32_t index = 0; index < file.chunks().size(); ++index) {
      const ChunkEntry& entry = file.chunks()[index];
      const auto scene =
          load(std::make_shared<test::FlippedSource>(bytes, entry.offset + 70, std::byte{2}));
      ASSERT_EQ(scene->damaged_chunks.size(), 1u);
      const DamagedChunk& lost = scene->damaged_chunks[0];
      ASSERT_EQ(lost.first_root, partition.subtrees[lost.first_subtree].root);
      std::vector<bool> gone(baked.tree.size());
      for (uint32_t i = 0; i < partition.subtrees.size(); ++i) {
        const Subtree& subtree = partition.subtrees[i];
        const bool in_lost = i >= lost.first_subtree && i - lost.first_subtree < lost.subtree_count;
        ASSERT_TRUE(scene->partition.subtrees[i] == (in_lost ? kLostSubtree : subtree));
        for (uint32_t slot = 0; slot < subtree.node_count(); ++slot)
          if (in_lost && !subtree.repeats(slot)) gone[subtree.node(slot)] = true;
      }
      for (uint32_t n = 1; n < baked.tree.size(); ++n) {
        const uint32_t found = scene->tree.parent[n], parent = baked.tree.parent[n];
        ASSERT_TRUE(found == parent || (found == kNoNode && gone[parent]));
      }
      for (size_t i = 0; i < scene->damaged.size(); ++i) {
        const DamagedNodes& d = scene->damaged[i];
        ASSERT_GT(d.count, 0u);
        ASSERT_TRUE(i == 0 || d.first >= scene->damaged[i - 1].first + scene->damaged[i - 1].count);
        for (uint32_t n = d.first; n < d.first + d.count; ++n) {
          ASSERT_TRUE(gone[n]);
          gone[n] = false;
        }
      }
      ASSERT_EQ(std::count(gone.begin(), gone.end(), true), 0);
    }
  }
}

// Every word of the levels, the tiers and the directory changed under right
// checksums: refused, or a chunk is found damaged. Hulls apart: they may be larger.
TEST(LoadScene, ADirectoryThatIsNotOfTheTreeIsFound) {
  const Bytes sound = test::scene_bytes(
      test::baked_of(test::random_tree(test::TreeShape::mixture, 700, 7)), Quality::lossless);
  FileHeader header;
  std::memcpy(&header, sound.data(), sizeof header);
  EXPECT_TRUE(load(test::sealed(sound))->damaged_chunks.empty());
  const auto expect_found = [&](uint64_t at, uint32_t change) {
    Bytes bytes = sound;
    uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    word += change;
    std::memcpy(bytes.data() + at, &word, sizeof word);
    try {
      EXPECT_FALSE(load(test::sealed(bytes))->damaged_chunks.empty())
          << "word at " << at << " + " << change;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input);
    }
  };
  for (uint64_t at = header.tiers.offset; at < header.directory.offset; at += 4)
    for (const uint32_t change : {1u, 0xffffffffu, 0x80000000u}) expect_found(at, change);
  for (uint32_t chunk = 0; chunk < header.chunk_count; ++chunk)
    for (uint64_t word = 0; word < offsetof(ChunkEntry, hull); word += 4) {
      if (word / 8 == offsetof(ChunkEntry, checksum) / 8) continue;
      for (const uint32_t change : {1u, 0xffffffffu, 0x40000000u})
        expect_found(header.directory.offset + chunk * sizeof(ChunkEntry) + word, change);
    }
}

template <class Edit>
Bytes edited_entry(Bytes bytes, uint32_t chunk, const Edit& edit) {
  FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  ChunkEntry entry;
  const uint64_t at = header.directory.offset + chunk * sizeof entry;
  std::memcpy(&entry, bytes.data() + at, sizeof entry);
  edit(entry);
  std::memcpy(bytes.data() + at, &entry, sizeof entry);
  return test::sealed(bytes);
}

float longest_side(const EntryHull& hull) {
  float longest = 0;
  for (int axis = 0; axis < 3; ++axis)
    longest = std::max(longest, hull.box_max[axis] - hull.box_min[axis]);
  return longest;
}

TEST(LoadScene, AnEntryHullThatLeavesOutAParentIsRefused) {
  const Bytes sound =
      test::scene_bytes(test::bake(test::random_cloud(3000, 12, 0)), Quality::lossless);
  const std::vector<std::function<void(ChunkEntry&)>> faults = {
      // By more than rounding adds (bounds_code.h).
      [](ChunkEntry& e) { e.hull.extent = 0.99f * std::min(e.hull.extent, 1e9f); },
      [](ChunkEntry& e) { e.hull.box_min.x += longest_side(e.hull) / 20; },
      [](ChunkEntry& e) { e.hull.box_max.z -= longest_side(e.hull) / 20; },
      [](ChunkEntry& e) { e.hull.extent = std::nanf(""); },
      [](ChunkEntry& e) { e.hull.box_min.y = -2e18f; },
  };
  for (const uint32_t chunk : {3u, 20u})
    for (const auto& fault : faults)
      EXPECT_EQ(test::error_code([&] { load(edited_entry(sound, chunk, fault)); }),
                ErrorCode::refused_input);
  // Nothing is above the tree's root: its chunk is always entered.
  EXPECT_EQ(test::error_code([&] { load(edited_entry(sound, 0, faults[0])); }),
            ErrorCode::refused_input);
  const auto larger = [](ChunkEntry& e) {
    e.hull.extent *= 2;
    e.hull.box_max.x += 1;
  };
  EXPECT_NO_THROW(load(edited_entry(sound, 3, larger)));
}

// A star's chunks repeat its root.
TEST(LoadScene, ARepeatedRecordThatIsNotItsOwnersIsRefused) {
  const BakedScene baked = test::baked_of(test::random_tree(test::TreeShape::star, 500, 10));
  const Bytes sound = test::scene_bytes(baked, Quality::lossless);
  const SceneFile file(test::source_of(sound));
  ASSERT_GE(file.chunks().size(), 3u);
  const uint64_t record = file.chunks()[1].offset + sizeof(ChunkHeader);
  for (const uint64_t word : {0u, 3u, 6u, 7u}) {
    Bytes bytes = sound;
    bytes[record + 4 * word] ^= std::byte{1};
    EXPECT_EQ(test::error_code([&] { load(test::sealed(bytes)); }), ErrorCode::refused_input);
  }
}

TEST(LoadScene, ATreeThatBreaksNestingIsRefused) {
  BakedScene baked = test::bake(test::random_cloud(100, 43, 0));
  const NodeRecord sound = baked.tree.records[7];
  baked.tree.records[7].extent = 1e6f;
  EXPECT_EQ(test::error_code([&] { load(test::scene_bytes(baked, Quality::lossless)); }),
            ErrorCode::refused_input);
  baked.tree.records[7] = sound;
  baked.tree.records[7].box_max.x = 1e6f;
  EXPECT_EQ(test::error_code([&] { load(test::scene_bytes(baked, Quality::compact)); }),
            ErrorCode::refused_input);
}

// A search opens a subtree by what its first root hangs from.
TEST(LoadScene, ASubtreeWithRootsOfSeveralNodesIsRefused) {
  const BakedScene baked = test::bake(test::random_cloud(2000, 46, 0));
  Partition partition = partition_tree(baked.tree, kMinChunkBytes);
  EXPECT_NO_THROW(load(test::scene_bytes(baked, Quality::compact, 0, partition)));
  ASSERT_TRUE(test::join_strangers(baked.tree, partition));
  const Bytes bytes = test::scene_bytes(baked, Quality::compact, 0, partition);
  EXPECT_EQ(test::error_code([&] { load(bytes); }), ErrorCode::refused_input);
  // An export goes from chunk to chunk.
  const SceneFile file(test::source_of(bytes));
  TreeCheck check(file);
  EXPECT_EQ(test::error_code([&] {
              for (uint32_t i = 0; i < file.chunks().size(); ++i) check.add(file.read_chunk(i), i);
            }),
            ErrorCode::refused_input);
}

TEST(LoadScene, TwoLeavesOfOneGaussianAreRefused) {
  BakedScene baked = test::bake(test::random_cloud(100, 44, 0));
  uint32_t leaves[2] = {0, 0};
  for (uint32_t n = 0, found = 0; found < 2; ++n)
    if (baked.tree.is_leaf(n)) leaves[found++] = n;
  baked.gaussian[leaves[1]] = baked.gaussian[leaves[0]];
  EXPECT_EQ(test::error_code([&] { load(test::scene_bytes(baked, Quality::lossless)); }),
            ErrorCode::refused_input);
}

TEST(LoadScene, AHeaderThatContradictsTheTreeIsRefused) {
  const Bytes sound = test::scene_bytes(
      test::bake(test::random_cloud(100, 45, 0), test::kHierarchicalGs), Quality::lossless);
  const auto changed = [&](const auto& change) {
    Bytes bytes = sound;
    FileHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    change(header);
    header.checksum =
        checksum(std::as_bytes(std::span(&header, 1)).first(offsetof(FileHeader, checksum)));
    std::memcpy(bytes.data(), &header, sizeof header);
    return bytes;
  };
  EXPECT_NO_THROW(load(changed([](FileHeader&) {})));
  for (const Bytes& bytes :
       {changed([](FileHeader& h) { ++h.depth; }), changed([](FileHeader& h) { ++h.leaf_count; }),
        changed([](FileHeader& h) { h.bounds_min[0] -= 1; }),
        changed([](FileHeader& h) { h.largest_sh = std::nextafter(h.largest_sh, 1e9f); }),
        changed([](FileHeader& h) { h.largest_sh = -1; }),
        changed([](FileHeader& h) { h.largest_sh = std::nanf(""); }),
        changed([](FileHeader& h) { h.left_out_bands = 4; }),
        changed([](FileHeader& h) { h.flags |= (kFlags | kFootprintMask) + 1; }),
        changed([](FileHeader& h) { h.flags |= kFlagLeafExtents; })})
    EXPECT_EQ(test::error_code([&] { load(bytes); }), ErrorCode::refused_input);
}

TEST(LoadScene, UnknownBytesAreRefusedByName) {
  for (const char* text : {"", "GLTF and more", "x"}) {
    const std::string words = text;
    const auto span = std::as_bytes(std::span(words));
    const Bytes bytes(span.begin(), span.end());
    try {
      load(bytes);
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input);
      EXPECT_NE(std::string(error.what()).find(".voy, or a .ply"), std::string::npos);
    }
  }
}

TEST(LoadScene, SaysWhatWasMendedAndWhatIsLeftOut) {
  GaussianCloud cloud = test::random_cloud(20, 46, 1);
  cloud.rotation[0] = cloud.rotation[1] = cloud.rotation[2] = cloud.rotation[3] = 0;
  cloud.opacity[3] = std::numeric_limits<float>::quiet_NaN();
  const auto scene = load(test::ply_bytes(cloud));
  EXPECT_EQ(scene->gaussians.size(), 19u);
  uint64_t repaired = 0, dropped = 0, omitted_bytes = 0;
  for (const SceneNote& note : scene->notes) {
    if (note.kind == SceneNote::Kind::repaired) repaired += note.count;
    if (note.kind == SceneNote::Kind::dropped) dropped += note.count;
    if (note.kind == SceneNote::Kind::omitted) omitted_bytes += note.bytes;
  }
  EXPECT_EQ(repaired, 1u);
  EXPECT_EQ(dropped, 1u);
  EXPECT_EQ(omitted_bytes, 19u * (9 + 36 * 4));
}

class CountingMemory final : public std::pmr::memory_resource {
 public:
  size_t peak = 0;

 private:
  void* do_allocate(size_t bytes, size_t alignment) override {
    peak = std::max(peak, used_ += bytes);
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* p, size_t bytes, size_t alignment) override {
    used_ -= bytes;
    std::pmr::new_delete_resource()->deallocate(p, bytes, alignment);
  }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
  size_t used_ = 0;
};

TEST(LoadScene, AFlatSceneNeverHoldsItsShTwice) {
  const Bytes bytes = test::ply_bytes(test::random_cloud(20000, 47, 3));
  CountingMemory memory;
  Workers workers(1);
  load_scene(test::source_of(bytes), &memory, workers);
  EXPECT_LE(memory.peak, 20000u * (192 + 44 + sizeof(Gaussian)) + 65536);
}

TEST(LoadScene, MemoryThatIsRefusedComesOutAsBadAlloc) {
  const GaussianCloud cloud = test::random_cloud(100, 48, 0);
  Workers workers(1);
  for (const Bytes& bytes :
       {test::ply_bytes(cloud), test::scene_bytes(test::bake(cloud), Quality::compact)})
    EXPECT_THROW(load_scene(test::source_of(bytes), std::pmr::null_memory_resource(), workers),
                 std::bad_alloc);
}

TEST(LoadScene, AnEmptyBakeIsAnEmptyScene) {
  const auto scene =
      load(test::scene_bytes(test::bake(test::random_cloud(0, 1)), Quality::lossless));
  EXPECT_TRUE(scene->gaussians.empty());
}

TEST(LoadScene, ARealBlockBakedLosslessEqualsItsFlatScene) {
  VOYAGER_NEEDS_SCENES(folder);
  const std::string path = folder + "/formats/block.ply";
  const auto source = open_file_source(path);
  const GaussianCloud cloud = import_gaussians(*read_source(*source));
  const auto baked = load(test::scene_bytes(test::bake(cloud), Quality::lossless));
  expect_leaves_equal_flat(*baked, *load(open_file_source(path)));
}

}  // namespace
}  // namespace voyager::load_scene_test
