// A bake in cells gives the file of a bake in memory, to the byte, whatever the cells,
// the memory and the moment at which it was killed.
#include "runtime/bake/bake.h"

#include <cstring>
#include <optional>

#include "runtime/scene/append.h"
#include "runtime/scene/export/writer.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/sanitise.h"
#include "runtime/scene/sh_bands.h"
#include "tests/support/mixed_footprints.h"
#include "tests/support/scene_files.h"
#include "tests/support/tree_clouds.h"

namespace voyager::bake_in_parts_test {
namespace {

using test::Bytes;

void write_cloud(const std::string& path, const GaussianCloud& cloud) {
  AtomicFile file(path);
  const auto sink = sink_to(file);
  const auto writer = path.ends_with(".ply") ? write_ply(*sink, cloud.size(), cloud.sh_degree)
                                             : write_spz(*sink, cloud.size(), cloud.sh_degree);
  writer->append(cloud);
  writer->finish();
  file.commit();
}

std::vector<std::unique_ptr<BlockReader>> open_all(const std::vector<std::string>& paths) {
  std::vector<std::unique_ptr<BlockReader>> readers;
  for (const std::string& path : paths) readers.push_back(open_blocks(open_file_source(path)));
  return readers;
}

struct Case {
  Quality quality = Quality::compact;
  uint32_t chunk_bytes = kDefaultChunkBytes, most_in_cell = 1300;
  uint64_t memory = 1'000'000;
  unsigned threads = 0;
};

void write_all(const std::string& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

class Folder {
 public:
  explicit Folder(const std::vector<GaussianCloud>& clouds, const std::string& extension = ".ply") {
    for (size_t i = 0; i < clouds.size(); ++i) {
      inputs.push_back(folder.file("input" + std::to_string(i) + extension));
      write_cloud(inputs.back(), clouds[i]);
    }
  }

  BakeInParts request(const Case& c) const {
    BakeInParts bake;
    bake.request = bake_request(inputs, c.quality, c.chunk_bytes, test::kSmallBlocks);
    bake.rule = test::kSmallBlocks;
    bake.output = folder.file("parts.voy");
    bake.work = folder.file("work");
    bake.quality = c.quality;
    bake.chunk_bytes = c.chunk_bytes;
    bake.memory = c.memory;
    bake.most_in_cell = c.most_in_cell;
    return bake;
  }

  BakeSummary run(const BakeInParts& bake, unsigned threads = 0) const {
    Workers workers(threads);
    return bake_in_parts(bake, [&] { return open_all(inputs); }, workers, {});
  }

  // The tree is the same in every case: it is built once.
  Bytes in_memory(const Case& c) const {
    return test::scene_bytes(baked(), c.quality, 0, c.chunk_bytes);
  }
  const BakedScene& baked() const {
    if (baked_) return *baked_;
    std::vector<uint32_t> ends;
    GaussianCloud cloud = read_inputs(&ends);
    const FoundScale found = native_scale({}, cloud, ends);
    cloud.native = found.scale;
    const std::vector<uint8_t> levels = levels_of(found.inputs);
    baked_ = build_tree(std::move(cloud), workers_, {}, test::kSmallBlocks, {.known = levels});
    return *baked_;
  }
  GaussianCloud read_inputs(std::vector<uint32_t>* ends = nullptr) const {
    GaussianCloud all;
    for (size_t i = 0; i < inputs.size(); ++i) {
      const auto source = open_file_source(inputs[i]);
      GaussianCloud cloud = import_gaussians(*read_source(*source));
      if (i == 0)
        all = std::move(cloud);
      else
        append(all, std::move(cloud), inputs[i]);
      if (ends != nullptr) ends->push_back(static_cast<uint32_t>(all.size()));
    }
    return all;
  }

  Bytes output() const { return test::file_bytes(folder.file("parts.voy")); }
  bool has_work() const { return std::filesystem::exists(folder.file("work")); }

  void expect_equal(const Case& c) const {
    const BakeSummary summary = run(request(c), c.threads);
    const Bytes whole = in_memory(c), parts = output();
    EXPECT_TRUE(whole == parts) << whole.size() << " bytes in memory, " << parts.size()
                                << " in parts of " << summary.cells << " cells";
    EXPECT_FALSE(has_work());
  }

  test::TempFolder folder;
  std::vector<std::string> inputs;

 private:
  mutable Workers workers_;
  mutable std::optional<BakedScene> baked_;
};

// Bands that only some blocks, or none, of the input use.
TEST(BakeInParts, LeavesOutTheShBandsThatABakeInMemoryLeavesOut) {
  for (const int used : {0, 2}) {
    GaussianCloud cloud = test::specks(9000, 4, used);
    change_sh_degree(cloud.sh, used, 3);
    cloud.sh_degree = 3;
    if (used == 0) cloud.sh[48 * size_t{8000} + 4] = 0.5f;  // of band 1
    for (const Case& c : {Case{}, Case{.most_in_cell = 1u << 20}}) {
      const Folder folder({cloud});
      folder.expect_equal(c);
      EXPECT_EQ(SceneFile(open_file_source(folder.folder.file("parts.voy"))).info().sh_degree,
                std::max(used, 1));
    }
  }
}

TEST(BakeInParts, GivesTheBytesOfABakeInMemory) {
  for (const size_t count : {4096, 5003, 21841}) {
    const Folder folder({test::specks(count, 3, 1)});
    for (const Quality quality : {Quality::compact, Quality::lossless})
      folder.expect_equal({.quality = quality});
  }
}

TEST(BakeInParts, HoldsForEverySizeOfCellsChunksMemoryAndThreads) {
  const Folder folder({test::specks(9000, 4, 0)});
  for (const uint32_t most_in_cell : {1u, 3000u, 8000u})
    for (const uint32_t chunk_bytes : {kMinChunkBytes, kDefaultChunkBytes, 65536u, kMaxChunkBytes})
      folder.expect_equal({.chunk_bytes = chunk_bytes, .most_in_cell = most_in_cell});
  for (const uint64_t memory : {uint64_t{100'000}, uint64_t{100'000'000}})
    for (const unsigned threads : {1u, 4u})
      folder.expect_equal({.memory = memory, .threads = threads});
}

TEST(BakeInParts, GivesBlocksTheFootprintsOfABakeInMemory) {
  const Folder folder({test::specks(9000, 33, 1)});
  NativeChoice native;
  native.cameras = test::close_camera();
  const BakedScene baked =
      test::bake_by_cameras(folder.read_inputs(), native.cameras, test::kSmallBlocks);
  ASSERT_GT(baked.leaves.native.levels, 3);
  for (const uint32_t most_in_cell : {1300u, 1u << 20})
    for (const Quality quality : {Quality::compact, Quality::lossless}) {
      BakeInParts bake = folder.request({.quality = quality, .most_in_cell = most_in_cell});
      bake.native = native;
      const Bytes whole = test::scene_bytes(baked, quality);
      folder.run(bake);
      EXPECT_TRUE(folder.output() == whole) << most_in_cell;
      std::filesystem::remove(bake.output);
      for (const BakeStep step :
           {BakeStep::split, BakeStep::cells, BakeStep::encode, BakeStep::merge}) {
        if (most_in_cell > 9000) break;
        bake.step = step;
        folder.run(bake);
      }
      EXPECT_TRUE(most_in_cell > 9000 || folder.output() == whole);
    }
}

// Eight times as large is six levels of √2. Half of the large ones are where the small ones are:
// some blocks are of both.
TEST(BakeInParts, GivesInputsOfAnotherScaleAPixelOfTheirOwn) {
  constexpr uint32_t kSmall = 5000;
  GaussianCloud large = test::specks(4000, 35, 0);
  for (float& scale : large.log_scale) scale += std::log(8.0f);
  for (size_t i = 0; i < 2000; ++i) large.position[3 * i] += 1000;
  const Folder folder({test::specks(kSmall, 34, 0), large});
  const BakedScene& baked = folder.baked();
  size_t alone = 0;
  for (uint32_t n = 0; n < baked.tree.size(); ++n) {
    if (!baked.tree.is_leaf(n)) continue;
    const int level = footprint_level_of(baked.node_code[n]);
    ASSERT_TRUE(level == 6 || (level == 0 && baked.gaussian[n] >= kSmall)) << level;
    alone += level == 0;
  }
  EXPECT_GT(alone, 1000u);
  EXPECT_LT(alone, 4000u);
  for (const uint32_t most_in_cell : {1300u, 1u << 20})
    for (const Quality quality : {Quality::compact, Quality::lossless})
      folder.expect_equal({.quality = quality, .most_in_cell = most_in_cell});
}

TEST(BakeInParts, SaysWhatIsKnownAfterEachStep) {
  const Folder folder({test::random_cloud(6000, 32, 0)});
  BakeInParts bake = folder.request({});
  for (const BakeStep step : {BakeStep::split, BakeStep::cells, BakeStep::encode}) {
    bake.step = step;
    const BakeSummary summary = folder.run(bake);
    EXPECT_EQ(summary.gaussians, 6000u);
    EXPECT_EQ(summary.cells, 4u);
    const bool planned = step == BakeStep::encode;
    EXPECT_EQ(summary.nodes > 6000, planned);
    EXPECT_EQ(summary.subtrees > 0, planned);
    EXPECT_EQ(summary.chunks > 0, planned);
  }
}

TEST(BakeInParts, HoldsForEveryShDegree) {
  for (const int degree : {0, 1, 2, 3}) Folder({test::specks(6000, 5, degree)}).expect_equal({});
}

// Ties at every split: coordinates on a coarse grid, all of them equal, zeros of both signs.
TEST(BakeInParts, HoldsForTiesInMeans) {
  for (const float grid : {2.0f, 20.0f, 1e9f}) {
    GaussianCloud cloud = test::specks(5000, 6, 0);
    for (float& x : cloud.position) x = std::copysign(std::round(x / grid) * grid, x);
    Folder({cloud}).expect_equal({.memory = 20000});
  }
}

// A stray Gaussian far out leaves all others to one bin.
TEST(BakeInParts, HoldsForMeansOfEveryMagnitude) {
  GaussianCloud cloud = test::specks(9000, 7, 0);
  cloud.position[300] = 9e17f;
  cloud.position[700] = -1e-40f;
  for (size_t i = 3000; i < 6000; ++i) cloud.position[3 * i] *= 1e-20f;
  Folder({cloud}).expect_equal({.memory = 20000});
  for (float& x : cloud.position) x = std::fmod(x, 10.0f) + 3e6f;
  Folder({cloud}).expect_equal({.memory = 20000});
}

TEST(BakeInParts, DropsAndMendsAsTheImportDoes) {
  GaussianCloud cloud = test::specks(9000, 8, 1);
  for (size_t i = 0; i < cloud.size(); i += 7) cloud.position[3 * i] = std::nanf("");
  for (size_t i = 1; i < cloud.size(); i += 11) cloud.opacity[i] = std::nanf("");
  for (size_t i = 2; i < cloud.size(); i += 13) cloud.sh[12 * i] = INFINITY;
  for (size_t i = 3; i < cloud.size(); i += 17) cloud.log_scale[3 * i] = 40.0f;
  Folder({cloud}).expect_equal({.quality = Quality::lossless});
}

TEST(BakeInParts, TakesSeveralInputsOfSeveralDegrees) {
  Folder({test::specks(5000, 9, 0), test::specks(0, 1, 1), test::specks(3000, 10, 2),
          test::specks(40, 11, 1)})
      .expect_equal({});
}

TEST(BakeInParts, ReadsSpzInBlocks) {
  for (const int degree : {0, 3})
    Folder({test::specks(5000, 12, degree), test::specks(3000, 13, 1)}, ".spz").expect_equal({});
}

TEST(BakeInParts, ASceneTooSmallForCellsIsBakedWhole) {
  for (const size_t count : {0, 1, 17, 4095}) Folder({test::specks(count, 14, 1)}).expect_equal({});
}

TEST(BakeInParts, TheStepsOfABatchGiveTheSameBytes) {
  const Folder folder({test::specks(9000, 15, 1)});
  const Case c;
  BakeInParts bake = folder.request(c);
  const auto run = [&](BakeStep step, uint32_t part, uint32_t parts) {
    bake.step = step;
    bake.part = part;
    bake.parts = parts;
    return folder.run(bake);
  };
  EXPECT_EQ(test::error_code([&] { run(BakeStep::cells, 0, 1); }), ErrorCode::invalid_argument);
  EXPECT_GT(run(BakeStep::split, 0, 1).cells, 3u);
  run(BakeStep::cells, 2, 3);
  EXPECT_EQ(test::error_code([&] { run(BakeStep::encode, 0, 1); }), ErrorCode::invalid_argument);
  run(BakeStep::cells, 0, 3);
  run(BakeStep::cells, 1, 3);
  run(BakeStep::encode, 1, 2);
  EXPECT_FALSE(std::filesystem::exists(folder.folder.file("parts.voy")));
  run(BakeStep::merge, 0, 1);
  EXPECT_TRUE(folder.output() == folder.in_memory(c));
  EXPECT_FALSE(folder.has_work());
}

// Refused with all of `parts` in the message.
void expect_refused(const Folder& folder, const BakeInParts& bake,
                    const std::vector<std::string>& parts) {
  try {
    folder.run(bake);
    ADD_FAILURE() << parts.front();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::refused_input);
    for (const std::string& part : parts)
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(BakeInParts, AFolderOfAnotherRequestIsRefusedByName) {
  const Folder folder({test::specks(6000, 17, 0)});
  BakeInParts bake = folder.request({});
  bake.step = BakeStep::split;
  folder.run(bake);
  expect_refused(folder, folder.request({.quality = Quality::lossless}),
                 {"work", "quality compact", "quality lossless", "--work"});
  expect_refused(folder, folder.request({.chunk_bytes = 2048}), {"chunk bytes 2048"});
  write_cloud(folder.inputs[0], test::specks(6000, 18, 0));
  expect_refused(folder, folder.request({}), {"input0.ply", "changed at"});

  BakeInParts strange = folder.request({});
  strange.work = folder.folder.file("strange");
  std::filesystem::create_directory(strange.work);
  write_all(strange.work + "/thesis.tex", Bytes(4));
  expect_refused(folder, strange, {"thesis.tex", "empty folder"});
  EXPECT_TRUE(std::filesystem::exists(strange.work + "/thesis.tex"));
}

// A byte of each file of the folder, flipped.
TEST(BakeInParts, AnAlteredWorkFolderIsRefused) {
  for (const BakeStep step : {BakeStep::split, BakeStep::cells, BakeStep::encode}) {
    const Folder folder({test::specks(6000, 19, 0)});
    BakeInParts bake = folder.request({});
    for (const BakeStep s : {BakeStep::split, BakeStep::cells, BakeStep::encode}) {
      bake.step = s;
      folder.run(bake);
      if (s == step) break;
    }
    bake.step = BakeStep::merge;
    const std::string kept = folder.folder.file("kept");
    std::filesystem::rename(bake.work, kept);
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(kept))
      if (entry.file_size() != 0) names.push_back(entry.path().filename());
    ASSERT_GT(names.size(), 4u);
    for (const std::string& name : names)
      for (const double place : {0.0, 0.5, 1.0}) {
        std::filesystem::remove_all(bake.work);
        std::filesystem::copy(kept, bake.work);
        Bytes bytes = test::file_bytes(bake.work + "/" + name);
        bytes[static_cast<size_t>(place * static_cast<double>(bytes.size() - 1))] ^= std::byte{4};
        write_all(bake.work + "/" + name, bytes);
        EXPECT_EQ(test::error_code([&] { folder.run(bake); }), ErrorCode::refused_input)
            << name << " at " << place;
        EXPECT_FALSE(std::filesystem::exists(bake.output));
      }
  }
}

TEST(BakeInParts, OneBakeAtATimeWorksInAFolder) {
  const Folder folder({test::specks(6000, 20, 0)});
  BakeInParts bake = folder.request({});
  Workers workers;
  const Progress inside = [&](const char* stage, uint64_t, uint64_t) {
    if (std::strcmp(stage, "reading") != 0) return;
    EXPECT_EQ(test::error_code([&] { folder.run(bake); }), ErrorCode::io);
  };
  bake_in_parts(
      bake, [&] { return open_all(folder.inputs); }, workers, inside);
  EXPECT_TRUE(folder.output() == folder.in_memory({}));
}

TEST(BakeInParts, MemoryThatDoesNotDoIsRefusedBeforeTheCellsAreBuilt) {
  const Folder folder({test::specks(6000, 21, 3)});
  BakeInParts bake = folder.request({.most_in_cell = 0, .memory = 100'000});
  EXPECT_EQ(test::error_code([&] { folder.run(bake); }), ErrorCode::over_budget);
  bake.memory = 100'000'000;
  folder.run(bake);
  EXPECT_TRUE(folder.output() == folder.in_memory({}));
}

TEST(BakeInParts, InputsThatDoNotFitOneAnotherAreRefused) {
  const Folder folder({test::specks(5000, 22, 0)});
  GaussianCloud far = test::specks(2000, 23, 0);
  far.origin = {1024.0 * 5000, 0, 0};
  const std::string path = folder.folder.file("far.ply");
  AtomicFile file(path);
  const auto sink = sink_to(file);
  const auto writer = write_ply(*sink, far.size(), 0, true);
  writer->append(far);
  writer->finish();
  file.commit();
  Workers workers;
  EXPECT_EQ(test::error_code([&] {
              bake_in_parts(folder.request({}),
                            [&] {
                              return open_all({folder.inputs[0], path});
                            },
                            workers, {});
            }),
            ErrorCode::refused_input);
}

}  // namespace
}  // namespace voyager::bake_in_parts_test
