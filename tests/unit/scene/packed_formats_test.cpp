// The real block out of the packed formats: how far each parameter is from the .ply's.
#include <algorithm>
#include <numeric>

#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::packed_formats_test {
namespace {

struct Difference {
  double position = 0, log_scale = 0, opacity = 0, rotation = 0, colour = 0, sh = 0;  // largest
};

double distance(const float* a, const float* b, size_t count) {
  double most = 0;
  for (size_t i = 0; i < count; ++i)
    most = std::max(most, std::fabs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  return most;
}

// The largest coefficients that a format can say: of the constant band, and of the others.
struct Range {
  float colour = 1e9f, sh = 1e9f;
};

void see(Difference& most, const GaussianCloud& a, size_t i, const GaussianCloud& b, size_t j,
         const Range& range) {
  const auto larger = [](double& largest, double d) { largest = std::max(largest, d); };
  larger(most.position, distance(&a.position[3 * i], &b.position[3 * j], 3));
  larger(most.log_scale, distance(&a.log_scale[3 * i], &b.log_scale[3 * j], 3));
  larger(most.opacity,
         std::fabs(static_cast<double>(sigmoid(a.opacity[i]) - sigmoid(b.opacity[j]))));
  const Quatf p = normalise(a.words(i).rotation), q = normalise(b.words(j).rotation);
  larger(most.rotation,
         1.0 - std::fabs(static_cast<double>(p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z)));
  const size_t of_a = static_cast<size_t>(a.coefficients()) * 3;
  const size_t of_b = static_cast<size_t>(b.coefficients()) * 3;
  for (size_t k = 0; k < std::min(of_a, of_b); ++k) {
    const float limit = k < 3 ? range.colour : range.sh;
    const float expected = std::clamp(a.sh[i * of_a + k], -limit, limit);
    larger(k < 3 ? most.colour : most.sh,
           std::fabs(static_cast<double>(expected - b.sh[j * of_b + k])));
  }
}

// Of each Gaussian of `b`, the one of `a` that it was: the most alike of those close by. Writers of
// packed formats sort.
std::vector<size_t> origins(const GaussianCloud& a, const GaussianCloud& b, float reach) {
  std::vector<size_t> by_x(a.size());
  std::iota(by_x.begin(), by_x.end(), size_t{0});
  const auto x = [&](size_t i) { return a.position[3 * i]; };
  std::sort(by_x.begin(), by_x.end(), [&](size_t i, size_t j) { return x(i) < x(j); });
  const auto of_a = static_cast<size_t>(a.coefficients()) * 3;
  const auto of_b = static_cast<size_t>(b.coefficients()) * 3;
  const auto unlike = [&](size_t i, size_t j) {
    return distance(&a.position[3 * i], &b.position[3 * j], 3) / static_cast<double>(reach) +
           distance(&a.log_scale[3 * i], &b.log_scale[3 * j], 3) +
           distance(&a.sh[of_a * i], &b.sh[of_b * j], 3) +
           std::fabs(static_cast<double>(sigmoid(a.opacity[i]) - sigmoid(b.opacity[j])));
  };
  std::vector<size_t> found;
  for (size_t j = 0; j < b.size(); ++j) {
    const float here = b.position[3 * j];
    auto at = std::lower_bound(by_x.begin(), by_x.end(), here - reach,
                               [&](size_t i, float value) { return x(i) < value; });
    size_t best = *std::min(at, by_x.end() - 1);
    for (; at != by_x.end() && x(*at) <= here + reach; ++at)
      if (unlike(*at, j) < unlike(best, j)) best = *at;
    found.push_back(best);
  }
  return found;
}

void print(const char* name, const Difference& d) {
  std::printf(
      "%s: position %.3g m, log scale %.3g, opacity %.3g, 1-|dot| %.3g, f_dc %.3g, sh %.3g\n", name,
      d.position, d.log_scale, d.opacity, d.rotation, d.colour, d.sh);
}

TEST(PackedFormats, TheBlockIsTheSameInPlyAndCompressedPly) {
  VOYAGER_NEEDS_SCENES(folder);
  const GaussianCloud ply = test::import_file(folder + "/formats/block.ply");
  const GaussianCloud packed = test::import_file(folder + "/formats/block.compressed.ply");
  ASSERT_EQ(packed.size(), ply.size());
  ASSERT_EQ(packed.sh_degree, 3);
  const std::vector<size_t> from = origins(ply, packed, 0.05f);
  Difference d;
  for (size_t j = 0; j < from.size(); ++j) see(d, ply, from[j], packed, j, {.sh = 4});
  print("block.compressed.ply", d);
  std::vector<size_t> once = from;
  std::sort(once.begin(), once.end());
  EXPECT_EQ(std::unique(once.begin(), once.end()) - once.begin(),
            static_cast<std::ptrdiff_t>(ply.size()));
  EXPECT_LE(d.position, 0.02);  // half a step of a chunk of 80 m
  EXPECT_LE(d.log_scale, 0.02);
  EXPECT_LE(d.opacity, 1.0 / 255);
  EXPECT_LE(d.rotation, 1e-5);
  EXPECT_LE(d.colour, 0.05);
  EXPECT_LE(d.sh, 4.0 / 255);
}

TEST(PackedFormats, TheBlockIsTheSameInPlyAndSplat) {
  VOYAGER_NEEDS_SCENES(folder);
  const GaussianCloud ply = test::import_file(folder + "/formats/block.ply");
  const GaussianCloud splat = test::import_file(folder + "/formats/block.splat");
  ASSERT_EQ(splat.size(), ply.size());
  ASSERT_EQ(splat.sh_degree, 0);
  Difference d;
  const Range range{.colour = static_cast<float>(0.5 / kSh0)};
  for (size_t i = 0; i < ply.size(); ++i) see(d, ply, i, splat, i, range);
  print("block.splat", d);
  EXPECT_EQ(d.position, 0);
  EXPECT_LE(d.log_scale, 1e-6);
  EXPECT_LE(d.opacity, 1.0 / 255 + 1e-6);  // its writer cuts fractions off
  EXPECT_LE(d.rotation, 2e-4);             // cut off, too
  EXPECT_LE(d.colour, 1.0 / 255 / kSh0 + 1e-5);
}

TEST(PackedFormats, ThreePointsAreTheSameInPlyAndSplat) {
  VOYAGER_NEEDS_SCENES(folder);
  const std::string base = folder + "/formats/train-3points/test-splat.3-points-from-train.";
  const GaussianCloud ply = test::import_file(base + "ply"),
                      splat = test::import_file(base + "splat");
  ASSERT_EQ(splat.size(), 3u);
  Difference d;
  for (size_t i = 0; i < 3; ++i) see(d, ply, i, splat, i, {});
  EXPECT_EQ(d.position, 0);
  EXPECT_LE(d.log_scale, 1e-6);
  EXPECT_LE(d.opacity, 1.0 / 255);
  EXPECT_LE(d.rotation, 5e-5);
  EXPECT_LE(d.colour, 1.0 / 255 / kSh0 + 1e-5);
}

TEST(PackedFormats, TheMinimalSplatIsTheMinimalSpz) {
  VOYAGER_NEEDS_SCENES(folder);
  const GaussianCloud splat = test::import_file(folder + "/formats/minimal.splat");
  const GaussianCloud spz = test::import_file(folder + "/formats/minimal-v4.spz");
  ASSERT_EQ(splat.size(), spz.size());
  Difference d;
  for (size_t i = 0; i < spz.size(); ++i) see(d, spz, i, splat, i, {});
  EXPECT_EQ(d.position, 0);
  EXPECT_LE(d.log_scale, 1.0 / 16);
  EXPECT_LE(d.opacity, 1.0 / 255);
  EXPECT_LE(d.colour, 1.0 / 255 / 0.15);
}

TEST(PackedFormats, TheMinimalKsplatIsTheMinimalSplat) {
  VOYAGER_NEEDS_SCENES(folder);
  const GaussianCloud splat = test::import_file(folder + "/formats/minimal.splat");
  const GaussianCloud ksplat = test::import_file(folder + "/formats/minimal.ksplat");
  ASSERT_EQ(ksplat.size(), splat.size());
  Difference d;
  for (size_t i = 0; i < splat.size(); ++i) see(d, splat, i, ksplat, i, {});
  EXPECT_EQ(d.position, 0);
  EXPECT_LE(d.log_scale, 1e-6);
  EXPECT_EQ(d.opacity, 0);
  EXPECT_LE(d.rotation, 5e-5);
  EXPECT_EQ(d.colour, 0);
}

}  // namespace
}  // namespace voyager::packed_formats_test
