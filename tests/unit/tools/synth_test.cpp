// The made-up city: exact counts, the same bytes for the same description, and
// cameras that stand in the open.
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/math/vec.h"
#include "runtime/scene/sanitise.h"
#include "tests/support/test_support.h"
#include "tools/synth/city.h"
#include "tools/synth/city_layout.h"
#include "tools/synth/portable_math.h"

namespace voyager::synth_test {
namespace {

using synth::CityDesc;

GaussianCloud city(const CityDesc& desc, size_t* largest_batch = nullptr) {
  GaussianCloud all;
  all.sh_degree = desc.sh_degree;
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  synth::generate_city(desc, [&](const GaussianCloud& batch) {
    EXPECT_EQ(batch.sh_degree, desc.sh_degree);
    if (largest_batch) *largest_batch = std::max(*largest_batch, batch.size());
    append(all.position, batch.position);
    append(all.log_scale, batch.log_scale);
    append(all.rotation, batch.rotation);
    append(all.opacity, batch.opacity);
    append(all.sh, batch.sh);
  });
  return all;
}

bool same(const GaussianCloud& a, const GaussianCloud& b) {
  return a.position == b.position && a.log_scale == b.log_scale && a.rotation == b.rotation &&
         a.opacity == b.opacity && a.sh == b.sh;
}

TEST(Synth, GivesExactlyTheGaussiansAskedForInBoundedBatches) {
  for (uint64_t count : {1u, 7u, 10000u, 12345u, 100000u, 200001u}) {
    size_t largest = 0;
    const GaussianCloud cloud = city({count, 1, 0}, &largest);
    EXPECT_EQ(cloud.size(), count);
    EXPECT_EQ(cloud.position.size(), 3 * count);
    EXPECT_EQ(cloud.log_scale.size(), 3 * count);
    EXPECT_EQ(cloud.rotation.size(), 4 * count);
    EXPECT_EQ(cloud.sh.size(), 3 * count);
    EXPECT_LE(largest, 65536u);
  }
}

TEST(Synth, FollowsFromItsDescriptionAlone) {
  const GaussianCloud first = city({20000, 1, 3});
  EXPECT_TRUE(same(first, city({20000, 1, 3})));
  EXPECT_FALSE(same(first, city({20000, 2, 3})));
}

// On any machine and with any compiler. A change of looks changes this number:
// it also changes what benchmarks on made-up cities mean, so do it knowingly.
TEST(Synth, GivesTheSameBytesEverywhere) {
  const GaussianCloud cloud = city({20000, 1, 3});
  uint64_t all = 0;
  for (const auto* words :
       {&cloud.position, &cloud.log_scale, &cloud.rotation, &cloud.opacity, &cloud.sh})
    all = all * 31 + checksum(std::as_bytes(std::span(*words)));
  EXPECT_EQ(all, 16153414973222545420u);
}

TEST(Synth, ALowerDegreeOnlyLeavesCoefficientsOut) {
  const GaussianCloud full = city({20000, 5, 3}), flat = city({20000, 5, 1});
  EXPECT_EQ(full.position, flat.position);
  EXPECT_EQ(full.opacity, flat.opacity);
  for (size_t i = 0; i < full.size(); ++i)
    for (size_t k = 0; k < 12; ++k) ASSERT_EQ(full.sh[48 * i + k], flat.sh[12 * i + k]);
}

TEST(Synth, NothingNeedsMendingAndAllLiesWithinTheStatedBound) {
  for (uint64_t count : {10000u, 150000u}) {
    const CityDesc desc{count, 3, 3};
    GaussianCloud cloud = city(desc);
    const float bound = synth::largest_coordinate(desc);
    for (float x : cloud.position) ASSERT_LE(std::fabs(x), bound);
    sanitise(cloud);
    EXPECT_EQ(cloud.report.dropped(), 0u);
    EXPECT_EQ(cloud.report.repaired(), 0u);
    EXPECT_EQ(cloud.size(), count);
  }
}

TEST(Synth, TheLargestCityFitsFixedPointPositions) {
  EXPECT_LT(synth::largest_coordinate({1'000'000'000'000, 1, 3}), 2048.0f);
}

// As in a captured city: flat discs, one in a hundred of them extreme, and opacities of every
// degree.
TEST(Synth, ShapesAndOpacitiesSpreadLikeACapture) {
  const GaussianCloud cloud = city({100000, 1, 0});
  size_t extreme = 0, opaque = 0, faint = 0;
  for (size_t i = 0; i < cloud.size(); ++i) {
    const Gaussian g = activate(cloud.words(i), true);
    const float large = std::max({g.scale.x, g.scale.y, g.scale.z});
    const float small = std::min({g.scale.x, g.scale.y, g.scale.z});
    extreme += large > 1e5f * small;
    opaque += g.opacity > 0.95f;
    faint += g.opacity < 0.25f;
  }
  const auto part = [&](size_t n) {
    return static_cast<double>(n) / static_cast<double>(cloud.size());
  };
  EXPECT_GT(part(extreme), 0.003);
  EXPECT_LT(part(extreme), 0.03);
  EXPECT_GT(part(opaque), 0.2);
  EXPECT_LT(part(opaque), 0.6);
  EXPECT_GT(part(faint), 0.05);
  EXPECT_LT(part(faint), 0.3);
}

TEST(Synth, CamerasAreRotationsThatStandInTheOpen) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const CityDesc desc{seed % 2 ? 10000u : 1'000'000u, seed, 3};
    const synth::Layout layout = synth::city_layout(desc);
    const nlohmann::json cameras = nlohmann::json::parse(synth::city_cameras_json(desc));
    ASSERT_EQ(cameras.size(), 120u);
    for (size_t i = 0; i < cameras.size(); ++i) {
      const auto& camera = cameras[i];
      EXPECT_EQ(camera["id"], i);
      const Vec3d p{camera["position"][0], camera["position"][1], camera["position"][2]};
      EXPECT_FALSE(layout.blocked(p, 0.5)) << camera["img_name"] << " seed " << seed;
      Vec3d axis[3];
      for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) axis[column][row] = camera["rotation"][row][column];
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) EXPECT_NEAR(dot(axis[a], axis[b]), a == b ? 1.0 : 0.0, 1e-12);
      EXPECT_NEAR(dot(synth::cross(axis[0], axis[1]), axis[2]), 1.0, 1e-12);
      EXPECT_GT(axis[1].y, 0.5) << "camera y points down";
      const double height = -p.y;
      if (i < 60)
        EXPECT_NEAR(height, 1.7, 1e-9);
      else
        EXPECT_TRUE(height >= 40.0 && height <= 80.0) << height;
    }
    EXPECT_EQ(cameras[0]["img_name"], "walk_000");
    EXPECT_EQ(cameras[60]["img_name"], "flight_000");
  }
}

// Up to a wall that every city has, without a tree, a lamp or a car in the way.
TEST(Synth, TheCloseUpEndsAtAWall) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const CityDesc desc{seed % 2 ? 10000u : 1'000'000u, seed, 3};
    const synth::Layout layout = synth::city_layout(desc);
    const nlohmann::json cameras = nlohmann::json::parse(synth::city_close_up_json(desc));
    ASSERT_EQ(cameras.size(), 60u);
    for (size_t i = 0; i < cameras.size(); ++i) {
      const auto& camera = cameras[i];
      const Vec3d p{camera["position"][0], camera["position"][1], camera["position"][2]};
      if (p.x > -7.7) {  // farther from the wall than what counts as blocked
        EXPECT_FALSE(layout.blocked(p, 0.2)) << camera["img_name"] << " seed " << seed;
      }
      EXPECT_EQ(camera["rotation"][0][2], -1.0);
      if (i < 29) continue;
      size_t walls = 0;  // whose plane is 0.3 m ahead, where the eye looks
      for (const synth::Cell& cell : layout.cells())
        for (const synth::Building& b : cell.buildings)
          walls += std::abs(p.x - b.x1 - 0.3) < 1e-9 && p.z > b.z0 && p.z < b.z1 && b.front[1];
      EXPECT_EQ(walls, 1u) << camera["img_name"] << " seed " << seed;
    }
  }
}

TEST(Synth, TheLayoutKnowsWhatStandsWhere) {
  const synth::Layout layout(2, 1);
  size_t buildings = 0;
  for (const synth::Cell& cell : layout.cells())
    for (const synth::Building& b : cell.buildings) {
      ++buildings;
      const double x = 0.5 * (b.x0 + b.x1), z = 0.5 * (b.z0 + b.z1);
      EXPECT_TRUE(layout.blocked({x, -1.0, z}, 0.0));
      EXPECT_TRUE(layout.shaded({x, -1.0, z}));
      EXPECT_LT(b.top(), synth::kTallestTower);
    }
  EXPECT_GT(buildings, 20u);
  EXPECT_FALSE(layout.blocked({0.0, -1.7, 0.0}, 1.0));
  EXPECT_FALSE(layout.shaded({0.0, -60.0, 0.0}));
}

TEST(Synth, PortableFunctionsAgreeWithTheLibrary) {
  for (double x = 1e-7; x < 1e4; x *= 1.37) EXPECT_NEAR(synth::portable_log(x), std::log(x), 1e-10);
  for (double x = -3.0; x <= 3.0; x += 0.01)
    EXPECT_NEAR(synth::portable_sin(x), std::sin(x), 1e-11);
}

TEST(Synth, RefusesWhatItCannotMake) {
  const auto ignore = [](const GaussianCloud&) {};
  EXPECT_THROW(synth::generate_city({0, 1, 3}, ignore), Error);
  EXPECT_THROW(synth::generate_city({uint64_t{1} << 41, 1, 3}, ignore), Error);
  EXPECT_THROW(synth::generate_city({10, 1, 4}, ignore), Error);
  EXPECT_THROW(synth::generate_city({10, 1, -1}, ignore), Error);
  EXPECT_THROW(synth::city_cameras_json({0, 1, 3}), Error);
}

}  // namespace
}  // namespace voyager::synth_test
