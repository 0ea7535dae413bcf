#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

#include "runtime/scene/export/morton_order.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::compressed_ply_export_test {
namespace {

// A decoder of the bytes after the header, by the format's own description.
struct File {
  File(const test::Bytes& bytes, size_t gaussians, int sh_degree) {
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const size_t begin = text.find("end_header\n") + 11;
    header = text.substr(0, begin);
    const size_t chunks = (gaussians + 255) / 256;
    bounds.resize(chunks);
    vertices.resize(gaussians);
    sh_each = static_cast<size_t>(sh_coefficients(sh_degree) - 1) * 3;
    sh.resize(gaussians * sh_each);
    EXPECT_EQ(bytes.size() - begin, chunks * 72 + gaussians * (16 + sh_each));
    const std::byte* at = bytes.data() + begin;
    const auto take = [&](auto& into) {
      if (into.empty()) return;  // memcpy takes no null
      std::memcpy(into.data(), at, into.size() * sizeof(into[0]));
      at += into.size() * sizeof(into[0]);
    };
    take(bounds);
    take(vertices);
    take(sh);
  }

  // `kind`: 0 position, 1 log scale, 2 colour.
  float bound(size_t i, int kind, int end, int axis) const {
    return bounds[i / 256][static_cast<size_t>(6 * kind + 3 * end + axis)];
  }
  double step(size_t i, int kind, int axis) const {
    const double codes = kind == 2 ? 255 : axis == 1 ? 1023 : 2047;
    return (double{bound(i, kind, 1, axis)} - double{bound(i, kind, 0, axis)}) / codes;
  }
  double value(size_t i, int kind, int axis) const {
    const uint32_t word = vertices[i][kind == 0 ? 0 : kind == 1 ? 2 : 3];
    const uint32_t code = kind == 2   ? word >> (24 - 8 * axis) & 255
                          : axis == 0 ? word >> 21
                          : axis == 1 ? word >> 11 & 1023
                                      : word & 2047;
    return double{bound(i, kind, 0, axis)} + code * step(i, kind, axis);
  }
  double opacity(size_t i) const { return (vertices[i][3] & 255) / 255.0; }
  Quatd rotation(size_t i) const {
    const uint32_t word = vertices[i][1];
    double q[4] = {}, squared = 0;
    int shift = 20;
    for (uint32_t k = 0; k < 4; ++k) {
      if (k == word >> 30) continue;
      q[k] = ((word >> shift & 1023) / 1023.0 - 0.5) * std::sqrt(2.0);
      squared += q[k] * q[k];
      shift -= 10;
    }
    q[word >> 30] = std::sqrt(std::max(0.0, 1 - squared));
    return {q[0], q[1], q[2], q[3]};
  }

  std::string header;
  std::vector<std::array<float, 18>> bounds;
  std::vector<std::array<uint32_t, 4>> vertices;
  size_t sh_each = 0;
  std::vector<uint8_t> sh;
};

test::Bytes bytes_of(const GaussianCloud& cloud, const NativeScale& native = {}) {
  test::PlacedBytesSink sink;
  const auto writer = write_compressed_ply(sink, cloud.size(), cloud.sh_degree, native);
  writer->append(cloud);
  writer->finish();
  return sink.bytes;
}

void expect_near(const File& file, size_t at, const GaussianCloud& cloud, size_t i) {
  const auto width = static_cast<size_t>(cloud.coefficients()) * 3;
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<size_t>(axis);
    const double values[3] = {double{cloud.position[3 * i + k]}, double{cloud.log_scale[3 * i + k]},
                              0.5 + kSh0 * double{cloud.sh[i * width + k]}};
    for (int kind = 0; kind < 3; ++kind)
      ASSERT_NEAR(file.value(at, kind, axis), values[kind],
                  0.501 * file.step(at, kind, axis) + 1e-5);
  }
  ASSERT_NEAR(file.opacity(at), sigmoid(cloud.opacity[i]), 0.5 / 255 + 1e-6);
  const Quatf a = normalise(cloud.words(i).rotation);
  const Quatd b = file.rotation(at);
  ASSERT_GT(
      std::fabs(double{a.w} * b.w + double{a.x} * b.x + double{a.y} * b.y + double{a.z} * b.z),
      1 - 4e-6);
  for (size_t rest = 0; rest < file.sh_each; ++rest) {
    const size_t coefficients = file.sh_each / 3;
    const size_t channel = rest / coefficients, k = 1 + rest % coefficients;
    const double read = ((file.sh[at * file.sh_each + rest] + 0.5) / 256 - 0.5) * 8;
    ASSERT_NEAR(read, double{cloud.sh[i * width + 3 * k + channel]}, 1.0 / 64 + 1e-6);
  }
}

TEST(CompressedPlyExport, ComesBackWithinHalfAStepOfItsChunk) {
  for (const int degree : {0, 1, 2, 3}) {
    const GaussianCloud cloud = test::random_cloud(1000, 31, degree, 100.0f);
    const File file(bytes_of(cloud), cloud.size(), degree);
    const std::vector<uint32_t> order = morton_order(cloud.position);
    for (size_t at = 0; at < order.size(); ++at) expect_near(file, at, cloud, order[at]);
  }
}

TEST(CompressedPlyExport, TheHeaderNamesWhatFollows) {
  const File file(bytes_of(test::random_cloud(300, 3, 1), compensated_scale(kLowPass)), 300, 1);
  for (const char* line :
       {"\ncomment antialiased 1\n", "\nelement chunk 2\n", "\nproperty float min_x\n",
        "\nproperty float max_scale_z\n", "\nproperty float max_b\n", "\nelement vertex 300\n",
        "\nproperty uint packed_color\n", "\nelement sh 300\n", "\nproperty uchar f_rest_8\n"})
    EXPECT_NE(file.header.find(line), std::string::npos) << line;
  EXPECT_EQ(file.header.find("f_rest_9"), std::string::npos);
}

// What is ordered together has a bound, beyond which the rest follows.
TEST(CompressedPlyExport, AScenesOfMoreThanIsOrderedTogetherIsWhole) {
  const GaussianCloud cloud = test::random_cloud((1 << 18) + 300, 5, 0);
  const File file(bytes_of(cloud), cloud.size(), 0);
  expect_near(file, cloud.size() - 1, cloud,
              (1 << 18) + morton_order(std::span(cloud.position).subspan(3 << 18)).back());
  double sum = 0, expected = 0;
  for (size_t i = 0; i < cloud.size(); ++i) sum += file.value(i, 0, 0);
  for (size_t i = 0; i < cloud.size(); ++i) expected += double{cloud.position[3 * i]};
  EXPECT_NEAR(sum, expected, 1e-3 * static_cast<double>(cloud.size()));
}

TEST(CompressedPlyExport, BatchesMakeTheSameBytesAsOne) {
  const GaussianCloud first = test::random_cloud(400, 1, 1), second = test::random_cloud(77, 2, 1);
  GaussianCloud both = first;
  for (const auto words : {&GaussianCloud::position, &GaussianCloud::log_scale,
                           &GaussianCloud::rotation, &GaussianCloud::opacity, &GaussianCloud::sh})
    (both.*words).insert((both.*words).end(), (second.*words).begin(), (second.*words).end());
  test::PlacedBytesSink sink;
  const auto writer = write_compressed_ply(sink, 477, 1);
  writer->append(first);
  writer->append(second);
  writer->finish();
  EXPECT_EQ(sink.bytes, bytes_of(both));
}

// The error of a position is a share of its chunk's size.
TEST(CompressedPlyExport, ChunksAreMuchSmallerThanInTheInputsOrder) {
  const GaussianCloud cloud = test::random_cloud(256 * 64, 9, 0);
  const File file(bytes_of(cloud), cloud.size(), 0);
  double steps = 0;
  for (size_t i = 0; i < cloud.size(); i += 256) steps += file.step(i, 0, 0) * 2047 / 64;
  EXPECT_LT(steps, 10.0)
      << "m of a scene of 20 m; in the input's order each chunk is as large as that";
}

TEST(CompressedPlyExport, HoldsItsCallerToTheAnnouncement) {
  test::PlacedBytesSink sink;
  GaussianCloud cloud = test::random_cloud(3, 3, 1);
  EXPECT_THROW(write_compressed_ply(sink, 2, 1)->append(cloud), Error);
  EXPECT_THROW(write_compressed_ply(sink, 3, 2)->append(cloud), Error);
  EXPECT_THROW(write_compressed_ply(sink, 3, 4), Error);
  const auto writer = write_compressed_ply(sink, 7, 1);
  writer->append(cloud);
  EXPECT_THROW(writer->finish(), Error);
  cloud.origin = {1024, 0, 0};
  EXPECT_THROW(writer->append(cloud), Error) << "of another origin";
}

}  // namespace
}  // namespace voyager::compressed_ply_export_test
