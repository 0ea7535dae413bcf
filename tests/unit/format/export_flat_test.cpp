#include "runtime/format/export_flat.h"

#include "runtime/format/export_hier.h"

#include <cstring>

#include "runtime/scene/import/importer.h"
#include "tests/support/random_trees.h"
#include "tests/support/scene_files.h"

namespace voyager::export_flat_test {
namespace {

GaussianCloud import_file(const std::string& path) {
  const auto source = open_file_source(path);
  return import_gaussians(*read_source(*source));
}

bool same_bits(const std::pmr::vector<float>& a, const std::pmr::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

void expect_same_words(const GaussianCloud& a, const GaussianCloud& b) {
  EXPECT_EQ(a.sh_degree, b.sh_degree);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_TRUE(same_bits(a.position, b.position));
  EXPECT_TRUE(same_bits(a.log_scale, b.log_scale));
  EXPECT_TRUE(same_bits(a.rotation, b.rotation));
  EXPECT_TRUE(same_bits(a.opacity, b.opacity));
  EXPECT_TRUE(same_bits(a.sh, b.sh));
}

// Baked lossless, written, read, exported and imported again.
GaussianCloud there_and_back(const GaussianCloud& cloud) {
  const test::TempFolder folder;
  const test::Bytes bytes = test::scene_bytes(test::bake(cloud), Quality::lossless);
  export_leaves(SceneFile(test::source_of(bytes)), folder.file("out.ply"));
  return import_file(folder.file("out.ply"));
}

TEST(ExportLeaves, LosslessGivesBackTheInput) {
  for (const int degree : {0, 1, 2, 3}) {
    GaussianCloud cloud = test::random_cloud(2500, 20, degree);
    cloud.position[5] = -0.0f;
    expect_same_words(there_and_back(cloud), cloud);
  }
}

TEST(ExportLeaves, LosslessGivesBackTheInputBeyondTheReachOfAZeroOrigin) {
  GaussianCloud cloud = test::random_cloud(1200, 21, 1);
  for (size_t i = 0; i < cloud.size(); ++i) cloud.position[3 * i] += 1.0e6f;
  ASSERT_NE(test::bake(cloud).origin[0], 0);
  expect_same_words(there_and_back(cloud), cloud);
}

TEST(ExportLeaves, LeavesOfAMovedInputKeepTheirWordsAndOrigin) {
  GaussianCloud cloud = test::random_cloud(1200, 22, 0);
  cloud.origin = {4.1e6, 2.5, -6.0e5};
  const test::Bytes bytes = test::scene_bytes(test::bake(cloud), Quality::lossless);
  expect_same_words(read_leaves(SceneFile(test::source_of(bytes))), cloud);
}

TEST(ExportLeaves, ARealBlockComesBackToTheBit) {
  VOYAGER_NEEDS_SCENES(folder);
  const GaussianCloud cloud = import_file(folder + "/formats/block.ply");
  expect_same_words(there_and_back(cloud), cloud);
}

TEST(ExportLeaves, AnEmptySceneGivesAnEmptyFile) {
  EXPECT_EQ(there_and_back(test::random_cloud(0, 1)).size(), 0u);
}

TEST(ExportLeaves, ADamagedChunkLeavesNoFileBehind) {
  const test::TempFolder folder;
  const test::Bytes bytes =
      test::scene_bytes(test::bake(test::random_cloud(100, 23)), Quality::compact);
  const SceneFile file(
      std::make_shared<test::FlippedSource>(bytes, bytes.size() - 1, std::byte{4}));
  EXPECT_EQ(test::error_code([&] { export_leaves(file, folder.file("out.ply")); }),
            ErrorCode::damaged_chunk);
  EXPECT_FALSE(std::filesystem::exists(folder.file("out.ply")));
}

// Chunks that are whole, of a tree that is not.
TEST(ExportLeaves, ATreeThatIsNotSoundIsRefusedByChunk) {
  for (const auto shape : {test::TreeShape::star, test::TreeShape::star_of_stars,
                           test::TreeShape::recursive, test::TreeShape::eight_way}) {
    const test::TempFolder folder;
    const std::string ply = folder.file("out.ply"), hier = folder.file("out.hier");
    const test::Bytes bytes = test::scene_bytes(test::baked_of(test::random_tree(shape, 320, 5)),
                                                Quality::lossless, 1, kMinChunkBytes);
    const SceneFile sound(test::source_of(bytes));
    EXPECT_NO_THROW(export_leaves(sound, ply));
    EXPECT_NO_THROW(export_hier(sound, hier));
    for (const std::string& path : {ply, hier}) std::filesystem::remove(path);
    for (uint32_t chunk = 1; chunk < sound.chunks().size(); ++chunk) {
      // Its first record is larger than the parent's, or than that of the same node before.
      test::Bytes altered = bytes;
      NodeRecord record;
      std::byte* place = altered.data() + sound.chunks()[chunk].offset + sizeof(ChunkHeader);
      std::memcpy(&record, place, sizeof record);
      record.box_max.x += 1000;
      std::memcpy(place, &record, sizeof record);
      const test::Bytes file = test::sealed(std::move(altered));
      const SceneFile scene(test::source_of(file));
      for (const std::string& path : {ply, hier}) {
        try {
          if (path == ply)
            export_leaves(scene, path);
          else
            export_hier(scene, path);
          ADD_FAILURE() << path << " " << chunk;
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::refused_input);
          const std::string where = ": chunk " + std::to_string(chunk) + ": node ";
          EXPECT_NE(std::string(error.what()).find(where), std::string::npos) << error.what();
        }
        EXPECT_FALSE(std::filesystem::exists(path));
      }
    }
  }
}

}  // namespace
}  // namespace voyager::export_flat_test
