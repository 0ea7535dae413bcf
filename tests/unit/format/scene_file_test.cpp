#include <cstring>

#include "tests/support/mixed_footprints.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"
#include "tests/support/tree_rules.h"

namespace voyager::scene_file_test {
namespace {

using test::Bytes;

bool same_bits(const void* a, const void* b, size_t bytes) {
  return std::memcmp(a, b, bytes) == 0;
}

// Calls visit(chunk, place among the chunk's owned nodes, node id) for every node of the file.
template <class Visit>
void for_nodes(const SceneFile& file, const Visit& visit) {
  for (uint32_t index = 0; index < file.chunks().size(); ++index) {
    const Chunk chunk = file.read_chunk(index);
    for (uint32_t i = 0; i < chunk.node.size(); ++i) visit(chunk, i, chunk.node[i]);
  }
}

TEST(SceneFile, LosslessGivesBackEveryWord) {
  for (const int degree : {0, 1, 2, 3}) {
    const BakedScene baked = test::bake(test::random_cloud(3000, 7, degree));
    const Bytes bytes = test::scene_bytes(baked, Quality::lossless);
    const SceneFile file(test::source_of(bytes));
    ASSERT_EQ(file.info().node_count, baked.tree.size());
    ASSERT_EQ(file.info().leaf_count, 3000u);
    ASSERT_EQ(file.info().sh_degree, degree);
    const size_t floats = static_cast<size_t>(sh_coefficients(degree)) * 3;
    for_nodes(file, [&](const Chunk& chunk, size_t i, uint32_t node) {
      const bool leaf = baked.tree.is_leaf(node);
      const GaussianCloud& cloud = leaf ? baked.leaves : baked.merged;
      const GaussianWords words = cloud.words(baked.gaussian[node]);
      ASSERT_TRUE(same_bits(&chunk.words[i], &words, sizeof words)) << node;
      ASSERT_TRUE(same_bits(&chunk.record_of(i), &baked.tree.records[node], sizeof(NodeRecord)));
      ASSERT_TRUE(same_bits(&chunk.sh[i * floats], &cloud.sh[baked.gaussian[node] * floats],
                            floats * sizeof(float)));
      ASSERT_EQ(chunk.node_code[i], baked.node_code[node]);
      ASSERT_EQ(chunk.source_index[i], leaf ? baked.gaussian[node] : kNoNode);
    });
  }
}

TEST(SceneFile, LosslessKeepsTheInputsPositionWordsWhereTheSceneHasItsOwnOrigin) {
  GaussianCloud cloud = test::random_cloud(1500, 8, 0);
  cloud.origin = {4.2e6 + 0.3, -1.7e5, 0};
  const BakedScene baked = test::bake(cloud);
  ASSERT_NE(baked.origin[0], 0);
  const Bytes bytes = test::scene_bytes(baked, Quality::lossless);
  const SceneFile file(test::source_of(bytes));
  EXPECT_EQ(file.info().source_origin, cloud.origin);
  EXPECT_EQ(file.info().origin, baked.origin);
  for_nodes(file, [&](const Chunk& chunk, size_t i, uint32_t node) {
    if (!baked.tree.is_leaf(node)) return;
    const uint32_t source = chunk.source_index[i];
    ASSERT_TRUE(same_bits(&chunk.position_words[3 * i], &cloud.position[3 * source], 12));
    const Vec3f mean = local_mean(baked.leaves, source, baked.origin);
    ASSERT_TRUE(same_bits(&chunk.words[i].mean, &mean, sizeof mean));
  });
}

TEST(SceneFile, CutsAreTheSameInBothQualities) {
  const BakedScene baked = test::bake(test::random_cloud(4000, 9, 1));
  const Bytes bytes = test::scene_bytes(baked, Quality::compact);
  const SceneFile file(test::source_of(bytes));
  EXPECT_TRUE(same_bits(&file.info().bounds_min, &baked.tree.records[0].box_min, sizeof(Vec3f)));
  for_nodes(file, [&](const Chunk& chunk, size_t i, uint32_t node) {
    ASSERT_TRUE(same_bits(&chunk.record_of(i), &baked.tree.records[node], sizeof(NodeRecord)));
  });
}

TEST(SceneFile, BytesDoNotDependOnTheNumberOfThreads) {
  const BakedScene baked = test::bake(test::specks(40000, 10, 0));
  for (const Quality quality : {Quality::lossless, Quality::compact})
    EXPECT_EQ(test::scene_bytes(baked, quality, 1), test::scene_bytes(baked, quality, 4));
}

TEST(SceneFile, AnEmptySceneIsWrittenAndRead) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const Bytes bytes = test::scene_bytes(test::bake(test::random_cloud(0, 1)), quality);
    const SceneFile file(test::source_of(bytes));
    EXPECT_EQ(file.info().node_count, 0u);
    EXPECT_TRUE(file.chunks().empty());
  }
}

TEST(SceneFile, CarriesWhatTheImportReported) {
  GaussianCloud cloud = test::random_cloud(10, 2);
  cloud.native = compensated_scale(kLowPass);
  cloud.report.read = 17;
  cloud.report.dropped_position = 1;
  cloud.report.dropped_scale = 2;
  cloud.report.repaired_scale = 3;
  cloud.report.repaired_rotation = 4;
  cloud.report.repaired_opacity = 5;
  cloud.report.dropped_opacity = 6;
  cloud.report.repaired_sh = 7;
  const Bytes bytes = test::scene_bytes(test::bake(cloud), Quality::compact);
  const SceneFile file(test::source_of(bytes));
  EXPECT_TRUE(file.info().native.antialiased());
  EXPECT_TRUE(same_bits(&file.info().import, &cloud.report, sizeof cloud.report));
}

// So that a reader can choose formats and searches before it has read a chunk.
TEST(SceneFile, TheHeaderTellsTheLargestShOfWhatIsRead) {
  for (const Quality quality : {Quality::lossless, Quality::compact})
    for (const int degree : {0, 1, 2, 3}) {
      GaussianCloud cloud = test::random_cloud(500, 20 + static_cast<uint64_t>(degree), degree);
      const size_t floats = cloud.sh.size() / cloud.size();
      for (const float value : {0.0f, -9.37512f, 70000.0f, 1e-40f}) {
        cloud.sh[100 * floats + floats - 1] = value;
        const Bytes bytes = test::scene_bytes(test::bake(cloud), quality);
        const SceneFile file(test::source_of(bytes));
        float largest = 0;
        for_nodes(file, [&](const Chunk& chunk, size_t i, uint32_t) {
          for (size_t k = 0; k < floats; ++k)
            largest = std::max(largest, std::fabs(chunk.sh[i * floats + k]));
        });
        EXPECT_EQ(file.info().largest_sh, largest) << degree << ' ' << value;
      }
    }
}

TEST(SceneFile, TheHeaderTellsWhetherLeavesHaveExtents) {
  for (const Quality quality : {Quality::lossless, Quality::compact})
    for (const test::Extents extents : {test::Extents::longest_side, test::Extents::any}) {
      const BakedScene baked =
          test::baked_of(test::random_tree(test::TreeShape::mixture, 300, 8, extents));
      const bool some =
          std::any_of(baked.tree.records.begin(), baked.tree.records.end(),
                      [](const NodeRecord& r) { return r.child_count == 0 && r.extent != 0; });
      EXPECT_EQ(some, extents == test::Extents::any);
      const Bytes bytes = test::scene_bytes(baked, quality);
      EXPECT_EQ(SceneFile(test::source_of(bytes)).info().leaves_have_extent, some);
    }
}

TEST(SceneFile, TheHeaderTellsTheKindOfTheTree) {
  for (const test::NamedRule& named : test::all_rules())
    for (const Quality quality : {Quality::lossless, Quality::compact}) {
      const BakedScene baked = test::bake(test::random_cloud(100, 9, 0), named.rule);
      const Bytes bytes = test::scene_bytes(baked, quality);
      const SceneFileInfo info = SceneFile(test::source_of(bytes)).info();
      EXPECT_EQ(info.tree, named.rule.kind) << named.name;
      EXPECT_EQ(info.blend_share, blend_share(named.rule.kind)) << named.name;
      EXPECT_FALSE(info.leaves_have_extent) << named.name;
    }
}

TEST(SceneFile, TheHeaderTellsHowManyFootprintLevelsThereAre) {
  const BakedScene one = test::bake(test::random_cloud(300, 1, 0));
  const BakedScene many =
      test::bake_by_cameras(test::random_cloud(3000, 1, 0), test::close_camera());
  ASSERT_GT(many.leaves.native.levels, 3);
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    Bytes bytes = test::scene_bytes(one, quality);
    EXPECT_EQ(SceneFile(test::source_of(bytes)).info().native.levels, 1);
    const Bytes mixed = test::scene_bytes(many, quality);
    const SceneFile file(test::source_of(mixed));
    EXPECT_EQ(file.info().native, many.leaves.native);
    int most = 0;
    for (uint32_t chunk = 0; chunk < file.chunks().size(); ++chunk)
      for (const uint8_t code : file.read_chunk(chunk).node_code)
        most = std::max(most, footprint_level_of(code));
    EXPECT_EQ(most + 1, file.info().native.levels);

    uint32_t flags = 0;
    std::memcpy(&flags, bytes.data() + offsetof(FileHeader, flags), sizeof flags);
    flags |= 10u << kFootprintShift;
    std::memcpy(bytes.data() + offsetof(FileHeader, flags), &flags, sizeof flags);
    try {
      bytes = test::sealed(bytes);
      const SceneFile refused(test::source_of(bytes));
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("footprint levels beyond the first 10"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(SceneFile, EveryTruncationIsRefused) {
  const Bytes whole =
      test::scene_bytes(test::bake(test::random_cloud(40, 3, 0)), Quality::lossless);
  for (size_t length = 0; length < whole.size(); ++length) {
    const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    ASSERT_EQ(test::error_code([&] { SceneFile file(test::source_of(part)); }),
              ErrorCode::refused_input)
        << length;
  }
  Bytes longer = whole;
  longer.push_back(std::byte{0});
  EXPECT_EQ(test::error_code([&] { SceneFile file(test::source_of(longer)); }),
            ErrorCode::refused_input);
}

void expect_found(const Bytes& bytes, const SceneFile& sound, uint64_t at) {
  const auto flip = static_cast<std::byte>(1u << (at % 8));
  const auto source = std::make_shared<test::FlippedSource>(bytes, at, flip);
  uint32_t index = 0;
  while (index + 1 < sound.chunks().size() && sound.chunks()[index + 1].offset <= at) ++index;
  if (at < sound.chunks()[0].offset)
    ASSERT_EQ(test::error_code([&] { SceneFile file(source); }), ErrorCode::refused_input) << at;
  else
    ASSERT_EQ(test::error_code([&] { SceneFile(source).read_chunk(index); }),
              ErrorCode::damaged_chunk)
        << at;
}

// Padding included: no byte of the file is outside a checksum.
TEST(SceneFile, EveryFlippedByteIsFound) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const Bytes bytes = test::scene_bytes(test::bake(test::random_cloud(40, 4, 1)), quality);
    const SceneFile sound(test::source_of(bytes));
    for (uint64_t at = 0; at < bytes.size(); ++at) expect_found(bytes, sound, at);
  }
}

TEST(SceneFile, FlippedBytesAreFoundInTheirOwnChunk) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const Bytes bytes = test::scene_bytes(test::bake(test::random_cloud(2000, 4, 1)), quality);
    const SceneFile sound(test::source_of(bytes));
    ASSERT_GE(sound.chunks().size(), 2u);
    for (uint64_t at = 0; at < bytes.size(); at += 211) expect_found(bytes, sound, at);
  }
}

TEST(SceneFile, RefusalsNameFilePlaceFoundAndExpected) {
  const Bytes bytes = test::scene_bytes(test::bake(test::random_cloud(10, 5)), Quality::lossless);
  const SceneFile sound(test::source_of(bytes));
  const uint64_t at = sound.chunks()[0].offset + 100;
  const SceneFile file(std::make_shared<test::FlippedSource>(bytes, at, std::byte{1}));
  try {
    file.read_chunk(0);
    FAIL();
  } catch (const Error& error) {
    const std::string message = error.what();
    for (const char* part : {"flipped.voy", "chunk 0", "offset 4096", "found checksum", "expected"})
      EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

TEST(SceneFile, AnotherVersionIsRefusedAndSaysToBakeAgain) {
  Bytes bytes = test::scene_bytes(test::bake(test::random_cloud(10, 5)), Quality::lossless);
  for (const uint32_t version : {1u, 2u, 3u, 7u}) {
    std::memcpy(bytes.data() + offsetof(FileHeader, version), &version, sizeof version);
    try {
      const SceneFile file(test::source_of(bytes));
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input);
      const std::string message = error.what(), found = "version " + std::to_string(version);
      for (const char* part :
           {"test.voy", "offset 8", found.c_str(), "expected 4 to 6: bake the scene again"})
        EXPECT_NE(message.find(part), std::string::npos) << message;
    }
  }
}

// Subtrees, nodes and bytes of every chunk of trees of every shape, against the tree.
TEST(SceneFile, ChunksAreRunsOfSubtreesWithinTheirBytes) {
  for (const test::TreeShape shape : test::kTreeShapes) {
    const BakedScene baked = test::baked_of(test::random_tree(shape, 3000, 6));
    for (const uint32_t chunk_bytes : {kMinChunkBytes, kDefaultChunkBytes, kMaxChunkBytes}) {
      const Bytes bytes = test::scene_bytes(baked, Quality::lossless, 0, chunk_bytes);
      const SceneFile file(test::source_of(bytes));
      const Partition partition = partition_tree(baked.tree, chunk_bytes);
      ASSERT_EQ(file.chunks().size(), partition.chunk_count());
      std::vector<uint32_t> seen;
      for (uint32_t index = 0; index < file.chunks().size(); ++index) {
        const Chunk chunk = file.read_chunk(index);
        ASSERT_TRUE(same_bits(chunk.subtrees.data(), &partition.subtrees[chunk.first_subtree],
                              chunk.subtrees.size() * sizeof(Subtree)));
        ASSERT_LE(chunk.records.size() * sizeof(NodeRecord), chunk_bytes);
        std::vector<uint32_t> held(chunk.node), told;
        std::sort(held.begin(), held.end());
        for (const NodeRange& range : file.nodes_of(index))
          for (uint32_t i = 0; i < range.count; ++i) told.push_back(range.first + i);
        ASSERT_EQ(held, told) << test::name_of(shape);
        seen.insert(seen.end(), held.begin(), held.end());
        for (size_t i = 0; i < chunk.node.size(); ++i) {
          if (chunk.is_leaf(i)) continue;
          ASSERT_EQ(chunk.first_child[i], baked.tree.first_child[chunk.node[i]]);
        }
      }
      std::sort(seen.begin(), seen.end());
      ASSERT_EQ(seen.size(), baked.tree.size());
      for (uint32_t n = 0; n < seen.size(); ++n) ASSERT_EQ(seen[n], n);
    }
  }
}

TEST(SceneFile, ANativePixelThatItsSourceDeniesIsRefused) {
  const BakedScene many =
      test::bake_by_cameras(test::random_cloud(3000, 1, 0), test::close_camera());
  const Bytes bytes = test::scene_bytes(many, Quality::compact);
  const auto refusal = [&](const auto& change) -> std::string {
    Bytes changed = bytes;
    FileHeader header;
    std::memcpy(&header, changed.data(), sizeof header);
    change(header);
    std::memcpy(changed.data(), &header, sizeof header);
    try {
      const SceneFile file(test::source_of(changed = test::sealed(changed)));
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refusal([](FileHeader&) {}), "");
  for (const NativeSource source : {NativeSource::unknown, NativeSource::file})
    EXPECT_NE(refusal([&](FileHeader& h) {
                h.native_source = static_cast<uint32_t>(source);
              }).find("a native pixel of a scene whose source says that it has none"),
              std::string::npos);
  EXPECT_NE(refusal([](FileHeader& h) { h.native_pixel = 0; }).find("without a native pixel"),
            std::string::npos);
}

}  // namespace
}  // namespace voyager::scene_file_test
