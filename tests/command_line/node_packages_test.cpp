// Files that others' JavaScript packages read and write, where npm has installed them: spz-js,
// @sparkjsdev/spark and gltf-validator.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "tests/command_line/program.h"
#include "tests/support/needs.h"
#include "tests/support/rad_files.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::node_packages_test {
namespace {

using namespace voyager::test;

// npm's global folder is beside node.
Outcome node(const std::string& arguments) {
  return run_shell(
      "NODE_PATH=\"${NODE_PATH:-$(dirname \"$(command -v node)\")/../lib/node_modules}\" node " +
      arguments);
}

// One of other_tools/.
Outcome script(const std::string& name_and_arguments) {
  return node(VOYAGER_SOURCE_DIR "/tests/command_line/other_tools/" + name_and_arguments);
}

bool has_package(const std::string& name) {
  return node("-e \"require.resolve('" + name + "')\"").exit_code == 0;
}

#define VOYAGER_NEEDS_PACKAGE(name)                                                                \
  if (!has_package(name))                                                                          \
  VOYAGER_SKIP_WITHOUT(NODE_PACKAGES, std::string(name) + " is not here: npm install -g " + name + \
                                          ", or set NODE_PATH to the node_modules that has it")

struct Differences {
  float position = 0, log_scale = 0, opacity = 0, colour = 0, sh = 0;
  double rotation = 0;  // 1 - abs(dot), of Gaussians as ellipsoids
};

// Half turns about its own axes leave an ellipsoid as it is: the nearest of the four rotations.
double largest_dot(const float* a, const float* b) {
  const double lengths = std::sqrt(
      (double{a[0]} * a[0] + double{a[1]} * a[1] + double{a[2]} * a[2] + double{a[3]} * a[3]) *
      (double{b[0]} * b[0] + double{b[1]} * b[1] + double{b[2]} * b[2] + double{b[3]} * b[3]));
  const float turned[4][4] = {{b[0], b[1], b[2], b[3]},
                              {-b[1], b[0], b[3], -b[2]},
                              {-b[2], -b[3], b[0], b[1]},
                              {-b[3], b[2], -b[1], b[0]}};
  double largest = 0;
  for (const auto& q : turned)
    largest = std::max(largest, std::fabs(double{a[0]} * q[0] + double{a[1]} * q[1] +
                                          double{a[2]} * q[2] + double{a[3]} * q[3]));
  return largest / lengths;
}

// SH of the constant band apart from the others.
Differences differences(const GaussianCloud& a, const GaussianCloud& b) {
  Differences d;
  EXPECT_EQ(a.size(), b.size());
  EXPECT_EQ(a.sh_degree, b.sh_degree);
  if (a.size() != b.size() || a.sh_degree != b.sh_degree) return {INFINITY, 0, 0, 0, 0, 0};
  const auto raise = [](float& most, float x, float y) { most = std::max(most, std::fabs(x - y)); };
  const size_t width = static_cast<size_t>(a.coefficients()) * 3;
  for (size_t i = 0; i < 3 * a.size(); ++i) {
    raise(d.position, a.position[i], b.position[i]);
    raise(d.log_scale, a.log_scale[i], b.log_scale[i]);
  }
  for (size_t i = 0; i < a.sh.size(); ++i) raise(i % width < 3 ? d.colour : d.sh, a.sh[i], b.sh[i]);
  for (size_t i = 0; i < a.size(); ++i) {
    raise(d.opacity, sigmoid(a.opacity[i]), sigmoid(b.opacity[i]));
    d.rotation = std::max(d.rotation, 1 - largest_dot(&a.rotation[4 * i], &b.rotation[4 * i]));
  }
  return d;
}

// Of each SH coefficient and channel apart: how far `b` is from `a`, as a share of a's own size. A
// coefficient that changed its sign or its place is 1 or more.
std::vector<double> shares_of_sh(const GaussianCloud& a, const GaussianCloud& b) {
  const size_t width = static_cast<size_t>(a.coefficients()) * 3;
  std::vector<double> off(width), size(width);
  for (size_t i = 0; i < a.sh.size(); ++i) {
    off[i % width] += std::fabs(double{a.sh[i]} - double{b.sh[i]});
    size[i % width] += std::fabs(double{a.sh[i]});
  }
  for (size_t k = 0; k < width; ++k) off[k] /= size[k];
  return off;
}

class NodePackages : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.file(name); }

  void make_city() {
    ASSERT_EQ(
        failure_of({"voyager synth city --gaussians 10000 --sh-degree 3 -o " + file("c.ply")}), "");
  }
  void convert(const std::string& from, const std::string& to, const std::string& options = "") {
    ASSERT_EQ(failure_of({"voyager convert " + file(from) + " -o " + file(to) + options}), "");
  }
  void by_node(const std::string& name, const std::string& from, const std::string& to) {
    const Outcome done = script(name + " " + file(from) + " " + file(to));
    ASSERT_EQ(done.exit_code, 0) << done.output;
  }
  void expect_spark_reads(const std::string& from, const std::string& options = "") {
    ASSERT_NO_FATAL_FAILURE(convert("c.ply", from, options));
    expect_as_spark(from);
  }
  // A .spz that Spark wrote of `from`, against ours: one code off at most, and as far as Spark
  // rounds. Spark turns no axes, as if a .ply had those of a .spz.
  void expect_as_spark(const std::string& from) {
    ASSERT_NO_FATAL_FAILURE(by_node("spark.mjs", from, "theirs.spz"));
    ASSERT_NO_FATAL_FAILURE(convert(from, "ours.spz", from.ends_with(".spz") ? "" : " --up y"));
    const Differences d =
        differences(import_file(file("ours.spz")), import_file(file("theirs.spz")));
    EXPECT_LE(d.position, 1.001f / 4096) << from;
    EXPECT_LE(d.log_scale, 1.001f / 16) << from;
    EXPECT_LE(d.opacity, 1.001f / 255) << from;
    EXPECT_LE(d.colour, 1.001f / 255 / 0.15f) << from;
    EXPECT_LE(d.rotation, 0.006) << from;   // 8 bits a component, of which one follows
    EXPECT_LE(d.sh, 9.001f / 128) << from;  // steps of 16 codes
  }

  // Coefficients of all signs and sizes that formats hold.
  void make_vivid() {
    GaussianCloud cloud = random_cloud(500, 8, 3);
    cloud.native = {};
    for (float& coefficient : cloud.sh) coefficient = std::clamp(3 * coefficient, -0.9f, 0.9f);
    write("v.ply", ply_of(cloud));
  }
  void write(const std::string& name, const Bytes& bytes) const {
    std::ofstream(file(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  void expect_each_coefficient(const std::string& a, const std::string& b, double most) {
    const GaussianCloud one = import_file(file(a)), other = import_file(file(b));
    ASSERT_EQ(one.size(), other.size());
    ASSERT_EQ(one.sh_degree, 3);
    ASSERT_EQ(other.sh_degree, 3);
    const std::vector<double> shares = shares_of_sh(one, other);
    for (size_t k = 0; k < shares.size(); ++k) EXPECT_LE(shares[k], most) << a << " " << k;
  }
  // The validator knows glTF, and not the extension: neither its names of attributes nor itself,
  // nor what the compressed form uses. CesiumJS wants a matrix, though it be the identity.
  void expect_sound(const std::string& name, int attributes, bool spz) {
    const Outcome found = script("gltf_validator.mjs " + file(name));
    ASSERT_EQ(found.exit_code, 0) << found.output;
    int unknown = 0;
    std::istringstream lines(found.output);
    for (std::string line; std::getline(lines, line);) {
      const bool attribute = line.starts_with("MESH_PRIMITIVE_INVALID_ATTRIBUTE ") &&
                             line.find("/attributes/KHR_gaussian_splatting:") != std::string::npos;
      unknown += attribute;
      EXPECT_TRUE(attribute || (spz && (line == "UNUSED_OBJECT /bufferViews/0" ||
                                        line == "NODE_MATRIX_DEFAULT /nodes/0/matrix")))
          << name << ": " << line;
    }
    EXPECT_EQ(unknown, attributes) << name;
  }

 private:
  TempFolder folder_;
};

// Its own .ply of its own .spz (version 2), whose axes it does not turn.
TEST_F(NodePackages, AnSpzOfSpzJsIsReadAsSpzJsReadsIt) {
  VOYAGER_NEEDS_PACKAGE("spz-js");
  make_city();
  ASSERT_NO_FATAL_FAILURE(by_node("spz_js.mjs", "c.ply", "theirs.spz"));
  ASSERT_NO_FATAL_FAILURE(by_node("spz_js.mjs", "theirs.spz", "read.ply"));
  ASSERT_NO_FATAL_FAILURE(convert("read.ply", "turned.ply", " --up y"));
  const Differences d =
      differences(import_file(file("turned.ply")), import_file(file("theirs.spz")));
  EXPECT_EQ(d.position, 0);
  EXPECT_EQ(d.log_scale, 0);
  EXPECT_LE(d.opacity, 1e-6f);
  EXPECT_LE(d.colour, 1e-6f);
  EXPECT_LE(d.rotation, 1e-6);
  EXPECT_LE(d.sh, 1e-5f);
}

// It takes SH codes from 0 to 255 for -4 to 4; the format's author has half a step at the ends.
TEST_F(NodePackages, ACompressedPlyIsReadAsSpzJsReadsIt) {
  VOYAGER_NEEDS_PACKAGE("spz-js");
  make_city();
  convert("c.ply", "ours.compressed.ply");
  ASSERT_NO_FATAL_FAILURE(by_node("spz_js.mjs", "c.ply", "theirs.compressed.ply"));
  for (const char* written : {"ours.compressed.ply", "theirs.compressed.ply"}) {
    ASSERT_NO_FATAL_FAILURE(by_node("spz_js.mjs", written, "read.ply"));
    const Differences d = differences(import_file(file("read.ply")), import_file(file(written)));
    EXPECT_LE(d.position, 1e-4f) << written;
    EXPECT_LE(d.log_scale, 1e-5f) << written;
    EXPECT_LE(d.opacity, 1e-6f) << written;
    EXPECT_LE(d.colour, 1e-5f) << written;
    EXPECT_LE(d.rotation, 1e-6) << written;
    EXPECT_LE(d.sh, 8 * 0.501f / 256) << written;
  }
}

TEST_F(NodePackages, SparkReadsWhatIsWritten) {
  VOYAGER_NEEDS_PACKAGE("@sparkjsdev/spark");
  make_city();
  expect_spark_reads("o.ply");
  expect_spark_reads("o.compressed.ply");
  expect_spark_reads("o.spz", " --spz-version 3");
  if (VOYAGER_SOG) expect_spark_reads("o.sog");
}

// Made here: Spark's package writes none.
TEST_F(NodePackages, ARadIsReadAsSparkReadsIt) {
  VOYAGER_NEEDS_PACKAGE("@sparkjsdev/spark");
  make_vivid();
  GaussianCloud cloud = import_file(file("v.ply"));
  for (size_t i = 0; i < cloud.size(); ++i) {
    float* q = &cloud.rotation[4 * i];
    const float length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    for (size_t k = 0; k < 4; ++k) q[k] /= length;
  }
  write("o.rad", rad_of(cloud, 65536));
  ASSERT_NO_FATAL_FAILURE(expect_as_spark("o.rad"));
  ASSERT_NO_FATAL_FAILURE(convert("o.rad", "turned.ply", " --up y"));
  expect_each_coefficient("turned.ply", "theirs.spz", 0.2);
}

TEST_F(NodePackages, ShIsReadCoefficientByCoefficientAsSpzJsReadsIt) {
  VOYAGER_NEEDS_PACKAGE("spz-js");
  make_vivid();
  ASSERT_NO_FATAL_FAILURE(by_node("spz_js.mjs", "v.ply", "theirs.spz"));
  ASSERT_NO_FATAL_FAILURE(by_node("spz_js.mjs", "theirs.spz", "read.ply"));
  ASSERT_NO_FATAL_FAILURE(convert("read.ply", "turned.ply", " --up y"));
  expect_each_coefficient("turned.ply", "theirs.spz", 1e-5);
  convert("v.ply", "ours.compressed.ply");
  ASSERT_NO_FATAL_FAILURE(by_node("spz_js.mjs", "ours.compressed.ply", "read.ply"));
  expect_each_coefficient("ours.compressed.ply", "read.ply", 0.1);
}

TEST_F(NodePackages, ShIsWrittenCoefficientByCoefficientAsSparkReadsIt) {
  VOYAGER_NEEDS_PACKAGE("@sparkjsdev/spark");
  make_vivid();
  for (const char* written : {"o.spz", "o.compressed.ply", "o.ply"}) {
    convert("v.ply", written, std::string(written) == "o.spz" ? " --spz-version 3" : "");
    ASSERT_NO_FATAL_FAILURE(by_node("spark.mjs", written, "theirs.spz"));
    // Spark turns no axes, as if a .ply had those of a .spz.
    convert(written, "turned.ply", std::string(written) == "o.spz" ? "" : " --up y");
    expect_each_coefficient("turned.ply", "theirs.spz", 0.2);  // Spark's steps are of 16 codes
  }
}

TEST_F(NodePackages, TheValidatorFindsNothingInAGlb) {
  VOYAGER_NEEDS_PACKAGE("gltf-validator");
  make_city();
  convert("c.ply", "o.glb");
  expect_sound("o.glb", 3 + 16, false);
  convert("c.ply", "z.glb", " --spz");
  expect_sound("z.glb", 2 + 15, true);
}

TEST_F(NodePackages, TheValidatorFindsNothingInTheTilesOfATileset) {
  VOYAGER_NEEDS_PACKAGE("gltf-validator");
  ASSERT_EQ(
      failure_of({"voyager synth city --gaussians 27000 --sh-degree 3 -o " + file("c.ply"),
                  "voyager bake " + file("c.ply") + " -o " + file("c.voy"),
                  "voyager export " + file("c.voy") + " -o " + file("plain/tileset.json"),
                  "voyager export " + file("c.voy") + " --spz -o " + file("spz/tileset.json")}),
      "");
  for (const char* tile : {"tile_00000.glb", "tile_00001.glb"})
    expect_sound(std::string("plain/") + tile, 3 + 16, false);
  expect_sound("spz/tile_00000.glb", 2 + 15, true);
}

}  // namespace
}  // namespace voyager::node_packages_test
