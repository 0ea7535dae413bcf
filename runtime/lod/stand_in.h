#pragma once
// What is lost where one Gaussian is drawn for several. The error is that of their pictures,
// with the footprint and the pixel filter of the renderer (METHOD §12), along the three axes of the
// scene.
#include <algorithm>
#include <span>

#include "runtime/lod/exposure.h"
#include "runtime/lod/merge.h"
#include "runtime/lod/shape.h"

namespace voyager {

// A Gaussian without its colour.
struct Blob {
  Vec3d mean;
  double covariance[6];  // xx, xy, xz, yy, yz, zz
  double opacity;
};
Blob blob_of(const Gaussian& gaussian);

// Children, the one that stands in for them (whose opacity is not read), and for each two
// children the product of their colours' differences to its colour, a mean over directions.
struct Group {
  std::span<const Blob> children;  // at most kChildren
  Blob parent;
  double colours[kChildren][kChildren];
  double seen[kChildren];  // Exposure, of each child
  double contrast;         // Exposure, of all
  double footprint;        // METHOD §12's, metres²
  double low_pass;         // of the pixel filter, pixels²
};

// Of two children with these shares of their parent's colour: from the square of the distance
// between their colours.
void set_colours(double first_share, double second_share, double squared_distance, Group& group);
// Of any: from coefficients * 3 floats each.
void set_colours(std::span<const float* const> children, const float* parent, int coefficients,
                 Group& group);
// From that of each child; returns their mean with these weights.
Exposure set_exposure(std::span<const Exposure> children, std::span<const double> weights,
                      Group& group);
// ∫ (a − b)² over directions, a mean of it: SH basis functions are orthonormal.
double squared_colour_distance(const float* a, const float* b, int coefficients);

struct StandIn {
  double pixel;    // metres: the side of a pixel from which on the stand-in is good enough
  double opacity;  // the best at that size: the least squares' of coverage
};

// Good enough: an error of 0.0045·(2·kReferenceTau + 1) code values × pixels, root of the squares,
// for each Gaussian that is spared. Finite and ≥ 0 for finite input. Deterministic; thread-safe.
StandIn stand_in(const Group& group);

// The extent of a node with that stand-in: at kReferenceTau its size is τ* where a pixel is
// StandIn::pixel wide (METHOD §3).
inline constexpr double kReferenceTau = 3;  // the default
double extent_of(double pixel);

}  // namespace voyager
