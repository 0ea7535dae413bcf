// METHOD §6: a mean's place before the camera and in the image, against the distance from the
// world's origin; camera steps of a millimetre. Beside it the textbook's way: both in binary32,
// then subtracted.
#include <random>

#include "runtime/stages/project.h"
#include "tests/numerics/measured.h"
#include "tests/support/render_scene.h"

namespace voyager::camera_relative_test {
namespace {

using test::kEpsilon;

constexpr int kMeans = 4000;
constexpr uint32_t kWidth = 1920, kHeight = 1080;
const Vec3d kDirection{0.7, -0.55, 0.45};  // where the origin lies, times a distance

struct Errors {
  double ours = 0, textbook = 0;  // of what lies between mean and eye, as a share of it
  double pixels = 0, textbook_pixels = 0;
  double step = 0;  // pixels: of how far a millimetre moved it
};

ProjectParams params_of(const Camera& camera, const Vec3d& origin) {
  ProjectParams p{};
  p.origin = origin;
  p.eye = camera.eye;
  p.view = view_projection<float>(camera.world_to_view, camera.fx, camera.fy, camera.cx, camera.cy,
                                  camera.width, camera.height);
  return p;
}

struct Place {
  double x, y;
};
Place exact_place(const Camera& camera, const Vec3d& d) {
  const Vec3d view = camera.world_to_view * d;
  return {camera.fx * view.x / view.z + camera.cx, camera.fy * view.y / view.z + camera.cy};
}
Place place(const ProjectParams& params, const Vec3f& d) {
  const Vec3f view = detail::to_view(params, d);
  return {double{detail::image_x(params, view)}, double{detail::image_y(params, view)}};
}
double apart(const Place& a, const Place& b) {
  return std::max(std::fabs(a.x - b.x), std::fabs(a.y - b.y));
}
double longest(const Vec3d& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

// In 80-bit or wider arithmetic, where the platform has it.
Vec3d exact_relative(const Vec3f& mean, const Vec3d& origin, const Vec3d& eye) {
  Vec3d d{};
  for (int k = 0; k < 3; ++k)
    d[k] = static_cast<double>(static_cast<long double>(mean[k]) + origin[k] - eye[k]);
  return d;
}
Vec3f textbook_relative(const Vec3f& mean, const Vec3d& origin, const Vec3d& eye) {
  Vec3f d{};
  for (int k = 0; k < 3; ++k)
    d[k] = static_cast<float>(double{mean[k]} + origin[k]) - static_cast<float>(eye[k]);
  return d;
}

// A mean in front of a camera, both within a hundred metres of the scene's origin.
struct View {
  Camera camera;
  Vec3f mean;
};
View random_view(std::mt19937& random, double fov) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = 100 * uniform(random), y = 2 * uniform(random), z = 100 * uniform(random);
  const double aside = uniform(random), down = 0.3 * uniform(random);
  const Vec3d stand{x, y, z};
  View v{test::look(stand, stand + Vec3d{aside, down, 1}, kWidth, kHeight, fov), {}};
  const double away = std::pow(10, 1 + uniform(random));
  const double right = 0.5 * kWidth * uniform(random), below = 0.5 * kHeight * uniform(random);
  const Mat3d& w = v.camera.world_to_view;
  const Vec3d at =
      stand + away / v.camera.fx * (right * w.row[0] + below * w.row[1]) + away * w.row[2];
  v.mean = {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
  return v;
}

// Where it is found, and where it is.
struct Seen {
  Place found, exact;
};
Seen see(const Camera& camera, const Vec3d& origin, const Vec3f& mean, Errors& e) {
  const ProjectParams params = params_of(camera, origin);
  const Vec3d truth = exact_relative(mean, origin, camera.eye);
  const Vec3f d = camera_relative(mean, origin, camera.eye),
              t = textbook_relative(mean, origin, camera.eye);
  const Seen seen{place(params, d), exact_place(camera, truth)};
  const auto off = [&](const Vec3f& v) {
    return longest(Vec3d{v.x, v.y, v.z} - truth) / longest(truth);
  };
  e.ours = std::max(e.ours, off(d)), e.textbook = std::max(e.textbook, off(t));
  e.pixels = std::max(e.pixels, apart(seen.found, seen.exact));
  e.textbook_pixels = std::max(e.textbook_pixels, apart(place(params, t), seen.exact));
  return seen;
}

Errors measure(double distance, double fov) {
  std::mt19937 random(5);
  Vec3d origin{};
  for (int k = 0; k < 3; ++k) origin[k] = 1024 * std::round(distance * kDirection[k] / 1024);
  Errors e;
  for (int i = 0; i < kMeans; ++i) {
    View v = random_view(random, fov);
    v.camera.eye = v.camera.eye + origin;
    const Seen before = see(v.camera, origin, v.mean, e);
    v.camera.eye = v.camera.eye + 0.001 * v.camera.world_to_view.row[0];
    const Seen after = see(v.camera, origin, v.mean, e);
    e.step =
        std::max(e.step, apart({after.found.x - before.found.x, after.found.y - before.found.y},
                               {after.exact.x - before.exact.x, after.exact.y - before.exact.y}));
  }
  return e;
}

// An origin is a multiple of 1024 m, so that adding it in double is exact, and what is left is
// the last rounding: the image at 6.4e6 m is the image at home.
TEST(CameraRelative, DistanceFromTheOriginCostsNothing) {
  const Errors home = measure(0, 60);
  for (const double distance : {0.0, 1e3, 1e4, 1e5, 1e6, 6.4e6}) {
    const Errors e = measure(distance, 60);
    EXPECT_LE(e.ours, kEpsilon) << distance;
    EXPECT_LE(e.pixels, 1.01 * home.pixels) << distance;
    EXPECT_LE(e.step, 1.01 * home.step) << distance;
    const std::string name = "distance_" + std::to_string(static_cast<int>(distance));
    test::record(name + "_relative_units", e.ours / kEpsilon);
    test::record(name + "_textbook_relative_units", e.textbook / kEpsilon);
    test::record(name + "_pixels", e.pixels);
    test::record(name + "_textbook_pixels", e.textbook_pixels);
    test::record(name + "_step_pixels", e.step);
  }
  EXPECT_GT(measure(6.4e6, 60).textbook_pixels, 100);  // or the sweep could not tell
}

// Off the axis by a slope of s the depth is known to ε·√(1 + s²) of itself, and a pixel to that
// times its distance from the axis; camera axes and d are rounded to ε, worth ε·f pixels.
TEST(CameraRelative, PixelsAreKnownToTheFocalLengthsDigits) {
  for (const double fov : {1.0, 10.0, 60.0, 120.0, 170.0}) {
    const Errors e = measure(0, fov);
    const double slope = std::tan(fov * 3.14159265358979 / 360), half = 0.5 * kWidth;
    const double bound = 1.6 * kEpsilon * (half / slope + half) * (2 + slope);
    EXPECT_LE(e.pixels, bound) << fov;
    EXPECT_LE(e.step, 1.3 * bound) << fov;
    const std::string name = "fov_" + std::to_string(static_cast<int>(fov));
    test::record(name + "_pixels", e.pixels);
    test::record(name + "_step_pixels", e.step);
  }
}

}  // namespace
}  // namespace voyager::camera_relative_test
