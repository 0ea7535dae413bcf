// The section of further Gaussians: nothing but an export to .hier reads it, and that refuses what
// does not fit together.
#include "runtime/format/further.h"

#include <filesystem>
#include <functional>

#include "runtime/format/export_flat.h"
#include "runtime/format/export_hier.h"
#include "runtime/frame/load.h"
#include "runtime/lod/kept_tree.h"
#include "tests/support/hier_files.h"
#include "tests/support/scene_files.h"

namespace voyager::further_test {
namespace {

using test::Bytes;

Bytes merged_voy(Quality quality = Quality::lossless) {
  const Bytes hier = test::hier_bytes(test::merged_roots_hier());
  return test::scene_bytes(read_kept_tree(std::make_shared<MemorySource>("test.hier", hier)).scene,
                           quality);
}

uint64_t section_of(const Bytes& voy) {
  return SceneFile(test::source_of(voy)).info().further_offset;
}

// What the message says, or nothing where the tree is written.
std::string refusal(const Bytes& voy) {
  const test::TempFolder folder;
  const std::string path = folder.file("out.hier");
  try {
    export_hier(SceneFile(test::source_of(voy)), path);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::refused_input) << error.what();
    EXPECT_FALSE(std::filesystem::exists(path));
    return error.what();
  }
}

TEST(Further, OnlyAnExportToHierReadsThem) {
  for (const Quality quality : {Quality::lossless, Quality::compact}) {
    Bytes voy = merged_voy(quality);
    const auto begin = static_cast<std::ptrdiff_t>(section_of(voy));
    std::fill(voy.begin() + begin, voy.end(), std::byte{0xff});
    Workers workers;
    EXPECT_NO_THROW(load_scene(test::source_of(voy), std::pmr::get_default_resource(), workers));
    EXPECT_EQ(read_leaves(SceneFile(test::source_of(voy))).size(), 5u);
    EXPECT_NE(refusal(voy), "");
  }
}

TEST(Further, AFileWithoutThemHasNoSection) {
  const Bytes hier = test::hier_bytes(test::small_hier());
  const Bytes voy = test::scene_bytes(
      read_kept_tree(std::make_shared<MemorySource>("test.hier", hier)).scene, Quality::compact);
  EXPECT_EQ(section_of(voy), 0u);
}

TEST(Further, EveryFlippedByteIsRefused) {
  const Bytes voy = merged_voy(Quality::compact);
  for (uint64_t at = section_of(voy); at < voy.size(); ++at) {
    Bytes flipped = voy;
    flipped[at] ^= std::byte{0x10};
    ASSERT_NE(refusal(flipped), "") << at;
  }
}

// Under checksums that are right. Words of the section: nodes, Gaussians, and then 0, 1; 1, 2;
// 4, 2.
std::string refusal_with(const std::function<void(Bytes&, uint32_t*)>& change) {
  Bytes voy = merged_voy(Quality::compact);
  const uint64_t begin = section_of(voy);
  std::vector<uint32_t> words(8);
  std::memcpy(words.data(), voy.data() + begin, 32);
  change(voy, words.data());
  std::memcpy(voy.data() + begin, words.data(), 32);
  return refusal(test::sealed(voy));
}

void expect_refused(const std::function<void(Bytes&, uint32_t*)>& change, const std::string& part) {
  EXPECT_NE(refusal_with(change).find(part), std::string::npos)
      << part << ": " << refusal_with(change);
}

TEST(Further, RefusesWhatDoesNotFitTogether) {
  EXPECT_EQ(refusal_with([](Bytes&, uint32_t*) {}), "");
  expect_refused([](Bytes&, uint32_t* w) { w[0] = 0; }, "a count of nodes");
  expect_refused([](Bytes&, uint32_t* w) { w[0] = 10; }, "a count of nodes");
  expect_refused([](Bytes&, uint32_t* w) { w[0] = UINT32_MAX; }, "a count of nodes");
  expect_refused([](Bytes&, uint32_t* w) { w[0] = 2; }, "length of the further Gaussians");
  expect_refused([](Bytes&, uint32_t* w) { w[1] = 6; }, "length of the further Gaussians");
  expect_refused([](Bytes&, uint32_t* w) { w[1] = UINT32_MAX; }, "length of the further Gaussians");
  expect_refused([](Bytes& b, uint32_t*) { b.resize(b.size() + 1); }, "length of the further");
  expect_refused([](Bytes& b, uint32_t*) { b.resize(b.size() - 4); }, "length of the further");
  expect_refused([](Bytes&, uint32_t* w) { w[6] = 9; }, "node 9, expected at most 8");
  expect_refused([](Bytes&, uint32_t* w) { w[4] = 0; }, "ascending nodes");
  expect_refused([](Bytes&, uint32_t* w) { w[6] = 0; }, "ascending nodes");
  expect_refused([](Bytes&, uint32_t* w) { w[3] = 0; }, "with 0 further Gaussians");
  expect_refused([](Bytes&, uint32_t* w) { w[3] = 2; }, "further Gaussians of all nodes 6");
  expect_refused([](Bytes&, uint32_t* w) { w[3] = UINT32_MAX; }, "further Gaussians of all nodes");
}

// Before anything of the section is read.
TEST(Further, RefusesFlagsAndLengthsAtOpen) {
  const auto opened = [](const std::function<void(Bytes&, FileHeader&)>& change) {
    Bytes voy = merged_voy(Quality::compact);
    FileHeader header;
    std::memcpy(&header, voy.data(), sizeof header);
    change(voy, header);
    std::memcpy(voy.data(), &header, sizeof header);
    voy = test::sealed(voy);
    try {
      const SceneFile file(test::source_of(voy));
      return std::string();
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  const uint64_t begin = section_of(merged_voy(Quality::compact));
  const auto expect = [&](const auto& change, const char* part) {
    EXPECT_NE(opened(change).find(part), std::string::npos) << part << ": " << opened(change);
  };
  expect([](Bytes&, FileHeader& h) { h.flags ^= kFlagFurther; }, "end of the chunks");
  expect([](Bytes&, FileHeader& h) { h.flags ^= kFlagKeptTree; }, "not a .hier's own");
  expect([](Bytes&, FileHeader& h) { h.flags |= 2 * kFlagFurther; }, "unknown flags 512");
  expect([&](Bytes& b, FileHeader&) { b.resize(begin + 259); }, "at least 260 bytes");
  expect([&](Bytes& b, FileHeader&) { b.resize(begin); }, "at least 260 bytes");
}

}  // namespace
}  // namespace voyager::further_test
