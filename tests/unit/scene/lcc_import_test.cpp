// LCC scenes, made by hand: what each code becomes, which Gaussians belong to a scene, and what is
// refused.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include "runtime/base/file.h"
#include "runtime/math/affine.h"
#include "runtime/scene/import/block_reader.h"
#include "tests/fuzz/memory_folder.h"
#include "tests/support/lcc_files.h"
#include "tests/support/test_support.h"

namespace voyager::lcc_import_test {
namespace {

using test::LccFiles;
using Json = nlohmann::json;

std::shared_ptr<const ByteSource> open(const LccFiles& files) {
  const auto folder = std::make_shared<fuzz::FileOfFolder::Folder>(files);
  return std::make_shared<fuzz::FileOfFolder>(folder, "scene.lcc", folder->at("scene.lcc"));
}

GaussianCloud import_lcc(const LccFiles& files) {
  return import_gaussians(open(files));
}

std::string refusal(const LccFiles& files) {
  return test::refusal_of([&] { import_lcc(files); });
}

void expect_refused(const LccFiles& files, const std::string& part) {
  const std::string message = refusal(files);
  EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

LccFiles with_meta(LccFiles files, const Json& meta) {
  files["scene.lcc"] = test::bytes_of(meta.dump());
  return files;
}

// One Gaussian, one level.
LccFiles one_row(const test::LccRow& row, const test::Bytes& sh = {}) {
  LccFiles files;
  test::put_lcc_cell(files["index.bin"], {{0, 1}});
  test::put(files["data.bin"], row);
  if (!sh.empty()) files["shcoef.bin"] = sh;
  return with_meta(files, test::lcc_meta(1, !sh.empty()));
}

// In INRIA's axes (x, y, z) is (x, -z, y) of the file.
TEST(LccImport, DecodesEveryField) {
  const GaussianCloud cloud =
      import_lcc(one_row({{1, 2, 3}, {0, 51, 255, 204}, {0, 65535, 13107}, 3u << 30}));
  ASSERT_EQ(cloud.size(), 1u);
  EXPECT_EQ(cloud.sh_degree, 0);
  EXPECT_FALSE(cloud.native.antialiased());
  const float place[3] = {1, -3, 2};
  const double scale[3] = {0.5, 3, 2.4}, colour[3] = {0, 0.2, 1};
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(cloud.position[k], place[k]);
    EXPECT_NEAR(cloud.log_scale[k], std::log(scale[k]), 1e-6);
    EXPECT_NEAR(cloud.sh[k], (colour[k] - 0.5) / 0.28209479177387814, 1e-6);
  }
  EXPECT_NEAR(cloud.opacity[0], std::log(4.0), 1e-5);
}

// Three of x, y, z, w from the low bits on, of -sqrt(1/2) to sqrt(1/2); the fourth is not negative.
TEST(LccImport, RotationsLeaveOutTheLargestComponent) {
  const std::array<uint32_t, 3> codes{200, 700, 600};
  for (uint32_t largest = 0; largest < 4; ++largest) {
    const uint32_t word = largest << 30 | codes[2] << 20 | codes[1] << 10 | codes[0];
    const GaussianCloud cloud = import_lcc(one_row({{}, {0, 0, 0, 9}, {}, word}));
    std::array<double, 4> xyzw{};
    double squared = 0;
    for (uint32_t i = 0, k = 0; i < 4; ++i)
      if (i != largest) {
        xyzw[i] = (2 * codes[k++] / 1023.0 - 1) * std::sqrt(0.5);
        squared += xyzw[i] * xyzw[i];
      }
    xyzw[largest] = std::sqrt(1 - squared);
    const Mat3d of_file = rotation(Quatd{xyzw[3], xyzw[0], xyzw[1], xyzw[2]});
    const float* q = cloud.rotation.data();
    const Mat3d read = rotation(normalise(Quatd{q[0], q[1], q[2], q[3]}));
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(read.row[0][i], of_file.row[0][i], 1e-6) << largest;
      EXPECT_NEAR(read.row[1][i], -of_file.row[2][i], 1e-6) << largest;
      EXPECT_NEAR(read.row[2][i], of_file.row[1][i], 1e-6) << largest;
    }
  }
}

// A word for each coefficient: red of 11 bits from the low end on, green of 10, blue of 11.
TEST(LccImport, ShShowTheSameColourFromTheSameSide) {
  test::Bytes sh;
  test::put_lcc_sh(sh, 5);
  const GaussianCloud cloud = import_lcc(one_row({{}, {9, 9, 9, 9}, {}, 3u << 30}, sh));
  ASSERT_EQ(cloud.sh_degree, 3);
  const Vec3d direction{0.48, -0.6, 0.64};
  double of_file[16], read[16];
  sh_basis(3, direction, of_file);
  sh_basis(3, Vec3d{direction.x, -direction.z, direction.y}, read);
  const double least[3] = {-1, -2, -4}, most[3] = {1, 2, 3}, steps[3] = {2047, 1023, 2047};
  for (size_t c = 0; c < 3; ++c) {
    double expected = 0, found = 0;
    for (size_t k = 1; k < 16; ++k) {
      uint32_t word = 0;
      std::memcpy(&word, sh.data() + 4 * (k - 1), sizeof word);
      const uint32_t codes[3] = {word & 2047, word >> 11 & 1023, word >> 21};
      expected += of_file[k] * (least[c] + (most[c] - least[c]) * codes[c] / steps[c]);
      found += read[k] * static_cast<double>(cloud.sh[3 * k + c]);
    }
    EXPECT_NEAR(found, expected, 1e-5) << c;
  }
}

std::vector<float> first_coordinates(const GaussianCloud& cloud) {
  std::vector<float> x;
  for (size_t i = 0; i < cloud.size(); ++i) x.push_back(cloud.position[3 * i]);
  return x;
}

TEST(LccImport, IsTheFinestLevelOfEachCellInTheOrderOfDataBin) {
  EXPECT_EQ(first_coordinates(import_lcc(test::lcc_files(false))),
            (std::vector<float>{0.5f, 1.5f, 2.5f, 4.5f, 5.5f}));
  LccFiles files = test::lcc_files(false);
  files["index.bin"].clear();
  test::put_lcc_cell(files["index.bin"], {{4, 0}, {6, 1}});  // nothing at the finest level
  test::put_lcc_cell(files["index.bin"], {{0, 3}, {3, 1}});
  test::put_lcc_cell(files["index.bin"], {{0, 0}, {0, 0}});
  EXPECT_EQ(first_coordinates(import_lcc(files)), (std::vector<float>{0.5f, 1.5f, 2.5f, 6.5f}));
}

TEST(LccImport, ItsEnvironmentBelongsToItWithBoundsOfItsOwn) {
  for (const bool has_sh : {false, true}) {
    LccFiles files = test::lcc_files(has_sh);
    files["environment.bin"] = test::lcc_environment(8, 2, has_sh);
    const GaussianCloud cloud = import_lcc(files);
    EXPECT_EQ(first_coordinates(cloud),
              (std::vector<float>{0.5f, 1.5f, 2.5f, 4.5f, 5.5f, 8.5f, 9.5f}));
    const double share = test::lcc_row(9).scale[1] / 65535.0;
    EXPECT_NEAR(cloud.log_scale[3 * 6 + 1], std::log(10 + 20 * share), 1e-6);
    EXPECT_EQ(cloud.sh_degree, has_sh ? 3 : 0);
  }
}

// As their own SH bands, of which band 1 keeps its length in any axes.
TEST(LccImport, ShOfAnEnvironmentFollowEachOfItsRows) {
  LccFiles files = test::lcc_files(true);
  files["environment.bin"] = test::lcc_environment(0, 7, true);
  const GaussianCloud cloud = import_lcc(files);
  ASSERT_EQ(cloud.size(), 12u);
  const auto length = [&](size_t i) {
    double squared = 0;
    for (size_t k = 1; k < 4; ++k) squared += std::pow(cloud.sh[48 * i + 3 * k], 2);
    return std::sqrt(squared);
  };
  // Red is of -1 to 1 in one and of -0.5 to 0.5 in the other.
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(length(i), 2 * length(5 + i), 1e-5) << i;
}

TEST(LccImport, BlocksAgreeWithTheWhole) {
  LccFiles files = test::lcc_files(true);
  files["environment.bin"] = test::lcc_environment(8, 3, true);
  const GaussianCloud whole = import_lcc(files);
  const auto reader = open_blocks(open(files));
  EXPECT_EQ(reader->count(), 8u);
  std::vector<float> positions, sh;
  for (RawBlock block = reader->next(2); block.count > 0; block = reader->next(2)) {
    EXPECT_LE(block.count, 2u);
    const GaussianCloud cloud = reader->decode(block);
    positions.insert(positions.end(), cloud.position.begin(), cloud.position.end());
    sh.insert(sh.end(), cloud.sh.begin(), cloud.sh.end());
  }
  EXPECT_EQ(positions, std::vector<float>(whole.position.begin(), whole.position.end()));
  EXPECT_EQ(sh, std::vector<float>(whole.sh.begin(), whole.sh.end()));
}

// Versions 2 and 3 have no fileType.
TEST(LccImport, WithoutAFileTypeTheFileOfShTellsWhetherThereAreAny) {
  Json meta = test::lcc_meta(2, false);
  meta.erase("fileType");
  meta["version"] = "3.0";
  EXPECT_EQ(import_lcc(with_meta(test::lcc_files(true), meta)).sh_degree, 3);
  EXPECT_EQ(import_lcc(with_meta(test::lcc_files(false), meta)).sh_degree, 0);
}

TEST(LccImport, ReadsTheNamesOfTheDescription) {
  const LccFiles files = test::lcc_files(true);
  const LccFiles named = {{"scene.lcc", files.at("scene.lcc")},
                          {"Index.bin", files.at("index.bin")},
                          {"Data.bin", files.at("data.bin")},
                          {"Shcoef.bin", files.at("shcoef.bin")}};
  EXPECT_EQ(import_lcc(named).sh, import_lcc(files).sh);
}

TEST(LccImport, TellsThatThePlaceOnEarthIsLeftOut) {
  Json meta = test::lcc_meta(2, false);
  EXPECT_TRUE(left_out_of(*open(test::lcc_files(false))).empty());
  meta["offset"] = {689605.6, 5338780.5, 565.6};
  const LccFiles files = with_meta(test::lcc_files(false), meta);
  EXPECT_EQ(left_out_of(*open(files)),
            std::vector<std::string>{"the scene's place on Earth (offset)"});
  EXPECT_EQ(import_lcc(files).position, import_lcc(test::lcc_files(false)).position);
}

TEST(LccImport, RefusesAMetaThatItDoesNotKnow) {
  const auto expect = [](const char* pointer, const Json& value, const std::string& part) {
    Json meta = test::lcc_meta(2, true);
    meta[Json::json_pointer(pointer)] = value;
    expect_refused(with_meta(test::lcc_files(true), meta), "scene.lcc: offset 0: " + part);
  };
  expect("/version", "6.0", "version: found \"6.0\", expected 2 to 5");
  expect("/version", "50", "version");
  expect("/encoding", "RAW", "encoding: found \"RAW\", expected \"COMPRESS\"");
  expect("/fileType", "Fast", "fileType");
  expect("/shift", {0, 1, 0}, "shift: found other numbers, expected 0, 0, 0");
  expect("/scale", {2, 2, 2}, "scale: found other numbers, expected 1, 1, 1");
  expect("/totalLevel", 0, "totalLevel");
  expect("/totalLevel", uint64_t{1} << 60, "totalLevel");
  expect("/indexDataSize", 20, "indexDataSize: found 20, expected a whole number from 36 to 36");
  expect("/attributes/0/name", "size", "attributes: found no scale");
  expect("/attributes/1/name", "colour", "attributes: found no shcoef");
  expect("/attributes/0/max", {1, 2}, "attributes[0].max");
  expect("/attributes/0/max/1", 1e300, "attributes[0].max[1]");
}

TEST(LccImport, RefusesFilesThatAreMissingOrDoNotFit) {
  for (const char* name : {"index.bin", "data.bin", "shcoef.bin"}) {
    LccFiles files = test::lcc_files(true);
    files.erase(name);
    expect_refused(files, std::string("scene.lcc: offset 0: ") + name + ": found no such file");
  }
  const auto expect_cut = [](const char* name, const std::string& part) {
    LccFiles files = test::lcc_files(true);
    files["environment.bin"] = test::lcc_environment(8, 2, true);
    files[name].pop_back();
    expect_refused(files, part);
  };
  expect_cut("index.bin", "index.bin: offset 0: length: found 71 bytes");
  expect_cut("data.bin", "index.bin: offset 60: offset: found 32 bytes at 192");
  expect_cut("shcoef.bin", "shcoef.bin: offset 0: length: found 447 bytes, expected 448");
  expect_cut("environment.bin", "environment.bin: offset 0: length: found 191 bytes");
  for (const std::string name : {"index.bin", "environment.bin"}) {
    LccFiles nothing = test::lcc_files(true);
    nothing[name].clear();
    expect_refused(nothing, name + ": offset 0: length: found 0 bytes");
  }
  LccFiles files = test::lcc_files(false);
  files["environment.bin"] = test::lcc_environment(8, 1, false);
  Json meta = test::lcc_meta(2, false);
  meta["attributes"].erase(2);
  expect_refused(with_meta(files, meta), "attributes: found no envscale");
}

// A cell of the index claims four billion Gaussians, all bytes of data.bin over and over, or more
// than there are.
TEST(LccImport, RefusesMoreGaussiansThanDataBinHas) {
  const auto refused = [](const std::vector<test::LccLevel>& cells, const std::string& part) {
    LccFiles files = test::lcc_files(false);
    files["index.bin"].clear();
    for (const test::LccLevel& cell : cells) test::put_lcc_cell(files["index.bin"], {cell, {0, 0}});
    expect_refused(files, part);
  };
  refused({{0, UINT32_MAX}}, "index.bin: offset 16: size");  // which does not fit 32 bits
  refused({{0, 8}}, "found 256 bytes at 0, expected a place in the 224 bytes of data.bin");
  refused({{UINT64_MAX / 32, 1}}, "index.bin: offset 8: offset");
  refused(std::vector<test::LccLevel>(1000, {0, 7}), "the bytes of data.bin from 0 twice");
  refused({{0, 3}, {2, 3}}, "the bytes of data.bin from 64 twice");
}

TEST(LccImport, ItsFilesLieInItsFolder) {
  const test::TempFolder outside, folder;
  LccFiles files = test::lcc_files(false);
  for (const auto& [name, bytes] : files)
    std::ofstream(name == "data.bin" ? outside.file(name) : folder.file(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  std::filesystem::create_symlink(outside.file("data.bin"), folder.file("data.bin"));
  const auto import = [&] { test::import_file(folder.file("scene.lcc")); };
  EXPECT_NE(test::refusal_of(import).find("in the same folder or below"), std::string::npos);
}

// A cloud of no more than there is, or a refusal.
void expect_read_or_refused(const LccFiles& files) {
  try {
    EXPECT_LE(import_lcc(files).size(), 9u);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::refused_input) << error.what();
  }
}

TEST(LccImport, EveryTruncationAndFlippedByteIsReadOrRefused) {
  LccFiles files = test::lcc_files(true);
  files["environment.bin"] = test::lcc_environment(8, 2, true);
  for (const auto& [name, bytes] : files)
    for (size_t i = 0; i < bytes.size(); ++i) {
      LccFiles cut = files, flipped = files;
      cut[name].resize(i);
      expect_read_or_refused(cut);
      flipped[name][i] ^= std::byte{0xff};
      expect_read_or_refused(flipped);
    }
}

TEST(LccImport, EveryFieldMissingOrAbsurdIsReadOrRefused) {
  const Json good = test::lcc_meta(2, true);
  const Json flat = good.flatten();
  for (const auto& [path, value] : flat.items())
    for (const Json& other : {Json(nullptr), Json(-1), Json(1e300), Json("x"), Json::object()}) {
      Json meta = good;
      meta[Json::json_pointer(path)] = other;
      expect_read_or_refused(with_meta(test::lcc_files(true), meta));
    }
}

}  // namespace
}  // namespace voyager::lcc_import_test
