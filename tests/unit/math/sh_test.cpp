// The basis against its definition by Legendre functions, and its integrals.
#include "runtime/math/sh.h"

#include <cmath>
#include <vector>

#include "tests/support/test_support.h"

namespace voyager::sh_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

Vec3d direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TEST(Sh, IsTheRealBasisWithTheCondonShortleyPhase) {
  for (int i = 1; i < 40; ++i)
    for (int j = 0; j < 60; ++j) {
      const double theta = kPi * i / 40, phi = 2 * kPi * j / 60;
      double basis[16];
      sh_basis(3, direction(theta, phi), basis);
      for (int l = 0, k = 0; l <= 3; ++l)
        for (int m = -l; m <= l; ++m, ++k) {
          const unsigned order = static_cast<unsigned>(std::abs(m));
          const double legendre = std::sph_legendre(static_cast<unsigned>(l), order, theta);
          const double turn = m < 0 ? std::sin(order * phi) : std::cos(order * phi);
          EXPECT_NEAR(basis[k], (m == 0 ? 1 : std::sqrt(2.0) * turn) * legendre, 1e-14)
              << l << " " << m;
        }
    }
}

TEST(Sh, IsOrthonormalOverTheSphere) {
  // The midpoint rule in z and φ; exact in φ.
  constexpr int kZ = 2000, kPhi = 16;
  std::vector<double> gram(256, 0.0);
  for (int i = 0; i < kZ; ++i)
    for (int j = 0; j < kPhi; ++j) {
      const double z = -1 + (i + 0.5) * 2 / kZ;
      double basis[16];
      sh_basis(3, direction(std::acos(z), 2 * kPi * j / kPhi), basis);
      for (size_t a = 0; a < 16; ++a)
        for (size_t b = 0; b < 16; ++b)
          gram[16 * a + b] += basis[a] * basis[b] * 4 * kPi / (kZ * kPhi);
    }
  for (size_t a = 0; a < 16; ++a)
    for (size_t b = 0; b < 16; ++b) EXPECT_NEAR(gram[16 * a + b], a == b ? 1 : 0, 1e-5);
}

TEST(Sh, LowerDegreesArePrefixesAndFloatFollowsDouble) {
  for (int j = 0; j < 500; ++j) {
    const Vec3d d = direction(0.1 + 0.006 * j, 0.7 * j);
    const Vec3f f{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
    double all[16], some[16];
    float single[16];
    sh_basis(3, d, all);
    sh_basis(3, f, single);
    for (int degree = 0; degree < 3; ++degree) {
      sh_basis(degree, d, some);
      for (int k = 0; k < sh_coefficients(degree); ++k) EXPECT_EQ(all[k], some[k]);
    }
    for (int k = 0; k < 16; ++k) EXPECT_NEAR(double{single[k]}, all[k], 2e-6);
  }
}

TEST(Sh, ColourIsHalfAtZeroNeverNegativeAndNeverInfinite) {
  const auto colour = [](float r, float g, float b) {
    const float c[3] = {r, g, b};
    return sh_colour(0, Vec3f{0, 0, 1}, [&](int, int channel) { return c[channel]; });
  };
  const Vec3f c = colour(0.0f, -1e3f, 1.0f);
  EXPECT_EQ(c.x, 0.5f);
  EXPECT_EQ(c.y, 0.0f);
  EXPECT_NEAR(double{c.z}, 0.5 + kSh0, 1e-7);
  // Coefficients are finite, but their sum need not be.
  for (const float sign : {1.0f, -1.0f})
    for (int j = 0; j < 100; ++j) {
      const Vec3d d = direction(0.03 * j, 0.7 * j);
      const Vec3f f{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
      const Vec3f most = sh_colour(
          3, f, [&](int, int channel) { return channel == 1 ? -3.4e38f : sign * 3.4e38f; });
      for (int channel = 0; channel < 3; ++channel) {
        EXPECT_TRUE(std::isfinite(most[channel]));
        EXPECT_GE(most[channel], 0.0f);
      }
    }
}

}  // namespace
}  // namespace voyager::sh_test
