#include <cstring>

#include "runtime/base/checksum.h"
#include "runtime/frame/scene.h"
#include "runtime/scene/export/writer.h"
#include "runtime/scene/import/importer.h"
#include "tests/support/scene_files.h"

namespace voyager {
namespace {

using test::Bytes;

std::shared_ptr<const Scene> load(std::shared_ptr<const ByteSource> source) {
  Workers workers;
  return load_scene(std::move(source), std::pmr::get_default_resource(), workers);
}

std::shared_ptr<const Scene> load(const Bytes& bytes) {
  return load(test::source_of(bytes));
}

Bytes ply_bytes(const GaussianCloud& cloud) {
  const test::TempFolder folder;
  AtomicFile file(folder.file("scene.ply"));
  const auto sink = sink_to(file);
  const auto writer = write_ply(*sink, cloud.size(), cloud.sh_degree, false);
  writer->append(cloud);
  writer->finish();
  file.commit();
  return test::file_bytes(folder.file("scene.ply"));
}

void expect_leaves_equal_flat(const Scene& baked, const Scene& flat) {
  ASSERT_TRUE(flat.flat());
  ASSERT_FALSE(baked.flat());
  ASSERT_EQ(baked.leaves.size(), flat.gaussians.size());
  EXPECT_EQ(std::memcmp(&baked.origin, &flat.origin, sizeof flat.origin), 0);
  const size_t floats = static_cast<size_t>(flat.coefficients()) * 3;
  for (uint32_t i = 0; i < flat.gaussians.size(); ++i) {
    const uint32_t node = baked.leaves[i];
    ASSERT_EQ(std::memcmp(&baked.gaussians[node], &flat.gaussians[i], sizeof(Gaussian)), 0);
    ASSERT_EQ(std::memcmp(baked.sh_of(node), flat.sh_of(i), floats * sizeof(float)), 0);
  }
}

TEST(LoadScene, LeavesOfALosslessBakeEqualTheFlatScene) {
  for (const float offset : {0.0f, 2.0e6f}) {
    GaussianCloud cloud = test::random_cloud(3000, 40, 2);
    for (size_t i = 0; i < cloud.size(); ++i) cloud.position[3 * i + 2] += offset;
    cloud.position[4] = -0.0f;
    const auto flat = load(ply_bytes(cloud));
    const auto baked = load(test::scene_bytes(test::bake(cloud), Quality::lossless));
    EXPECT_EQ(flat->origin.z != 0, offset != 0);
    expect_leaves_equal_flat(*baked, *flat);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(flat->bounds_min[axis], baked->bounds_min[axis]);
      EXPECT_EQ(flat->bounds_max[axis], baked->bounds_max[axis]);
    }
  }
}

TEST(LoadScene, BringsTheTreeBack) {
  const BakedScene baked = test::bake(test::random_cloud(5000, 41, 0));
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    const auto scene = load(test::scene_bytes(baked, quality));
    ASSERT_EQ(scene->tree.size(), baked.tree.size());
    EXPECT_EQ(scene->tree.parent, baked.tree.parent);
    EXPECT_EQ(scene->axis_code, baked.axis_code);
    for (uint32_t n = 0; n < baked.tree.size(); ++n) {
      if (baked.tree.is_leaf(n)) {
        ASSERT_EQ(scene->leaves[baked.gaussian[n]], n);
      } else {
        ASSERT_EQ(scene->tree.first_child[n], baked.tree.first_child[n]);
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
  const SceneFile::ChunkExtent& bad = file.chunks()[1];
  const auto scene =
      load(std::make_shared<test::FlippedSource>(bytes, bad.offset + 200, std::byte{1}));
  ASSERT_EQ(scene->damaged.size(), 1u);
  EXPECT_EQ(scene->damaged[0].first, bad.first_node);
  EXPECT_EQ(scene->damaged[0].count, bad.node_count);
  EXPECT_NE(scene->damaged[0].message.find("chunk 1"), std::string::npos);
  const auto in_bad = [&](uint32_t n) {
    return n >= bad.first_node && n - bad.first_node < bad.node_count;
  };
  for (uint32_t n = 0; n < baked.tree.size(); ++n) {
    const uint32_t parent = baked.tree.parent[n];
    ASSERT_EQ(scene->tree.parent[n], parent == kNoNode || in_bad(parent) ? kNoNode : parent);
    if (in_bad(n)) {
      ASSERT_EQ(scene->gaussians[n].opacity, 0.0f);
      ASSERT_EQ(scene->tree.records[n].child_count, 0u);
    }
    if (baked.tree.is_leaf(n)) {
      ASSERT_EQ(scene->leaves[baked.gaussian[n]], in_bad(n) ? kNoNode : n);
    }
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
  const Bytes sound =
      test::scene_bytes(test::bake(test::random_cloud(100, 45, 0)), Quality::lossless);
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
        changed([](FileHeader& h) { h.bounds_min[0] -= 1; })})
    EXPECT_EQ(test::error_code([&] { load(bytes); }), ErrorCode::refused_input);
}

TEST(LoadScene, UnknownBytesAreRefusedByName) {
  for (const char* text : {"", "glTF and more", "x"}) {
    const std::string words = text;
    const auto span = std::as_bytes(std::span(words));
    const Bytes bytes(span.begin(), span.end());
    try {
      load(bytes);
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::refused_input);
      EXPECT_NE(std::string(error.what()).find(".voy, .ply or .spz"), std::string::npos);
    }
  }
}

TEST(LoadScene, SaysWhatWasMendedAndWhatIsLeftOut) {
  GaussianCloud cloud = test::random_cloud(20, 46, 1);
  cloud.rotation[0] = cloud.rotation[1] = cloud.rotation[2] = cloud.rotation[3] = 0;
  cloud.opacity[3] = std::numeric_limits<float>::quiet_NaN();
  const auto scene = load(ply_bytes(cloud));
  EXPECT_EQ(scene->gaussians.size(), 19u);
  uint64_t repaired = 0, dropped = 0, omitted_bytes = 0;
  for (const SceneNote& note : scene->notes) {
    if (note.kind == SceneNote::Kind::repaired) repaired += note.count;
    if (note.kind == SceneNote::Kind::dropped) dropped += note.count;
    if (note.kind == SceneNote::Kind::omitted) omitted_bytes += note.bytes;
  }
  EXPECT_EQ(repaired, 1u);
  EXPECT_EQ(dropped, 1u);
  EXPECT_EQ(omitted_bytes, 19u * (41 + 36 * 4));
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
  const Bytes bytes = ply_bytes(test::random_cloud(20000, 47, 3));
  CountingMemory memory;
  Workers workers(1);
  load_scene(test::source_of(bytes), &memory, workers);
  EXPECT_LE(memory.peak, 20000u * (192 + 44 + sizeof(Gaussian)) + 65536);
}

TEST(LoadScene, MemoryThatIsRefusedComesOutAsBadAlloc) {
  const GaussianCloud cloud = test::random_cloud(100, 48, 0);
  Workers workers(1);
  for (const Bytes& bytes :
       {ply_bytes(cloud), test::scene_bytes(test::bake(cloud), Quality::compact)})
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
}  // namespace voyager
