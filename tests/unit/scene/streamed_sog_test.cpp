// The lod-meta.json of a streamed SOG scene: its finest level alone.
#include "runtime/scene/import/block_reader.h"
#include "tests/support/sog_files.h"
#include "tests/support/test_support.h"

namespace voyager::streamed_sog_test {
namespace {

using test::SogFiles;
using Json = nlohmann::json;

Json part(int file, int offset, int count) {
  return {{"file", file}, {"offset", offset}, {"count", count}};
}

// Two leaves in fine_0 (the second first), one in fine_1 which lacks level 0, and a coarse file.
Json good_meta() {
  const Json first = {{"lods", {{"0", part(0, 5, 3)}, {"1", part(2, 0, 1)}}}};
  const Json second = {{"lods", {{"0", part(0, 0, 2)}, {"1", part(2, 1, 1)}}}};
  const Json third = {{"lods", {{"2", part(2, 2, 1)}, {"1", part(1, 4, 4)}}}};
  return {{"lodLevels", 3},
          {"filenames", {"fine_0/meta.json", "fine_1/meta.json", "coarse/meta.json"}},
          {"tree", {{"children", {first, {{"children", {second, third}}}}}}}};
}

class Folder {
 public:
  Folder() {
    add("fine_0", test::sog_files(8, 1));
    add("fine_1", test::sog_files(12, 2));
    add("coarse", test::sog_files(4, 0));
  }
  void add(const std::string& name, const SogFiles& files) {
    test::write_files(folder_.file(name), files);
  }
  std::string write(const Json& meta) const {
    test::write_files(folder_.file(""), {{"lod-meta.json", test::bytes_of(meta.dump())}});
    return folder_.file("lod-meta.json");
  }
  GaussianCloud import(const Json& meta) const { return test::import_file(write(meta)); }
  std::string refusal(const Json& meta) const {
    return test::refusal_of([&] { import(meta); });
  }

 private:
  test::TempFolder folder_;
};

void expect_rows(const GaussianCloud& all, size_t at, const GaussianCloud& of, size_t first,
                 size_t count) {
  for (size_t i = 0; i < count; ++i) {
    EXPECT_EQ(all.position[3 * (at + i)], of.position[3 * (first + i)]) << at + i;
    EXPECT_EQ(all.opacity[at + i], of.opacity[first + i]) << at + i;
    const auto to = static_cast<size_t>(all.coefficients()) * 3;
    const auto from = static_cast<size_t>(of.coefficients()) * 3;
    for (size_t k = 0; k < to; ++k)
      EXPECT_EQ(all.sh[to * (at + i) + k], k < from ? of.sh[from * (first + i) + k] : 0.0f);
  }
}

TEST(StreamedSog, IsTheFinestLevelOfEachLeafInTheOrderOfTheFiles) {
  const Folder folder;
  const GaussianCloud all = folder.import(good_meta());
  ASSERT_EQ(all.size(), 9u);
  ASSERT_EQ(all.sh_degree, 2);
  const GaussianCloud fine_0 = test::import_sog(test::zip(test::sog_files(8, 1)));
  const GaussianCloud fine_1 = test::import_sog(test::zip(test::sog_files(12, 2)));
  expect_rows(all, 0, fine_0, 0, 2);
  expect_rows(all, 2, fine_0, 5, 3);
  expect_rows(all, 5, fine_1, 4, 4);
}

TEST(StreamedSog, BlocksAgreeWithTheWhole) {
  const Folder folder;
  const GaussianCloud all = folder.import(good_meta());
  const auto reader = open_blocks(open_file_source(folder.write(good_meta())));
  EXPECT_EQ(reader->count(), 9u);
  size_t at = 0;
  for (RawBlock block = reader->next(2); block.count > 0; block = reader->next(2)) {
    expect_rows(all, at, reader->decode(block), 0, block.count);
    at += block.count;
  }
  EXPECT_EQ(at, 9u);
}

TEST(StreamedSog, TheEnvironmentBelongsToIt) {
  Folder folder;
  folder.add("sky", test::sog_files(4, 0));
  Json meta = good_meta();
  meta["environment"] = "sky/meta.json";
  const GaussianCloud all = folder.import(meta);
  ASSERT_EQ(all.size(), 13u);
  expect_rows(all, 9, test::import_sog(test::zip(test::sog_files(4, 0))), 0, 4);
}

TEST(StreamedSog, RefusesWhatDoesNotFitTogether) {
  const Folder folder;
  const auto expect = [&](const char* pointer, const Json& value, const std::string& part) {
    Json meta = good_meta();
    meta[Json::json_pointer(pointer)] = value;
    const std::string message = folder.refusal(meta);
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  };
  expect("/tree/children/0/lods/0/count", 4, "fine_0/meta.json");  // beyond its end
  expect("/tree/children/0/lods/0/offset", 1, "twice");            // of the second leaf
  expect("/tree/children/0/lods/0/file", 3, "file");
  expect("/tree/children/0/lods/0/count", uint64_t{1} << 62, "count");
  expect("/tree/children/0/lods", Json{{"fine", 1}}, "numbers");
  expect("/tree/children", 5, "array");
  expect("/filenames", Json::array(), "at least one file");
  expect("/filenames/1", "./fine_0/../fine_0/meta.json", "each file once");
  expect("/filenames/0", "../fine_0/meta.json", "in the same folder or below");
  expect("/filenames/0", "/etc/passwd", "in the same folder or below");
}

std::string refusal_of_files(const SogFiles& files) {
  const test::TempFolder folder;
  test::write_files(folder.file(""), files);
  return test::refusal_of([&] { test::import_file(folder.file("lod-meta.json")); });
}

// Each of them alone is worth its Gaussians.
TEST(StreamedSog, RefusesMoreGaussiansThanAllFilesTogetherAreWorth) {
  const std::string message = refusal_of_files(test::one_colour_streamed_sog(4, 120'000, 120'000));
  EXPECT_NE(message.find("Gaussians of the files: found 480000, expected at most 3"),
            std::string::npos)
      << message;
}

TEST(StreamedSog, RefusesMorePixelsThanAllFilesTogetherAreWorth) {
  const std::string message = refusal_of_files(test::one_colour_streamed_sog(60, 1000, 65'000));
  EXPECT_NE(message.find("pixels of this and earlier images"), std::string::npos) << message;
}

TEST(StreamedSog, AnEnvironmentThatIsAFileOfTheTreeIsRefused) {
  const Folder folder;
  Json meta = good_meta();
  meta["environment"] = "./fine_1/meta.json";
  const std::string message = folder.refusal(meta);
  EXPECT_NE(message.find("environment: found \"./fine_1/meta.json\""), std::string::npos)
      << message;
}

TEST(StreamedSog, EveryFieldMissingOrAbsurdIsRefusedOrRead) {
  const Folder folder;
  const Json good = good_meta();
  const Json flat = good.flatten();
  for (const auto& [path, value] : flat.items())
    for (const Json& other : {Json(nullptr), Json(-1), Json(1e300), Json("x"), Json::object()}) {
      Json meta = good;
      meta[Json::json_pointer(path)] = other;
      try {
        EXPECT_LE(folder.import(meta).size(), 24u);
      } catch (const Error& error) {
        EXPECT_TRUE(error.code() == ErrorCode::refused_input ||
                    error.code() == ErrorCode::file_not_found)
            << error.what();
      }
    }
}

TEST(StreamedSog, RefusesATreeThatIsTooDeepAndHostBytes) {
  const Folder folder;
  Json meta = good_meta();
  for (int i = 0; i < 100; ++i) meta["tree"] = {{"children", {meta["tree"]}}};
  EXPECT_NE(folder.refusal(meta).find("levels"), std::string::npos);
  const test::Bytes bytes = test::bytes_of(good_meta().dump());
  const std::string message = test::refusal_of(
      [&] { import_gaussians(std::make_shared<MemorySource>("lod-meta.json", bytes)); });
  EXPECT_NE(message.find("only a local file has a folder"), std::string::npos) << message;
}

}  // namespace
}  // namespace voyager::streamed_sog_test
