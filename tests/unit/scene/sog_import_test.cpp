// SOG: what each code of the images becomes, and what is refused.
#include "runtime/scene/import/block_reader.h"
#include "tests/support/sog_files.h"
#include "tests/support/test_support.h"

namespace voyager::sog_import_test {
namespace {

using test::Bytes;
using test::SogFiles;
using Json = nlohmann::json;

SogFiles with_meta(SogFiles files, const Json& meta) {
  files["meta.json"] = test::bytes_of(meta.dump());
  return files;
}

std::string refusal(const SogFiles& files) {
  return test::refusal_of([&] { test::import_sog(test::zip(files)); });
}

void expect_refused(const SogFiles& files, const std::string& part) {
  const std::string message = refusal(files);
  EXPECT_EQ(message.rfind("sample.sog: offset ", 0), 0u) << message;
  for (const std::string& expected : {part, std::string("found "), std::string("expected ")})
    EXPECT_NE(message.find(expected), std::string::npos) << expected << " in: " << message;
}

TEST(SogImport, DecodesPositionsFromTwoImages) {
  const GaussianCloud cloud = test::import_sog(test::zip(test::sog_files(8, 0)));
  ASSERT_EQ(cloud.size(), 8u);
  const std::vector<uint8_t> low = test::sog_pixels(8, 1, 255), high = test::sog_pixels(8, 90, 255);
  const double least[3] = {-1, 0, 2}, most[3] = {1, 3, 2.5};
  for (size_t i = 0; i < 8; ++i)
    for (size_t k = 0; k < 3; ++k) {
      const double share = (low[4 * i + k] + 256 * high[4 * i + k]) / 65535.0;
      const double v = least[k] + share * (most[k] - least[k]);
      const double expected = v < 0 ? 1 - std::exp(-v) : std::exp(v) - 1;
      EXPECT_NEAR(cloud.position[3 * i + k], expected, 1e-5) << i << k;
    }
}

TEST(SogImport, DecodesScalesAndColoursThroughTheirCodeBooks) {
  const GaussianCloud cloud = test::import_sog(test::zip(test::sog_files(8, 0)));
  const std::vector<uint8_t> scales = test::sog_pixels(8, 7), colours = test::sog_pixels(8, 200);
  for (size_t i = 0; i < 8; ++i) {
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(cloud.log_scale[3 * i + k], -8 + 0.03125f * scales[4 * i + k]);
      EXPECT_EQ(cloud.sh[3 * i + k], -2 + 0.015625f * colours[4 * i + k]);
    }
    EXPECT_NEAR(sigmoid(cloud.opacity[i]), colours[4 * i + 3] / 255.0, 1e-6);
  }
}

// The alpha byte says which component is left out; the others follow in the order w, x, y, z.
TEST(SogImport, RotationsAreUnitAndTheLargestComponentIsWhereAlphaSays) {
  SogFiles files = test::sog_files(4, 0);
  std::vector<uint8_t> codes;
  for (int largest = 0; largest < 4; ++largest)
    for (const int code : {255, 128, 100, 252 + largest})
      codes.push_back(static_cast<uint8_t>(code));
  files["quats.webp"] = test::webp(codes, 4);
  const GaussianCloud cloud = test::import_sog(test::zip(files));
  const double expected[3] = {std::sqrt(0.5), (128 / 127.5 - 1) * std::sqrt(0.5),
                              (100 / 127.5 - 1) * std::sqrt(0.5)};
  for (size_t i = 0; i < 4; ++i) {
    double squared = 0;
    for (size_t c = 0, k = 0; c < 4; ++c) {
      const auto found = static_cast<double>(cloud.rotation[4 * i + c]);
      squared += found * found;
      if (c == i)
        EXPECT_GT(found, 0.6);
      else
        EXPECT_NEAR(found, expected[k++], 1e-6);
    }
    EXPECT_NEAR(squared, 1, 1e-6);
  }
  codes[3] = 17;
  files["quats.webp"] = test::webp(codes, 4);
  EXPECT_EQ(test::import_sog(test::zip(files)).report.repaired_rotation, 1u);
}

TEST(SogImport, ShBandsComeFromTheCentroidThatTheLabelNames) {
  for (int degree = 1; degree <= 3; ++degree) {
    const GaussianCloud cloud = test::import_sog(test::zip(test::sog_files(8, degree)));
    ASSERT_EQ(cloud.sh_degree, degree);
    const auto each = static_cast<size_t>(sh_coefficients(degree) - 1);
    const std::vector<uint8_t> pixels = test::sog_pixels(128 * each, 5, 255);
    for (size_t i = 0; i < 8; ++i) {
      const size_t label = 69 - i, row = label / 64, column = label % 64;
      for (size_t j = 0; j < each; ++j)
        for (size_t k = 0; k < 3; ++k) {
          const uint8_t code = pixels[4 * (row * 64 * each + column * each + j) + k];
          EXPECT_EQ(cloud.sh[(i * (each + 1) + 1 + j) * 3 + k], -1 + 0.0078125f * code);
        }
    }
  }
}

// Before version 2: bounds in place of code books, logits, and bands as the image's width says.
TEST(SogImport, ReadsTheLayoutBeforeVersion2) {
  Json meta = test::sog_meta(8, 2);
  meta.erase("version"), meta.erase("count");
  meta["means"]["shape"] = {8, 3};
  meta["scales"] = {{"mins", {-8, -7, -6}}, {"maxs", {0, 1, 2}}, {"files", {"scales.webp"}}};
  meta["sh0"] = {{"mins", {-2, -1, 0, -4}}, {"maxs", {2, 1, 4, 6}}, {"files", {"sh0.webp"}}};
  meta["shN"] = {{"mins", -1}, {"maxs", 1}, {"files", meta["shN"]["files"]}};
  const GaussianCloud cloud = test::import_sog(test::zip(with_meta(test::sog_files(8, 2), meta)));
  ASSERT_EQ(cloud.sh_degree, 2);
  const std::vector<uint8_t> scales = test::sog_pixels(8, 7), colours = test::sog_pixels(8, 200);
  EXPECT_NEAR(cloud.log_scale[1], -7 + scales[1] / 255.0 * 8, 1e-5);
  EXPECT_NEAR(cloud.sh[0], -2 + colours[0] / 255.0 * 4, 1e-5);
  EXPECT_NEAR(cloud.opacity[0], -4 + colours[3] / 255.0 * 10, 1e-5);
  const std::vector<uint8_t> pixels = test::sog_pixels(128 * 8, 5, 255);
  EXPECT_NEAR(cloud.sh[3], -1 + pixels[4 * (64 * 8 + 5 * 8)] / 255.0 * 2, 1e-5);
}

TEST(SogImport, TheTagOfACompensatedFilterIsHonoured) {
  Json meta = test::sog_meta(4, 0);
  EXPECT_FALSE(test::import_sog(test::zip(test::sog_files(4, 0))).native.antialiased());
  meta["antialias"] = true;
  EXPECT_TRUE(
      test::import_sog(test::zip(with_meta(test::sog_files(4, 0), meta))).native.antialiased());
}

TEST(SogImport, AZipAFolderAndBlocksAgree) {
  const SogFiles files = test::sog_files(40, 2);
  const Bytes zip = test::zip(files);
  const GaussianCloud whole = test::import_sog(zip);
  ASSERT_EQ(whole.size(), 40u);
  const test::TempFolder folder;
  test::write_files(folder.file(""), files);
  test::expect_same(whole, test::import_file(folder.file("meta.json")));
  const auto reader = open_blocks(std::make_shared<MemorySource>("sample.sog", zip));
  EXPECT_EQ(reader->count(), 40u);
  for (size_t i = 0; i < 40; i += 8) {
    const GaussianCloud part = reader->decode(reader->next(8));
    ASSERT_EQ(part.size(), 8u);
    EXPECT_EQ(part.position[0], whole.position[3 * i]);
    EXPECT_TRUE(
        std::equal(part.sh.begin(), part.sh.end(), whole.sh.begin() + 27 * static_cast<long>(i)));
  }
  EXPECT_EQ(reader->next(8).count, 0u);
}

TEST(SogImport, CannotBeReadFromAStream) {
  const std::string message =
      test::refusal_of([&] { test::import_piped(test::zip(test::sog_files(4, 0))); });
  EXPECT_NE(message.find("cannot be read from a stream"), std::string::npos) << message;
}

TEST(SogImport, RefusesImagesThatDoNotFit) {
  const SogFiles good = test::sog_files(8, 1);
  const auto with = [&](const std::string& name, Bytes bytes) {
    SogFiles files = good;
    files[name] = std::move(bytes);
    return files;
  };
  for (const auto& [name, bytes] : good) {
    if (name == "meta.json") continue;
    SogFiles files = good;
    files.erase(name);
    expect_refused(files, name);
    expect_refused(with(name, test::bytes_of("RIFF")), name);
    Bytes cut = bytes;
    cut.resize(cut.size() / 2);
    expect_refused(with(name, cut), name);
  }
  expect_refused(with("scales.webp", test::webp(test::sog_pixels(4, 7), 4)), "4 x 1 pixels");
  expect_refused(with("sh0.webp", test::webp(std::vector<uint8_t>(4 * 512 * 512), 512)),
                 "512 x 512 pixels");
  expect_refused(with("quats.webp", test::webp(test::sog_pixels(8, 1, 252), 4, false)), "lossy");
  expect_refused(with("shN_centroids.webp", test::webp(test::sog_pixels(128 * 8, 5), 64 * 8)),
                 "shN_centroids.webp");
  expect_refused(with("shN_centroids.webp", test::webp(test::sog_pixels(64 * 3, 5), 64 * 3)),
                 "shN_centroids.webp");
  expect_refused(with("shN_labels.webp", test::webp(test::sog_pixels(8, 100), 4)), "centroids");
}

// Images of one colour take thirty bytes, whatever their size.
TEST(SogImport, RefusesMoreGaussiansThanAFileOfItsLengthIsWorth) {
  for (const uint64_t count : {uint64_t{2'000'000}, uint64_t{1} << 28}) {
    Json meta = test::sog_meta(8, 0);
    meta["count"] = count;
    expect_refused(with_meta(test::sog_files(8, 0), meta), "count: found " + std::to_string(count));
  }
}

TEST(SogImport, RefusesFilesOutsideItsFolder) {
  for (const char* name : {"../means_l.webp", "/etc/passwd", "a/../../b.webp", "..", "", "a\\b"}) {
    Json meta = test::sog_meta(4, 0);
    meta["means"]["files"][0] = name;
    expect_refused(with_meta(test::sog_files(4, 0), meta), "means.files[0]");
  }
  const test::TempFolder folder;
  test::write_files(folder.file("inside"), test::sog_files(4, 0));
  std::filesystem::rename(folder.file("inside/sh0.webp"), folder.file("sh0.webp"));
  EXPECT_THROW(test::import_file(folder.file("inside/meta.json")), Error);
}

// Whatever a field becomes, a cloud or a refusal comes of it.
// An image that is larger than its pixels could need is not read.
TEST(SogImport, RefusesAnImageOfMoreBytesThanItsPixels) {
  const test::TempFolder folder;
  SogFiles files = test::sog_files(8, 0);
  files["scales.webp"].resize(2'000'000, std::byte{1});
  test::write_files(folder.file(""), files);
  const std::string message =
      test::refusal_of([&] { test::import_file(folder.file("meta.json")); });
  EXPECT_NE(message.find("scales.webp: found 2000000 bytes, expected at most "), std::string::npos)
      << message;
}

TEST(SogImport, EveryFieldMissingOrAbsurdIsRefusedOrRead) {
  const SogFiles files = test::sog_files(4, 1);
  const Json good = test::sog_meta(4, 1);
  const std::vector<Json> absurd = {
      nullptr, true, -1, 1e300, uint64_t{1} << 63, "x", "", Json::array(), Json::object()};
  const Json flat = good.flatten();
  for (const auto& [path, value] : flat.items()) {
    if (path.find("codebook/") != std::string::npos && !path.ends_with("codebook/7")) continue;
    for (Json::json_pointer at(path); !at.empty(); at = at.parent_pointer())
      for (const Json& other : absurd) {
        Json meta = good;
        meta[at] = other;
        test::refusal_of([&] { test::import_sog(test::zip(with_meta(files, meta))); });
      }
  }
  for (const auto& [key, value] : good.items()) {
    if (key == "version" || key == "shN") continue;
    Json meta = good;
    meta.erase(key);
    expect_refused(with_meta(files, meta), key);
  }
}

TEST(SogImport, RefusesMalformedJson) {
  SogFiles files = test::sog_files(4, 0);
  for (const std::string text : {"", "{", "[]", "nul", "\"\\ud800\"", "{\"version\": 1e999}",
                                 "{\"version\": 3}", "{\"version\": \"2\"}"}) {
    files["meta.json"] = test::bytes_of(text);
    expect_refused(files, "");
  }
  files["meta.json"] = test::bytes_of(std::string(100, '[') + std::string(100, ']'));
  expect_refused(files, "levels");
  files["meta.json"] = test::bytes_of(std::string(300 * 1024, ' '));
  expect_refused(files, "bytes");
}

TEST(SogImport, RefusesEveryTruncation) {
  const Bytes whole = test::zip(test::sog_files(4, 1));
  for (size_t size = 4; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_NE(test::refusal_of([&] { test::import_sog(cut); }), "") << size;
  }
}

TEST(SogImport, NoFlippedByteCrashes) {
  test::expect_flips_are_harmless(test::zip(test::sog_files(4, 0)), test::import_sog);
}

// Every image is held to the count before its pixels take memory: one of 16,000 x 16,000 pixels
// takes a gigabyte, which a file of some hundred bytes must not cost.
TEST(SogImport, AnImageOfAnotherSizeThanTheCountIsRefusedBeforeItIsDecoded) {
  const SogFiles good = test::sog_files(8, 1);
  Bytes large = good.at("sh0.webp");
  // Of a lossless WebP the width and height minus 1, in 14 bits each, follow the byte 0x2f.
  const uint32_t header = 15999 | 15999 << 14 | 1 << 28;
  ASSERT_EQ(large[20], std::byte{0x2f});
  std::memcpy(&large[21], &header, sizeof header);
  for (const auto& [name, bytes] : good) {
    if (name == "meta.json") continue;
    SogFiles files = good;
    files[name] = large;
    expect_refused(files, name + ": found 16000 x 16000 pixels");
    const test::TempFolder folder;
    test::write_files(folder.file(""), files);
    const std::string message =
        test::refusal_of([&] { test::import_file(folder.file("meta.json")); });
    EXPECT_NE(message.find(name + ": found 16000 x 16000 pixels"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace voyager::sog_import_test
