#include "runtime/scene/import/block_reader.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::ply_import_test {
namespace {

using test::Bytes;

const std::vector<std::string> kRequired = {"x",      "y",       "z",       "f_dc_0",  "f_dc_1",
                                            "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
                                            "rot_0",  "rot_1",   "rot_2",   "rot_3"};

std::string header(const std::string& elements,
                   const std::string& format = "binary_little_endian") {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

std::string vertex(const std::string& count, const std::vector<std::string>& names = kRequired) {
  std::string text = "element vertex " + count + "\n";
  for (const std::string& name : names) text += "property float " + name + "\n";
  return text;
}

// One row of kRequired: 1, 2, 3 ... 14.
Bytes with_row(const std::string& text) {
  Bytes bytes = test::bytes_of(text);
  for (int i = 1; i <= 14; ++i) test::put(bytes, static_cast<float>(i));
  return bytes;
}

void expect_row(const GaussianCloud& cloud) {
  ASSERT_EQ(cloud.size(), 1u);
  for (size_t k = 0; k < 3; ++k) EXPECT_EQ(cloud.position[k], 1.0f + static_cast<float>(k));
  for (size_t k = 0; k < 3; ++k) EXPECT_EQ(cloud.sh[k], 4.0f + static_cast<float>(k));
  EXPECT_EQ(cloud.opacity[0], 7.0f);
  for (size_t k = 0; k < 3; ++k) EXPECT_EQ(cloud.log_scale[k], 8.0f + static_cast<float>(k));
  for (size_t k = 0; k < 4; ++k) EXPECT_EQ(cloud.rotation[k], 11.0f + static_cast<float>(k));
}

TEST(PlyImport, ReadsPropertiesByNameInAnyOrder) {
  const std::vector<std::string> backwards(kRequired.rbegin(), kRequired.rend());
  Bytes bytes = test::bytes_of(header(vertex("1", backwards)));
  for (int i = 14; i >= 1; --i) test::put(bytes, static_cast<float>(i));
  expect_row(test::import_bytes(bytes));
}

TEST(PlyImport, ToleratesCommentsAndCarriageReturns) {
  std::string text = header("comment made by hand\nobj_info anything at all\n" + vertex("1"));
  expect_row(test::import_bytes(with_row(text)));
  std::string crlf;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_row(test::import_bytes(with_row(crlf)));
}

TEST(PlyImport, ReadsEveryScalarTypeUnderBothNames) {
  const std::vector<std::pair<std::string, std::string>> types = {
      {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
      {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
  for (const bool sized : {false, true}) {
    std::string text = "element vertex 1\n";
    for (size_t i = 0; i < 14; ++i) {
      const auto& [plain, with_size] = types[i % 8];
      text += "property " + (sized ? with_size : plain) + " " + kRequired[i] + "\n";
    }
    Bytes bytes = test::bytes_of(header(text));
    for (size_t i = 0; i < 14; ++i) {
      const int v = static_cast<int>(i) + 1;
      switch (i % 8) {
        case 0:
          test::put(bytes, static_cast<int8_t>(v));
          break;
        case 1:
          test::put(bytes, static_cast<uint8_t>(v));
          break;
        case 2:
          test::put(bytes, static_cast<int16_t>(v));
          break;
        case 3:
          test::put(bytes, static_cast<uint16_t>(v));
          break;
        case 4:
          test::put(bytes, static_cast<int32_t>(v));
          break;
        case 5:
          test::put(bytes, static_cast<uint32_t>(v));
          break;
        case 6:
          test::put(bytes, static_cast<float>(v));
          break;
        default:
          test::put(bytes, static_cast<double>(v));
      }
    }
    expect_row(test::import_bytes(bytes));
  }
}

TEST(PlyImport, ReadsBigEndian) {
  Bytes bytes = test::bytes_of(header(vertex("1"), "binary_big_endian"));
  for (int i = 1; i <= 14; ++i) {
    Bytes word;
    test::put(word, static_cast<float>(i));
    bytes.insert(bytes.end(), word.rbegin(), word.rend());
  }
  expect_row(test::import_bytes(bytes));
}

TEST(PlyImport, SkipsOtherElementsAndProperties) {
  std::vector<std::string> names = kRequired;
  names.insert(names.begin() + 3, {"nx", "ny", "nz", "label"});
  Bytes bytes =
      test::bytes_of(header("element camera 2\nproperty uchar id\nproperty double focal\n" +
                            vertex("1", names) + "element after 1\nproperty short s\n"));
  bytes.resize(bytes.size() + 18);
  for (int i = 1; i <= 3; ++i) test::put(bytes, static_cast<float>(i));
  for (int i = 0; i < 4; ++i) test::put(bytes, 99.0f);
  for (int i = 4; i <= 14; ++i) test::put(bytes, static_cast<float>(i));
  test::put(bytes, int16_t{5});
  expect_row(test::import_bytes(bytes));
  expect_row(test::import_piped(bytes));
}

TEST(PlyImport, ListsAreHarmlessAfterTheVerticesOnly) {
  const std::string list = "element face 1\nproperty list uchar int vertex_indices\n";
  Bytes after = with_row(header(vertex("1") + list));
  after.resize(after.size() + 13);
  expect_row(test::import_bytes(after));
  test::expect_refused(with_row(header(list + vertex("1"))), "no list", "before vertex");
  test::expect_refused(with_row(header(vertex("1") + "property list uchar int v\n")), "no list",
                       "in vertex");
}

TEST(PlyImport, DoublePositionsChooseAnOrigin) {
  const std::vector<std::array<double, 3>> world = {{4510023.123456, -12.5, -16384.75},
                                                    {4510031.000001, 7.25, -16000.0},
                                                    {4509001.5, 15999.0, 0.0}};
  std::string text = "element vertex 3\n";
  for (size_t i = 0; i < 14; ++i)
    text += std::string("property ") + (i < 3 ? "double " : "float ") + kRequired[i] + "\n";
  Bytes bytes = test::bytes_of(header(text));
  for (const auto& p : world) {
    for (const double v : p) test::put(bytes, v);
    for (int i = 0; i < 11; ++i) test::put(bytes, 1.0f);
  }
  const GaussianCloud cloud = test::import_bytes(bytes);
  EXPECT_EQ(cloud.origin, (std::array<double, 3>{4404.0 * 1024, 0.0, -16.0 * 1024}));
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k)
      EXPECT_EQ(cloud.position[3 * i + k], static_cast<float>(world[i][k] - cloud.origin[k]));
}

// Blocks of one row each, of which the first cannot say where the scene lies.
TEST(PlyImport, TheOriginDoesNotDependOnTheSizeOfBlocks) {
  GaussianCloud cloud = test::random_cloud(3, 8, 0);
  cloud.origin = {6.4e6, 0, -2e6};
  cloud.position[0] = NAN;
  const Bytes bytes = test::ply_of(cloud, true);
  const MemorySource source("sample.bin", bytes);
  const GaussianCloud whole = import_ply(*read_source(source), {});
  const auto reader = open_blocks(std::make_shared<MemorySource>("sample.bin", bytes));
  for (size_t i = 0; i < cloud.size(); ++i) {
    const GaussianCloud one = reader->decode(reader->next(1));
    EXPECT_EQ(one.origin, whole.origin);
    EXPECT_EQ(one.position[1], whole.position[3 * i + 1]);
  }
  EXPECT_NE(whole.origin[0], 0);
}

TEST(PlyImport, FloatPositionsAreKeptToTheBitHoweverFar) {
  GaussianCloud cloud = test::random_cloud(2, 5, 0);
  cloud.position[0] = 4510023.5f;
  const GaussianCloud read = test::import_bytes(test::ply_of(cloud));
  EXPECT_EQ(read.origin, (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(read.position, cloud.position);
}

TEST(PlyImport, NamesEachMissingProperty) {
  for (const std::string& missing : kRequired) {
    std::vector<std::string> names = kRequired;
    names.erase(std::find(names.begin(), names.end(), missing));
    test::expect_refused(with_row(header(vertex("1", names))),
                         missing == "scale_2" ? "2DGS" : "no property " + missing, missing);
  }
}

// 2DGS's ellipses have two scales.
TEST(PlyImport, Refuses2dgsByName) {
  std::vector<std::string> names = kRequired;
  names.erase(std::find(names.begin(), names.end(), "scale_2"));
  test::expect_refused(with_row(header(vertex("1", names))), "2DGS, which is not supported",
                       "2DGS");
}

TEST(PlyImport, RefusesOtherCountsOfShCoefficients) {
  for (const int count : {1, 8, 10, 44, 46, 72}) {
    std::vector<std::string> names = kRequired;
    for (int i = 0; i < count; ++i) names.push_back("f_rest_" + std::to_string(i));
    test::expect_refused(with_row(header(vertex("1", names))), "found " + std::to_string(count),
                         "f_rest");
  }
  std::vector<std::string> gap = kRequired;
  for (int i = 1; i <= 9; ++i) gap.push_back("f_rest_" + std::to_string(i));
  test::expect_refused(with_row(header(vertex("1", gap))), "no property f_rest_0", "gap");
}

TEST(PlyImport, RefusesMalformedHeaders) {
  const std::string good = vertex("1");
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"ply\n" + good + "end_header\n", "format"},
      {header(good, "ascii"), "binary_little_endian"},
      {header(good, "binary_middle_endian"), "binary_little_endian"},
      {"ply\nformat binary_little_endian 2.0\n" + good + "end_header\n", "version 1.0"},
      {"ply\nformat binary_little_endian 1.0\nformat binary_little_endian 1.0\n" + good +
           "end_header\n",
       "one format"},
      {"ply\rformat\n", "first line"},
      {header(""), "an element named vertex"},
      {header("element face 0\n"), "an element named vertex"},
      {header("property float x\n" + good), "an element line before it"},
      {header("elements vertex 1\n"), "header line"},
      {header("\n" + good), "header line"},
      {header(vertex("99999999999999999999")), "99999999999999999999"},
      {header(vertex("18446744073709551615")), "18446744073709551615"},
      {header(vertex("-1")), "count"},
      {header(vertex("1x")), "count"},
      {header(vertex("")), "count"},
      {header(good + good), "each name once"},
      {header(good + "property float x\n"), "each name once"},
      {header(good + "property quad q\n"), "scalar type"},
      {header(good + "property float\n"), "scalar type"},
      {header("element a 9223372036854775807\nproperty char c\nelement b "
              "9223372036854775807\nproperty char c\n"
              "element c 9\nproperty char c\n" +
              good),
       ""},
      {header("comment " + std::string(5000, 'x') + "\n" + good), "4096"},
      {"ply\nformat binary_little_endian 1.0\n", "newline"},
  };
  for (const auto& [text, field] : bad)
    test::expect_refused(with_row(text), field, text.substr(0, 200));
  std::string endless = "ply\nformat binary_little_endian 1.0\n";
  while (endless.size() < 300 * 1024) endless += "comment " + std::string(1000, 'x') + "\n";
  test::expect_refused(with_row(endless + good + "end_header\n"), "256 KiB", "endless header");
}

TEST(PlyImport, RefusesEveryTruncationAndTrailingBytes) {
  const Bytes whole = test::ply_of(test::random_cloud(3, 11, 1));
  test::expect_refused_in_part(whole);
}

TEST(PlyImport, NoFlippedByteCrashes) {
  const Bytes whole = test::ply_of(test::random_cloud(2, 11, 1));
  for (size_t at = 0; at < whole.size(); ++at)
    for (const int flip : {1, 0x20, 0x80, 0xff}) {
      Bytes bytes = whole;
      bytes[at] ^= static_cast<std::byte>(flip);
      try {
        EXPECT_LE(test::import_bytes(bytes).size(), 2u);
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::refused_input) << error.what();
      }
    }
}

}  // namespace
}  // namespace voyager::ply_import_test
