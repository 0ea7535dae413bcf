#include "runtime/scene/import/importer.h"

#include "runtime/scene/export/writer.h"
#include "runtime/scene/import/format_name.h"
#include "tests/support/counting_memory.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::importer_test {
namespace {

using test::Bytes;

TEST(Importer, TellsFormatsByTheirFirstBytes) {
  EXPECT_TRUE(is_importable(test::bytes_of("ply\nformat"), ""));
  EXPECT_TRUE(is_importable(test::bytes_of("ply\r"), ""));
  EXPECT_TRUE(is_importable(test::bytes_of("NGSP"), ""));
  EXPECT_TRUE(is_importable(test::bytes_of("\x1f\x8b"), ""));
  EXPECT_TRUE(is_importable(test::bytes_of("glTF"), ""));
  EXPECT_TRUE(is_importable(test::bytes_of("{\"as"), ""));
  EXPECT_TRUE(is_importable(test::bytes_of(" \n\t{"), ""));
  EXPECT_FALSE(is_importable(test::bytes_of("    "), ""));
  EXPECT_FALSE(is_importable(test::bytes_of("plyx"), ""));
  EXPECT_FALSE(is_importable(test::bytes_of("NGS"), ""));
  EXPECT_FALSE(is_importable({}, ""));
}

TEST(Importer, NamesTheFormat) {
  const auto named = [](const std::string& name, const std::string& text) {
    const Bytes bytes = test::bytes_of(text);
    return format_name(MemorySource(name, bytes));
  };
  EXPECT_EQ(named("a", "ply\n"), ".ply");
  EXPECT_EQ(named("a.splat", ""), ".splat");
  EXPECT_EQ(named("f/meta.json", "{}"), "SOG");
  test::BytesSink sink;
  const auto writer = write_spz(sink, 1, 0, 1.0f, 3);
  writer->append(test::random_cloud(1, 1, 0));
  writer->finish();
  EXPECT_EQ(format_name(MemorySource("a", sink.bytes)), "SPZ 3");
  EXPECT_NE(test::refusal_of([&] { named("a", "hello"); }), "");
}

TEST(Importer, RefusesWhatItDoesNotKnowAndListsWhatItDoes) {
  test::expect_refused({}, "an empty input", "empty");
  test::expect_refused(test::bytes_of("GLTF...."), "47 4c 54 46", "no .glb");
  test::expect_refused(test::bytes_of("p"), ".spz", "one byte");
}

TEST(Importer, SaysWhichFormatIsKnownAndNotRead) {
  const auto refusal = [](const std::string& name, const std::string& text) {
    const Bytes bytes = test::bytes_of(text);
    return test::refusal_of([&] { import_gaussians(std::make_shared<MemorySource>(name, bytes)); });
  };
  EXPECT_NE(refusal("a.radc", "RADC....").find("give the .rad that names it"), std::string::npos);
  EXPECT_NE(refusal("meta.lcc2", "{}").find("LCC2 is not read"), std::string::npos);
  EXPECT_EQ(refusal("meta.lcd", "{}").find("is not read"), std::string::npos);
}

// As a failed download leaves it. Some formats have no header that could be missed.
TEST(Importer, AFileOfNothingIsNoScene) {
  for (const char* name : {"a.ply", "a.spz", "a.splat", "a.ksplat", "a.hier", "a.hier_opt", "a.lcc",
                           "a.rad", "a.glb", "meta.json", "lod-meta.json"})
    EXPECT_NE(
        test::refusal_of([&] { import_gaussians(std::make_shared<MemorySource>(name, Bytes())); }),
        "")
        << name;
}

// What the first bytes are told by must not be lost on a stream that cannot go back.
TEST(Importer, ReadsAPipeAsItReadsAFile) {
  const GaussianCloud cloud = test::random_cloud(3000, 7, 3);
  for (const Bytes& bytes : {test::ply_of(cloud), test::spz_v4(cloud), test::planar_spz(2, 40, 1),
                             test::gzip(test::planar_spz(3, 5000, 2))}) {
    const GaussianCloud file = test::import_bytes(bytes), pipe = test::import_piped(bytes);
    EXPECT_GT(file.size(), 0u);
    test::expect_same(file, pipe);
  }
}

TEST(Importer, SanitisesAndReports) {
  GaussianCloud cloud = test::random_cloud(3, 7, 0);
  cloud.position[0] = std::nanf("");
  cloud.opacity[2] = std::numeric_limits<float>::infinity();
  const GaussianCloud read = test::import_bytes(test::ply_of(cloud));
  EXPECT_EQ(read.size(), 2u);
  EXPECT_EQ(read.report.read, 3u);
  EXPECT_EQ(read.report.dropped_position, 1u);
  EXPECT_EQ(read.report.repaired_opacity, 1u);
}

TEST(Importer, ReportsProgressUpToTheTotal) {
  const GaussianCloud cloud = test::random_cloud(9000, 7, 1);
  for (const Bytes& bytes : {test::ply_of(cloud), test::spz_v4(cloud)}) {
    uint64_t last = 0, end = 1;
    ImportOptions options;
    options.progress = [&](const char* stage, uint64_t done, uint64_t total) {
      EXPECT_STREQ(stage, "reading");
      EXPECT_GT(done, last);
      last = done;
      end = total;
    };
    test::import_bytes(bytes, options);
    EXPECT_EQ(last, end);
  }
}

TEST(Importer, HoldsLittleMoreThanTheCloud) {
  const GaussianCloud cloud = test::random_cloud(40000, 9, 3);
  const size_t whole = cloud.size() * 236;
  for (const Bytes& bytes : {test::ply_of(cloud), test::spz_v4(cloud)}) {
    test::CountingMemory known, piped;
    ImportOptions options;
    options.memory = &known;
    EXPECT_EQ(test::import_bytes(bytes, options).size(), cloud.size());
    options.memory = &piped;
    EXPECT_EQ(test::import_piped(bytes, options).size(), cloud.size());
    EXPECT_LE(known.most(), whole * 5 / 4);
    EXPECT_LE(piped.most(), whole * 5 / 4);
  }
}

TEST(Importer, AllocatesNothingOnTheWordOfAHeader) {
  std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\n";
  for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0",
                           "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    ply += std::string("property float ") + name + "\n";
  Bytes spz = test::planar_spz(3, 10, 3);
  const uint32_t many = 0xffffffffu;
  std::memcpy(spz.data() + 8, &many, 4);
  for (const Bytes& bytes : {test::bytes_of(ply + "end_header\nabc"), spz, test::gzip(spz)}) {
    test::CountingMemory memory;
    ImportOptions options;
    options.memory = &memory;
    EXPECT_NE(test::refusal_of([&] { test::import_bytes(bytes, options); }), "");
    EXPECT_NE(test::refusal_of([&] { test::import_piped(bytes, options); }), "");
    EXPECT_LE(memory.most(), 4096u);
  }
}

}  // namespace
}  // namespace voyager::importer_test
