// METHOD §5: condition against error of the determinant and of ρ, the textbook's binary32
// beside ours. Both precisions start from the same binary32 Gaussian and camera.
#include "tests/numerics/footprints.h"
#include "tests/numerics/measured.h"
#include "tests/numerics/textbook.h"

namespace voyager::conic_test {
namespace {

using test::Build;
using test::Footprint;
using test::kEpsilon;

constexpr int kShapes = 400, kPlaces = 16;
constexpr double kLeastRho = -5.55;  // where the support of an opaque leaf ends

struct Errors {
  double rho = 0, determinant = 0;  // the largest; absolute, relative

  void note(double rho_error, double determinant_error) {
    rho = std::max(rho, rho_error), determinant = std::max(determinant, determinant_error);
  }
};
struct Comparison {
  Errors textbook, ours;
  int broken = 0;  // of the textbook's determinants: not positive

  void take(const Comparison& other) {
    textbook.note(other.textbook.rho, other.textbook.determinant);
    ours.note(other.ours.rho, other.ours.determinant);
    broken += other.broken;
  }
};

void compare(std::mt19937& random, const Footprint& f, Comparison& found) {
  const ImageCovariance<double> exact = f.covariance<double>();
  const ImageCovariance<float> c = f.covariance<float>();
  const auto text =
      test::textbook_conic(f.jacobian<float>(), f.turned<float>(), Footprint::cast<float>(f.scale));
  const auto relative = [&](double d) { return std::fabs(d / (exact.xx * exact.y_given_x) - 1); };
  found.ours.note(0, relative(double{c.xx} * double{c.y_given_x}));
  found.textbook.note(0, relative(double{text.determinant}));
  found.broken += !(text.determinant > 0);
  const Conic<double> truth = conic(exact, 0.5);
  const Conic<float> k = conic(c, 0.5f);
  for (int i = 0; i < kPlaces; ++i) {
    float dx = 0, dy = 0;
    if (!test::random_place(random, truth, kLeastRho, dx, dy)) continue;
    const double rho = test::exact_rho(truth, double{dx}, double{dy});
    found.ours.note(std::fabs(double{test::kernel_rho(k, dx, dy)} - rho), 0);
    found.textbook.note(std::fabs(double{text.rho(dx, dy)} - rho), 0);
  }
}

Comparison measure(Build build, double pixels, double ratio) {
  std::mt19937 random(7);
  Comparison found;
  for (int i = 0; i < kShapes; ++i)
    compare(random, test::random_footprint(random, build, pixels, ratio), found);
  return found;
}

// Rounding the axes of camera and Gaussian turns it by some ε, which moves it by some ε·d at a
// distance of d pixels: against the 0.55 pixels of the low-pass ρ, of which q is up to 2.4,
// changes by so much. Of a disc seen from its edge, the determinant gains (3.5 ε·σ)², and ρ
// 5.55 times its share of 0.3; another disc is wide beside ε·σ.
double rho_bound(Build build, double pixels) {
  const double low = std::sqrt(kLowPass), moved = std::min(pixels, test::kLargestImage) / low;
  if (build == Build::disc) return kEpsilon * std::min(50 * (1 + moved), 2000.0);
  const double thickened = build == Build::edge ? std::pow(kEpsilon * pixels / low, 2) : 0;
  return 50 * kEpsilon * (1 + moved) + 40 * thickened;
}
double determinant_bound(Build build, double pixels) {
  if (build == Build::disc) return 300 * kEpsilon;
  const double thickened = build == Build::edge ? std::pow(kEpsilon * pixels, 2) / kLowPass : 0;
  return 60 * kEpsilon + 12 * thickened;
}

void record(const std::string& name, const Comparison& c) {
  test::record(name + "_textbook_rho", c.textbook.rho);
  test::record(name + "_ours_rho", c.ours.rho);
  test::record(name + "_textbook_determinant", c.textbook.determinant);
  test::record(name + "_ours_determinant", c.ours.determinant);
  test::record(name + "_textbook_broken", c.broken);
}

const char* name_of(Build build) {
  return build == Build::needle ? "needle" : (build == Build::disc ? "disc" : "edge");
}

// σ from 1 to 10⁶ pixels, ratios to 10⁸: the condition number of Σ' is σ²/0.3.
TEST(Conic, RhoIsAsGoodAsTheAxesItIsMadeOf) {
  for (const Build build : {Build::needle, Build::disc, Build::edge})
    for (int decade = 0; decade <= 6; ++decade) {
      const double pixels = std::pow(10, decade);
      Comparison found;
      for (const double ratio : {1e1, 1e3, 1e5, 1e8}) found.take(measure(build, pixels, ratio));
      const std::string name = name_of(build) + std::string("_1e") + std::to_string(decade);
      EXPECT_LE(found.ours.rho, rho_bound(build, pixels)) << name;
      EXPECT_LE(found.ours.determinant, determinant_bound(build, pixels)) << name;
      record(name, found);
    }
}

// The thin axis drowns in the low-pass: from some ratio on nothing changes any more.
TEST(Conic, NoAxisRatioIsWorseThanAnother) {
  for (const Build build : {Build::needle, Build::edge})
    for (int decade = 0; decade <= 8; ++decade) {
      const Comparison found = measure(build, 1000, std::pow(10, decade));
      const std::string name = name_of(build) + std::string("_ratio_1e") + std::to_string(decade);
      EXPECT_LE(found.ours.rho, rho_bound(build, 1000)) << name;
      record(name, found);
    }
}

// Or the sweeps above could not tell.
TEST(Conic, TheTextbookLosesWhatOursKeeps) {
  for (const Build build : {Build::needle, Build::edge}) {
    const Comparison large = measure(build, 2000, 1e6), larger = measure(build, 1e4, 1e6);
    EXPECT_GT(large.textbook.rho, 1);
    EXPECT_LT(large.ours.rho, 0.005);
    EXPECT_GT(larger.broken, 0);
    EXPECT_LT(larger.ours.rho, 0.02);
    record(name_of(build) + std::string("_2000"), large);
  }
}

}  // namespace
}  // namespace voyager::conic_test
