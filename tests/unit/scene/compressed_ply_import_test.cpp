// PlayCanvas's .compressed.ply, made by hand: what each code becomes, and what is refused.
#include "runtime/scene/import/block_reader.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::compressed_ply_import_test {
namespace {

using test::Bytes;

struct Layout {
  size_t vertices = 1;
  int sh_degree = 0;
  bool colours = true;
  std::string vertex_type = "uint", chunks = "", sh_rows = "", extra = "";
};

std::string properties(const std::string& type, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += "property " + type + " " + name + "\n";
  return text;
}

std::string header(const Layout& layout) {
  std::vector<std::string> bounds;
  for (const std::string axes : {"", "scale_"})
    for (const std::string side : {"min_", "max_"})
      for (const char* axis : {"x", "y", "z"}) bounds.push_back(side + axes + axis);
  for (const std::string side : {"min_", "max_"})
    for (const char* channel : {"r", "g", "b"})
      if (layout.colours) bounds.push_back(side + channel);
  const std::string vertices = std::to_string(layout.vertices);
  const std::string chunks = std::to_string((layout.vertices + 255) / 256);
  std::string text = "ply\nformat binary_little_endian 1.0\nelement chunk " +
                     (layout.chunks.empty() ? chunks : layout.chunks) + "\n" +
                     properties("float", bounds) + "element vertex " + vertices + "\n" +
                     properties(layout.vertex_type, {"packed_position", "packed_rotation",
                                                     "packed_scale", "packed_color"});
  std::vector<std::string> rest;
  for (int i = 0; i < 3 * (sh_coefficients(layout.sh_degree) - 1); ++i)
    rest.push_back("f_rest_" + std::to_string(i));
  if (!rest.empty())
    text += "element sh " + (layout.sh_rows.empty() ? vertices : layout.sh_rows) + "\n" +
            properties("uchar", rest);
  return text + layout.extra + "end_header\n";
}

// Rows whose codes run through all words, in chunks whose bounds differ.
Bytes file_of(const Layout& layout) {
  Bytes bytes = test::bytes_of(header(layout));
  for (size_t chunk = 0; chunk < (layout.vertices + 255) / 256; ++chunk)
    for (int i = 0; i < (layout.colours ? 18 : 12); ++i)
      test::put(bytes, static_cast<float>(chunk) + static_cast<float>(i / 3 % 2) * 2.0f - 1.0f);
  uint32_t word = 12345;
  for (size_t i = 0; i < 4 * layout.vertices; ++i)
    test::put(bytes, word = word * 1664525u + 1013904223u);
  const size_t rest = 3 * static_cast<size_t>(sh_coefficients(layout.sh_degree) - 1);
  for (size_t i = 0; i < rest * layout.vertices; ++i)
    test::put(bytes, static_cast<uint8_t>(i * 37 + 11));
  return bytes;
}

// One Gaussian between bounds of its own: position 0 to 4, scale -8 to -4, colour -1 to 3.
Bytes one_gaussian(uint32_t position, uint32_t rotation, uint32_t scale, uint32_t colour,
                   bool colours = true) {
  Bytes bytes = test::bytes_of(header({.colours = colours}));
  std::vector<float> bounds = {0.0f, 4.0f, -8.0f, -4.0f};
  if (colours) bounds.insert(bounds.end(), {-1.0f, 3.0f});
  for (const float bound : bounds)
    for (int axis = 0; axis < 3; ++axis) test::put(bytes, bound);
  for (const uint32_t word : {position, rotation, scale, colour}) test::put(bytes, word);
  return bytes;
}

TEST(CompressedPlyImport, DecodesPositionsScalesAndColoursBetweenTheBoundsOfTheChunk) {
  const GaussianCloud cloud = test::import_bytes(
      one_gaussian(2047u << 21 | 0u << 11 | 1024u, 0, 0u << 21 | 1023u << 11 | 2047u,
                   255u << 24 | 0u << 16 | 51u << 8 | 204u));
  ASSERT_EQ(cloud.size(), 1u);
  EXPECT_EQ(cloud.position[0], 4.0f);
  EXPECT_EQ(cloud.position[1], 0.0f);
  EXPECT_NEAR(cloud.position[2], 4.0 * 1024 / 2047, 1e-6);
  EXPECT_EQ(cloud.log_scale[0], -8.0f);
  EXPECT_EQ(cloud.log_scale[1], -4.0f);
  EXPECT_EQ(cloud.log_scale[2], -4.0f);
  EXPECT_NEAR(cloud.sh[0], 2.5 / kSh0, 1e-5);
  EXPECT_NEAR(cloud.sh[1], -1.5 / kSh0, 1e-5);
  EXPECT_NEAR(cloud.sh[2], (0.2 * 4 - 1.5) / kSh0, 1e-5);
  EXPECT_NEAR(cloud.opacity[0], std::log(0.8 / 0.2), 1e-5);
}

TEST(CompressedPlyImport, ColoursWithoutBoundsRunFromZeroToOne) {
  const GaussianCloud cloud = test::import_bytes(one_gaussian(0, 0, 0, 0xff330000u, false));
  EXPECT_NEAR(cloud.sh[0], 0.5 / kSh0, 1e-6);
  EXPECT_NEAR(cloud.sh[1], -0.3 / kSh0, 1e-6);
  EXPECT_NEAR(cloud.sh[2], -0.5 / kSh0, 1e-6);
  EXPECT_EQ(cloud.opacity[0], -kMaxLogit);
  EXPECT_EQ(cloud.report.repaired(), 0u);
}

// The two top bits name the component that is left out; the others follow in the order w, x, y, z.
TEST(CompressedPlyImport, RotationsAreUnitAndTheLargestComponentIsWhereTheBitsSay) {
  for (uint32_t largest = 0; largest < 4; ++largest) {
    const uint32_t word = largest << 30 | 1023u << 20 | 512u << 10 | 400u;
    const GaussianCloud cloud = test::import_bytes(one_gaussian(0, word, 0, 0));
    const double codes[3] = {std::sqrt(0.5), (512 / 1023.0 - 0.5) * std::sqrt(2.0),
                             (400 / 1023.0 - 0.5) * std::sqrt(2.0)};
    double squared = 0;
    for (size_t i = 0, k = 0; i < 4; ++i) {
      const double found = static_cast<double>(cloud.rotation[i]);
      squared += found * found;
      if (i == largest)
        EXPECT_GT(found, 0.6) << largest;
      else
        EXPECT_NEAR(found, codes[k++], 1e-6) << largest << i;
    }
    EXPECT_NEAR(squared, 1.0, 1e-6);
  }
}

TEST(CompressedPlyImport, ShBandsAreChannelMajorWithTheirEndsExact) {
  Bytes bytes = file_of({.sh_degree = 1});
  const uint8_t codes[9] = {0, 255, 127, 128, 64, 192, 1, 254, 100};
  std::memcpy(bytes.data() + bytes.size() - 9, codes, 9);
  const GaussianCloud cloud = test::import_bytes(bytes);
  ASSERT_EQ(cloud.sh_degree, 1);
  for (size_t i = 0; i < 9; ++i) {
    const double share = codes[i] == 0 ? 0 : codes[i] == 255 ? 1 : (codes[i] + 0.5) / 256;
    EXPECT_NEAR(cloud.sh[3 * (1 + i % 3) + i / 3], (share - 0.5) * 8, 1e-6) << i;
  }
}

// A pipe has the SH bands after all vertices; a file is read at both places at once.
TEST(CompressedPlyImport, AFileAPipeAndBlocksAgreeAcrossChunks) {
  for (int degree = 0; degree <= 3; ++degree) {
    const Bytes bytes = file_of({.vertices = 600, .sh_degree = degree});
    const GaussianCloud whole = test::import_bytes(bytes);
    ASSERT_EQ(whole.size(), 600u);
    ASSERT_EQ(whole.sh_degree, degree);
    test::expect_same(whole, test::import_piped(bytes));
    for (const size_t most : {1u, 100u, 1000u}) {
      const auto reader = open_blocks(std::make_shared<MemorySource>("sample.bin", bytes));
      GaussianCloud blocks;
      blocks.sh_degree = reader->sh_degree();
      for (RawBlock block = reader->next(most); block.count > 0; block = reader->next(most)) {
        const GaussianCloud part = reader->decode(block);
        const auto add = [](auto& to, const auto& from) {
          to.insert(to.end(), from.begin(), from.end());
        };
        add(blocks.position, part.position), add(blocks.log_scale, part.log_scale);
        add(blocks.rotation, part.rotation), add(blocks.opacity, part.opacity);
        add(blocks.sh, part.sh);
      }
      test::expect_same(whole, blocks);
    }
  }
}

TEST(CompressedPlyImport, RefusesElementsThatDoNotFitTogether) {
  const std::vector<std::pair<Layout, std::string>> bad = {
      {{.chunks = "2"}, "element chunk"},
      {{.vertices = 257, .chunks = "1"}, "element chunk"},
      {{.chunks = "18446744073709551615"}, "element chunk"},
      {{.sh_degree = 1, .sh_rows = "2"}, "element sh"},
      {{.vertex_type = "int"}, "another type of packed_position"},
      {{.extra = "element face 0\n"}, "elements"},
      {{.sh_degree = 1, .extra = "property list uchar int l\n"}, "with a list"},
      {{.sh_degree = 1, .extra = "property uchar f_rest_9\n"}, "10 properties"},
      {{.extra = "element sh 1\nproperty uchar f_rest_0\n"}, "1 properties"},
  };
  for (const auto& [layout, field] : bad) test::expect_refused(file_of(layout), field, field);
  for (const std::string name : {"min_x", "max_scale_z", "min_g", "packed_scale"}) {
    std::string text = header({});
    text.replace(text.find(name), name.size(), "other");
    test::expect_refused(test::bytes_of(text), "no property " + name, name);
  }
}

TEST(CompressedPlyImport, RefusesEveryTruncationAndTrailingBytes) {
  for (const int degree : {0, 1}) {
    const Bytes whole = file_of({.vertices = 3, .sh_degree = degree});
    EXPECT_EQ(test::import_bytes(whole).size(), 3u);
    test::expect_refused_in_part(whole);
  }
}

TEST(CompressedPlyImport, NoFlippedByteCrashes) {
  const Bytes whole = file_of({.vertices = 2, .sh_degree = 1});
  test::expect_flips_are_harmless(whole,
                                  [](const Bytes& bytes) { return test::import_bytes(bytes); });
}

}  // namespace
}  // namespace voyager::compressed_ply_import_test
