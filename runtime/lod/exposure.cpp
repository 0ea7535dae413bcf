#include "runtime/lod/exposure.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "runtime/lod/stand_in.h"
#include "runtime/math/projection.h"
#include "runtime/math/sh.h"

namespace voyager {
namespace {

constexpr int kDirections = 12;
constexpr int kMostSide = 384;     // pixels
constexpr double kSideOfRoot = 4;  // pixels for the root of the Gaussians' number
// A Gaussian covers at most this many pixels on average; otherwise the picture is made smaller.
// Time is in proportion to what is covered, and Gaussians that large need no fine picture.
constexpr double kMeanCover = 1024;
constexpr int kLeastSide = 16;
constexpr double kOutside = 0.02;  // of the means, that may lie beyond the picture on a side
constexpr float kThreshold = 255;  // 1 / α*
constexpr float kLargest = 0.99f;  // α, METHOD §6
// T from which on what is behind is divided by it.
constexpr float kLeastBehind = 1e-4f;
constexpr double kContrastBeyond = 0.2;  // of what is beyond all pictures

// Viewers look from above and from the side: all directions but the last come from at least this
// high. It is the sine of the elevation; up is -y (docs/conventions.md). The last direction comes
// from below, so that a floor under a ceiling counts for something.
constexpr double kLowestRise = -0.05;

struct Direction {
  Vec3d forward, right, down;
};

// Even over the part of the sphere from kLowestRise up: a Fibonacci lattice.
Direction direction(int index) {
  constexpr int kAbove = kDirections - 1;
  const double golden = 2.399963229728653;  // π(3 − √5)
  const double rise =
      index < kAbove ? 1 - (1 - kLowestRise) * (index + 0.5) / kAbove : (kLowestRise - 1) / 2;
  const double level = std::sqrt(1 - rise * rise);
  const Vec3d f{-level * std::cos(golden * index), rise, -level * std::sin(golden * index)};
  const Vec3d across = std::fabs(f.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  const Vec3d c = cross(f, across);
  const Vec3d right = (1 / std::sqrt(dot(c, c))) * c;
  return {f, right, cross(f, right)};
}

// Pixels side by side. Most rows are short, so that what a compiler makes of a loop over pixels is
// mostly what is left over at its end.
constexpr int kLanes = 4;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

Lanes load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
void store(Lanes lanes, float* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

// e^(-d/2) to 0.04, enough to tell what hides what: it is cheap.
Lanes falloff(Lanes d) {
  const Lanes x = 1 - d * (1.0f / 16), x2 = x * x, x4 = x2 * x2;
  return x4 * x4;
}

class Exposures {
 public:
  Exposures(const GaussianCloud& cloud, const std::array<double, 3>& origin,
            std::span<const uint32_t> leaves)
      : seen_(leaves.size()),
        met_(leaves.size()),
        contrast_(leaves.size()),
        x_(leaves.size()),
        y_(leaves.size()),
        z_(leaves.size()),
        ellipses_(leaves.size()),
        most_side_(std::min(kMostSide,
                            static_cast<int>(std::ceil(
                                kSideOfRoot * std::sqrt(static_cast<double>(leaves.size())))))) {
    const size_t floats = size_t{3} * static_cast<size_t>(cloud.coefficients());
    for (const uint32_t leaf : leaves) {
      GaussianWords words = cloud.words(leaf);
      words.mean = local_mean(cloud, leaf, origin);
      blobs_.push_back(blob_of(activate(words, true)));
      reach_.push_back(2 * std::log(kThreshold * static_cast<float>(blobs_.back().opacity)));
      for (int k = 0; k < 3; ++k) {
        const float c = static_cast<float>(kSh0) * cloud.sh[leaf * floats + k] + 0.5f;
        colour_[k].push_back(std::clamp(c, 0.0f, 1.0f));
      }
    }
    for (int k = 0; k < 3; ++k)
      beyond_[k] = static_cast<float>(std::accumulate(colour_[k].begin(), colour_[k].end(), 0.0) /
                                      static_cast<double>(leaves.size()));
  }

  void run() {
    for (int i = 0; i < kDirections; ++i) look(direction(i));
  }

  ExposureCode code(size_t i) const {
    const double contrast =
        met_[i] > 0 ? contrast_[i] / (3 * met_[i]) : kContrastBeyond * kContrastBeyond;
    return {static_cast<uint8_t>(std::max(steps(seen_[i] / kDirections), kLeastSeen)),
            steps(contrast)};
  }

 private:
  static uint8_t steps(double square) {
    return static_cast<uint8_t>(std::clamp(std::floor(255 * std::sqrt(square) + 0.5), 0.0, 255.0));
  }

  void look(const Direction& along) {
    for (size_t i = 0; i < blobs_.size(); ++i) {
      x_[i] = dot(along.right, blobs_[i].mean);
      y_[i] = dot(along.down, blobs_[i].mean);
      z_[i] = dot(along.forward, blobs_[i].mean);
      ellipses_[i] = sharp_ellipse(blobs_[i], along);
    }
    const auto [x0, x1] = middle(x_);
    const auto [y0, y1] = middle(y_);
    const double side = std::max({x1 - x0, y1 - y0, 1e-6});
    set_side(side);
    left_ = (x0 + x1) / 2 - side / 2;
    top_ = (y0 + y1) / 2 - side / 2;
    order_.resize(blobs_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(),
              [&](uint32_t a, uint32_t b) { return z_[a] < z_[b] || (z_[a] == z_[b] && a < b); });
    begin_picture();
    for (const uint32_t i : order_) paint(i);
    end_picture();
    for (const uint32_t i : order_) measure(i);
  }

  // Into how many pixels a square of that width, in metres, is divided.
  void set_side(double width) {
    side_ = most_side_;
    pixel_ = width / side_;
    double covered = 0;
    for (size_t i = 0; i < blobs_.size(); ++i) {
      if (!(reach_[i] > 0)) continue;
      const Ellipse f = ellipse(i);
      const double most = side_;
      covered += std::min(2 * std::sqrt(reach_[i] * f.xx), most) *
                 std::min(2 * std::sqrt(reach_[i] * f.yy), most);
    }
    const double allowed = kMeanCover * static_cast<double>(blobs_.size());
    if (!(covered > allowed)) return;
    side_ = std::max(kLeastSide, static_cast<int>(side_ * std::sqrt(allowed / covered)));
    pixel_ = width / side_;
  }

  // Where all but kOutside of the values at each end are.
  std::pair<double, double> middle(const std::vector<double>& values) {
    sorted_ = values;
    const auto skipped = static_cast<std::ptrdiff_t>(kOutside * static_cast<double>(values.size()));
    const auto low = sorted_.begin() + skipped, high = sorted_.end() - 1 - skipped;
    std::nth_element(sorted_.begin(), low, sorted_.end());
    const double least = *low;
    std::nth_element(sorted_.begin(), high, sorted_.end());
    return {least, *high};
  }

  void begin_picture() {
    const size_t pixels = static_cast<size_t>(side_) * static_cast<size_t>(side_);
    transmittance_.assign(pixels + kLanes, 1.0f);
    for (std::vector<float>& plane : behind_) plane.assign(pixels + kLanes, 0.0f);
  }

  // Of what was painted, all is still behind what comes next.
  void end_picture() {
    for (int k = 0; k < 3; ++k)
      for (size_t i = 0; i < transmittance_.size(); ++i)
        behind_[k][i] += transmittance_[i] * beyond_[k];
    transmittance_.assign(transmittance_.size(), 1.0f);
  }

  void paint(uint32_t i) {
    const float r = colour_[0][i], g = colour_[1][i], b = colour_[2][i];
    cover(i, [&](size_t first, int count) {
      float* through = &transmittance_[first];
      float *red = &behind_[0][first], *green = &behind_[1][first], *blue = &behind_[2][first];
      for (int x = 0; x < count; x += kLanes) {
        const Lanes alpha = load(alpha_ + x), before = load(through + x), weight = alpha * before;
        store(load(red + x) + weight * r, red + x);
        store(load(green + x) + weight * g, green + x);
        store(load(blue + x) + weight * b, blue + x);
        store(before * (1 - alpha), through + x);
      }
    });
  }

  void measure(uint32_t i) {
    const float r = colour_[0][i], g = colour_[1][i], b = colour_[2][i];
    float covered = 0, seen = 0, contrast = 0;
    const bool inside = cover(i, [&](size_t first, int count) {
      float* through = &transmittance_[first];
      float *red = &behind_[0][first], *green = &behind_[1][first], *blue = &behind_[2][first];
      for (int x = 0; x < count; x += kLanes) {
        const Lanes alpha = load(alpha_ + x), before = load(through + x), weight = alpha * before,
                    after = before * (1 - alpha), all = Lanes{} + kLeastBehind,
                    least = after < all ? all : after;
        // The plane without this Gaussian, and how its colour differs from that.
        const auto difference = [&](float* plane, float colour) {
          const Lanes behind = load(plane + x) - weight * colour;
          store(behind, plane + x);
          return colour - behind / least;
        };
        const Lanes dr = difference(red, r), dg = difference(green, g), db = difference(blue, b);
        const Lanes square = (dr * dr + dg * dg) + db * db, most = Lanes{} + 3,
                    shown = weight * before, differs = shown * (most < square ? most : square);
        store(after, through + x);
        for (int k = 0; k < kLanes; ++k) {
          covered += alpha[k];
          seen += shown[k];
          contrast += differs[k];
        }
      }
    });
    if (!inside) seen_[i] += 1;  // beyond the picture: nothing is known to hide it
    if (!(covered > 0)) return;
    seen_[i] += seen / covered;
    met_[i] += seen / covered;
    contrast_[i] += contrast / covered;
  }

  // A Gaussian projected along a direction: its covariance across that.
  struct Ellipse {
    double xx, xy, yy;  // pixels², or metres²
  };
  // In metres², without a filter.
  static Ellipse sharp_ellipse(const Blob& blob, const Direction& along) {
    const auto across = [&](const Vec3d& a, const Vec3d& b) {
      const double* c = blob.covariance;
      const Vec3d cb{(c[0] * b.x + c[1] * b.y) + c[2] * b.z, (c[1] * b.x + c[3] * b.y) + c[4] * b.z,
                     (c[2] * b.x + c[4] * b.y) + c[5] * b.z};
      return dot(a, cb);
    };
    return {across(along.right, along.right), across(along.right, along.down),
            across(along.down, along.down)};
  }
  // In pixels², with 3DGS's low-pass, although the tree is fitted to METHOD §12's footprint and
  // filter. Here the footprint alone gained nothing. With the filter too, cuts of as many nodes
  // gained up to 0.2 dB in three views of a district, and lost as much in others and in a city
  // (bench/NOTES.md, "Exposure with the scene's own filter").
  Ellipse ellipse(size_t i) const {
    const double pixel = pixel_ * pixel_;
    const Ellipse& f = ellipses_[i];
    return {f.xx / pixel + kLowPass, f.xy / pixel, f.yy / pixel + kLowPass};
  }

  // Fills alpha_ for each row of pixels that a Gaussian covers, and calls row(first pixel, count).
  // count is of whole lanes: where those end behind the row alpha is 0. False where it covers none
  // of the picture.
  template <class Row>
  bool cover(uint32_t i, const Row& row) {
    const float reach = reach_[i];
    if (!(reach > 0)) return true;
    const auto [xx, xy, yy] = ellipse(i);
    const auto opacity = static_cast<float>(blobs_[i].opacity);
    const double det = std::max(xx * yy - xy * xy, 1e-14 * xx * yy);
    const double u = (x_[i] - left_) / pixel_, v = (y_[i] - top_) / pixel_;
    const int begin_x = first(u, std::sqrt(reach * xx)), end_x = last(u, std::sqrt(reach * xx));
    const int begin_y = first(v, std::sqrt(reach * yy)), end_y = last(v, std::sqrt(reach * yy));
    if (begin_x == end_x || begin_y == end_y) return false;
    const auto a = static_cast<float>(yy / det), b = static_cast<float>(-2 * xy / det),
               c = static_cast<float>(xx / det);
    const auto from = static_cast<float>(begin_x + 0.5 - u);
    const int width = end_x - begin_x;
    for (int y = begin_y; y < end_y; ++y) {
      const auto dy = static_cast<float>(y + 0.5 - v);
      const Lanes none{}, largest = none + kLargest;
      int count = 0;
      for (; count < width; count += kLanes) {
        Lanes x{0, 1, 2, 3};
        x += static_cast<float>(count);
        const Lanes dx = x + from;
        const Lanes d = (a * dx * dx + b * dx * dy) + c * dy * dy;
        const Lanes painted = opacity * falloff(d);
        const Lanes alpha = painted < largest ? painted : largest;
        const auto inside = (d < reach) & (x < static_cast<float>(width));
        store(inside ? alpha : none, alpha_ + count);
      }
      row(static_cast<size_t>(y) * static_cast<size_t>(side_) + static_cast<size_t>(begin_x),
          count);
    }
    return true;
  }

  int first(double centre, double reach) const {
    return static_cast<int>(
        std::clamp(std::floor(centre - reach), 0.0, static_cast<double>(side_)));
  }
  int last(double centre, double reach) const {
    return static_cast<int>(std::clamp(std::ceil(centre + reach), 0.0, static_cast<double>(side_)));
  }

  // By Gaussian.
  std::vector<Blob> blobs_;
  std::vector<float> reach_;  // of d, where alpha is the threshold; drawn where it is over 0
  std::vector<float> colour_[3];
  float beyond_[3];  // behind all of them: their mean
  // Sums over directions: of T², of it where the picture has the Gaussian, and there times a
  // square.
  std::vector<double> seen_, met_, contrast_;
  std::vector<double> x_, y_, z_, sorted_;
  std::vector<Ellipse> ellipses_;
  std::vector<uint32_t> order_;
  // By pixel, and lanes that are written with the last.
  std::vector<float> transmittance_;
  std::vector<float> behind_[3];  // the picture without what is before
  float alpha_[kMostSide + kLanes];
  int most_side_, side_ = 0;
  double pixel_ = 0, left_ = 0, top_ = 0;
};

}  // namespace

void find_exposure(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                   std::span<const uint32_t> leaves, std::span<ExposureCode> exposure) {
  Exposures exposures(cloud, origin, leaves);
  exposures.run();
  for (size_t i = 0; i < leaves.size(); ++i) exposure[leaves[i]] = exposures.code(i);
}

}  // namespace voyager
