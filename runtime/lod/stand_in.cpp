#include "runtime/lod/stand_in.h"

#include <algorithm>
#include <cmath>

#include "runtime/math/projection.h"

namespace voyager {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTolerance = 0.0045;  // code values × pixels, times 2τ + 1
constexpr double kExtentOfPixel = 2 * kReferenceTau + 1;
// The greatest opacity of a stand-in, times the root of the share that the pixel filter leaves of
// it. Where α would be above 1 it is clamped, so that the stand-in fills the gaps to its
// neighbours. Far above 1 the stand-in swells (bench/NOTES.md).
constexpr double kMostOpacity = 1.1;
// Code values; its square is added to that of the contrast that was found. The parent also covers
// places that no child covers, and the contrast to what is behind those was not measured.
constexpr double kUnknownContrast = 0.1;
constexpr int kRefinements = 4;
constexpr double kLargestPixel = 1e29;  // metres; an extent stays finite in binary32

// A Gaussian projected along an axis.
struct Ellipse {
  double u, v;        // centre
  double uu, uv, vv;  // covariance, blurred
  double determinant;
  double peak;  // that the blur leaves of 1
};

constexpr int kAxes = 3;
constexpr int kAcross[kAxes][2] = {{1, 2}, {0, 2}, {0, 1}};
constexpr int kCovarianceAt[kAxes][3] = {{3, 4, 5}, {0, 2, 5}, {0, 1, 3}};

double determinant(double uu, double uv, double vv) {
  // Of a disc seen from its side what is left by cancellation is noise of either sign.
  return std::max(uu * vv - uv * uv, 1e-14 * uu * vv);
}

void blur_by(double blur, Ellipse& f) {
  const double sharp = f.determinant;
  f.uu += blur;
  f.vv += blur;
  f.determinant = determinant(f.uu, f.uv, f.vv);
  f.peak *= std::sqrt(std::min(sharp / f.determinant, 1.0));
}

Ellipse sharp_ellipse(const Blob& blob, const Vec3d& centre, int axis, double own) {
  const int* at = kCovarianceAt[axis];
  const int u = kAcross[axis][0], v = kAcross[axis][1];
  Ellipse f{blob.mean[u] - centre[u],
            blob.mean[v] - centre[v],
            blob.covariance[at[0]] + own,
            blob.covariance[at[1]],
            blob.covariance[at[2]] + own,
            0,
            1};
  f.determinant = determinant(f.uu, f.uv, f.vv);
  return f;
}

// ∫ G_a G_b over the plane.
double overlap(const Ellipse& a, const Ellipse& b) {
  const double uu = a.uu + b.uu, uv = a.uv + b.uv, vv = a.vv + b.vv;
  const double sum = determinant(uu, uv, vv);
  const double u = a.u - b.u, v = a.v - b.v;
  const double distance = ((vv * u * u - 2 * uv * u * v) + uu * v * v) / sum;
  if (!(distance < 1000)) return 0;
  return 2 * kPi * a.peak * b.peak * std::sqrt(a.determinant / sum * b.determinant) *
         std::exp(-0.5 * distance);
}

// The same of a and itself.
double own_overlap(const Ellipse& a) {
  const double sum = determinant(2 * a.uu, 2 * a.uv, 2 * a.vv);
  if (!(sum > 0)) return 0;
  return 2 * kPi * a.peak * a.peak * std::sqrt(a.determinant / sum * a.determinant);
}

struct Error {
  double error;  // m², squared code values
  double opacity;
};

// What is lost if the parent is drawn in the place of its children, by the pixel's size.
class Loss {
 public:
  // The group outlives it.
  explicit Loss(const Group& group) : group_(group), count_(group.children.size()) {
    const double most = *std::max_element(group.seen, group.seen + count_);
    // What coverage differs by shows what is behind, wherever any of them is seen.
    lack_ =
        3 * most * most * (group.contrast * group.contrast + kUnknownContrast * kUnknownContrast);
    for (int axis = 0; axis < kAxes; ++axis) {
      const auto seen = [&](const Blob& blob) {
        return sharp_ellipse(blob, group.parent.mean, axis, group.footprint);
      };
      Sharp& sharp = sharp_[axis];
      sharp.parent = seen(group.parent);
      for (size_t i = 0; i < count_; ++i) sharp.child[i] = seen(group.children[i]);
      sharp_own_ += own_overlap(sharp.parent);
    }
  }

  Error at(double pixel) const {
    const double blur = group_.low_pass * pixel * pixel;
    double error = 0, own = 0, lacking = 0, added = 0;
    for (const Sharp& sharp : sharp_) {
      Sharp seen = sharp;
      blur_by(blur, seen.parent);
      for (size_t i = 0; i < count_; ++i) blur_by(blur, seen.child[i]);
      for (size_t i = 0; i < count_; ++i) {
        const double opacity = group_.children[i].opacity;
        added += opacity * overlap(seen.child[i], seen.parent);
        for (size_t j = i; j < count_; ++j) {
          const double both = i == j ? opacity * opacity * own_overlap(seen.child[i])
                                     : 2 * opacity * group_.children[j].opacity *
                                           overlap(seen.child[i], seen.child[j]);
          error += both * group_.seen[i] * group_.seen[j] * group_.colours[i][j];
          lacking += both;
        }
      }
      own += own_overlap(seen.parent);
    }
    if (!(own > 0)) return {0, 0};
    error += lack_ * lacking;
    const double best = added / own,
                 opacity = std::min(best, kMostOpacity * std::sqrt(sharp_own_ / own));
    // Least squares, and what is lost where the best would be more than all.
    const double off = best - opacity;
    return {std::max(error - lack_ * own * (best * best - off * off), 0.0) / kAxes, opacity};
  }

 private:
  struct Sharp {
    Ellipse parent, child[kChildren];
  };

  const Group& group_;
  const size_t count_;
  Sharp sharp_[kAxes];
  double lack_, sharp_own_ = 0;
};

}  // namespace

Blob blob_of(const Gaussian& gaussian) {
  const Moments m = moments({{MergeInput{gaussian, nullptr}}});
  Blob blob{m.mean, {}, gaussian.opacity};
  std::copy_n(m.covariance, 6, blob.covariance);
  return blob;
}

void set_colours(double first_share, double second_share, double squared_distance, Group& group) {
  group.colours[0][0] = second_share * second_share * squared_distance;
  group.colours[0][1] = -first_share * second_share * squared_distance;
  group.colours[1][1] = first_share * first_share * squared_distance;
}

void set_colours(std::span<const float* const> children, const float* parent, int coefficients,
                 Group& group) {
  for (size_t i = 0; i < children.size(); ++i)
    for (size_t j = i; j < children.size(); ++j) {
      double sum = 0;
      for (int k = 0; k < 3 * coefficients; ++k)
        sum += (double{children[i][k]} - parent[k]) * (double{children[j][k]} - parent[k]);
      group.colours[i][j] = sum / (4 * kPi);
    }
}

Exposure set_exposure(std::span<const Exposure> children, std::span<const double> weights,
                      Group& group) {
  for (size_t i = 0; i < children.size(); ++i) group.seen[i] = double{children[i].seen};
  const Exposure mean = mean_exposure(children, weights);
  group.contrast = double{mean.contrast};
  return mean;
}

double squared_colour_distance(const float* a, const float* b, int coefficients) {
  double sum = 0;
  for (int k = 0; k < 3 * coefficients; ++k) {
    const double d = double{a[k]} - b[k];
    sum += d * d;
  }
  return sum / (4 * kPi);
}

StandIn stand_in(const Group& group) {
  const double* c = group.parent.covariance;
  const double reach = std::sqrt(c[0] + c[3] + c[5]);
  const double spared = std::max<double>(1, static_cast<double>(group.children.size()) - 1);
  const double scale = 1 / (std::sqrt(spared) * kTolerance * kExtentOfPixel);
  const Loss loss(group);
  const auto loss_at = [&](double pixel) { return loss.at(std::max(pixel, 1e-4 * reach)); };
  const auto tolerated = [&](double pixel) {
    const double error = loss_at(pixel).error;
    return std::min(std::sqrt(error) * scale, kLargestPixel);
  };
  // A fixed point: what a pixel of that size leaves of the error asks for that size. Halving the
  // step keeps it from swinging, since a larger pixel leaves less.
  double pixel = tolerated(0);
  for (int i = 0; i < kRefinements; ++i) pixel = std::sqrt(pixel * tolerated(pixel));
  return {pixel, loss_at(pixel).opacity};
}

double extent_of(double pixel) {
  return kExtentOfPixel * pixel;
}

}  // namespace voyager
