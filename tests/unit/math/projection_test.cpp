// METHOD §5 against its textbook form in double, and where that form fails.
#include "runtime/math/projection.h"

#include <algorithm>

#include "tests/support/render_scene.h"

namespace voyager::projection_test {
namespace {

struct Case {
  Camera camera;
  Vec3d view;  // the mean in view space
  Quatd rotation;
  Vec3d scale;
};

Case random_case(std::mt19937& random, double log_scale_low, double log_scale_high) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  Case c;
  c.camera = test::look({0, 0, 0}, {normal(random), normal(random), normal(random)}, 640, 480);
  c.camera.cx = 640 * uniform(random);
  c.view = {4 * normal(random), 4 * normal(random), 0.3 + 10 * uniform(random)};
  const Quatf q =
      normalise(Quatf{static_cast<float>(normal(random)), static_cast<float>(normal(random)),
                      static_cast<float>(normal(random)), static_cast<float>(normal(random))});
  c.rotation = normalise(Quatd{q.w, q.x, q.y, q.z});
  for (int k = 0; k < 3; ++k)
    c.scale[k] = static_cast<double>(static_cast<float>(
        std::pow(10, log_scale_low + (log_scale_high - log_scale_low) * uniform(random))));
  return c;
}

template <class T>
ImageCovariance<T> covariance(const Case& c) {
  const Camera& k = c.camera;
  const auto v = view_projection<T>(k.world_to_view, k.fx, k.fy, k.cx, k.cy, k.width, k.height);
  const auto cast = [](double x) { return static_cast<T>(x); };
  return image_covariance(
      image_jacobian(v, Vec3<T>{cast(c.view.x), cast(c.view.y), cast(c.view.z)}),
      Quat<T>{cast(c.rotation.w), cast(c.rotation.x), cast(c.rotation.y), cast(c.rotation.z)},
      Vec3<T>{cast(c.scale.x), cast(c.scale.y), cast(c.scale.z)}, cast(kLowPass));
}

// J W Σ Wᵀ Jᵀ + 0.3 I by plain matrices.
ImageCovariance<double> textbook(const Case& c) {
  const Camera& k = c.camera;
  const double z = c.view.z, grow_x = 0.3 * 0.5 * k.width / k.fx,
               grow_y = 0.3 * 0.5 * k.height / k.fy;
  const double x =
      z * std::clamp(c.view.x / z, -k.cx / k.fx - grow_x, (k.width - k.cx) / k.fx + grow_x);
  const double y =
      z * std::clamp(c.view.y / z, -k.cy / k.fy - grow_y, (k.height - k.cy) / k.fy + grow_y);
  const double j[2][3] = {{k.fx / z, 0, -k.fx * x / (z * z)}, {0, k.fy / z, -k.fy * y / (z * z)}};
  const Mat3d r = rotation(c.rotation);
  double jw[2][3] = {}, sigma[3][3] = {}, out[2][2] = {{0.3, 0}, {0, 0.3}};
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 3; ++b)
      for (int m = 0; m < 3; ++m) jw[a][b] += j[a][m] * k.world_to_view.row[m][b];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int m = 0; m < 3; ++m)
        sigma[a][b] += r.row[a][m] * c.scale[m] * c.scale[m] * r.row[b][m];
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (int m = 0; m < 3; ++m)
        for (int n = 0; n < 3; ++n) out[a][b] += jw[a][m] * sigma[m][n] * jw[b][n];
  return {out[0][0], out[0][1], out[1][1],
          (out[0][0] * out[1][1] - out[0][1] * out[0][1]) / out[0][0], 0};
}

TEST(Projection, IsTheTextbookCovarianceWhereThatIsWellConditioned) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const Case c = random_case(random, -2, 0);
    const ImageCovariance<double> expected = textbook(c), found = covariance<double>(c);
    ASSERT_NEAR(found.xx, expected.xx, 1e-11 * expected.xx);
    ASSERT_NEAR(found.xy, expected.xy, 1e-11 * std::sqrt(expected.xx * expected.yy));
    ASSERT_NEAR(found.yy, expected.yy, 1e-11 * expected.yy);
    ASSERT_NEAR(found.y_given_x, expected.y_given_x, 1e-8 * expected.yy);
  }
}

// σ of x, and of y once x is known, in units of 2^-24 times the longest scale in
// pixels as it would be seen from its side: the rounding of quaternion and view
// axes alone moves the ends of the Gaussian by that much. Where x is known by
// little more than the low-pass, the same movement counts against its 0.55 pixels.
TEST(Projection, FloatFollowsDoubleForNeedlesAndDiscs) {
  std::mt19937 random(2);
  double along = 0, across = 0;
  for (int i = 0; i < 100000; ++i) {
    const Case c = random_case(random, -7, 1);  // axis ratios up to 1e8
    const ImageCovariance<float> f = covariance<float>(c);
    const ImageCovariance<double> d = covariance<double>(c);
    ASSERT_GT(f.xx, 0.29f);
    ASSERT_GT(f.y_given_x, 0.29f);
    Case ball = c;
    ball.scale.x = ball.scale.y = ball.scale.z = std::max({c.scale.x, c.scale.y, c.scale.z});
    const ImageCovariance<double> side = covariance<double>(ball);
    const double unit = std::sqrt(std::max(side.xx, side.yy)) / 16777216;
    along = std::max(along, std::fabs(std::sqrt(double{f.xx}) - std::sqrt(d.xx)) / unit);
    const double given = std::sqrt(d.y_given_x), moved = 1 + given / std::sqrt(0.3);
    across = std::max(across, std::fabs(std::sqrt(double{f.y_given_x}) - given) / (unit * moved));
  }
  EXPECT_LE(along, 16);
  EXPECT_LE(across, 16);
  RecordProperty("along_units", std::to_string(along));
  RecordProperty("across_units", std::to_string(across));
}

TEST(Projection, RhoIsNeverPositiveAndTheDeterminantNeverVanishes) {
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {
    const Case c = random_case(random, -9, i % 2 ? 6 : 2);
    const ImageCovariance<float> f = covariance<float>(c);
    ASSERT_TRUE(std::isfinite(f.xx) && std::isfinite(f.y_given_x) && f.xx > 0 && f.y_given_x > 0);
    const Conic<float> k = conic(f, 0.5f);
    ASSERT_TRUE(k.p_x > 0 && k.q_y > 0 && std::isfinite(k.skew));
    for (int j = 0; j < 8; ++j) {
      const float dx = static_cast<float>(random() % 4096) - 2048.0f,
                  dy = static_cast<float>(random() % 4096) - 2048.0f;
      const float p = dx * k.p_x, q = std::fma(-k.skew, dx, dy) * k.q_y;
      ASSERT_LE(-std::fma(q, q, p * p), 0.0f);
    }
  }
}

TEST(Projection, RhoIsTheQuadraticFormOfTheInverse) {
  std::mt19937 random(4);
  for (int i = 0; i < 5000; ++i) {
    const ImageCovariance<double> c = textbook(random_case(random, -2, 0));
    const double det = c.xx * c.y_given_x;
    for (const double log2e : {1.0, 1.4426950408889634}) {
      const Conic<double> k = conic(c, 0.5 * log2e);
      const double dx = 13.5, dy = -7.25, p = dx * k.p_x, q = (dy - k.skew * dx) * k.q_y;
      const double expected =
          -0.5 * log2e * (c.yy * dx * dx - 2 * c.xy * dx * dy + c.xx * dy * dy) / det;
      ASSERT_NEAR(-(p * p + q * q), expected, 1e-9 * (1 + std::fabs(expected)));
    }
  }
}

TEST(Projection, ClampsEachSideOfAnOffCentreFrustumByItsOwnBound) {
  const auto v = view_projection<double>({}, 500, 400, 100, 380, 1000, 400);
  EXPECT_NEAR(v.x_low, -0.2 - 0.3, 1e-15);
  EXPECT_NEAR(v.x_high, 1.8 + 0.3, 1e-15);
  EXPECT_NEAR(v.y_low, -0.95 - 0.15, 1e-15);
  EXPECT_NEAR(v.y_high, 0.05 + 0.15, 1e-15);
  Camera camera = test::look({0, 0, 0}, {0, 0, 1}, 1000, 400);
  camera.fx = 500, camera.fy = 400, camera.cx = 100, camera.cy = 380;
  for (const double slope : {-3.0, -0.5, 0.0, 2.1, 9.0}) {
    const Case at{camera, {2 * slope, 0, 2}, {1, 0, 0, 0}, {0.1, 0.1, 0.1}};
    Case clamped = at;
    clamped.view.x = 2 * std::clamp(slope, -0.5, 2.1);
    EXPECT_NEAR(covariance<double>(at).xx, covariance<double>(clamped).xx, 1e-9);
  }
}

}  // namespace
}  // namespace voyager::projection_test
