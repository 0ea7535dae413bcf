#pragma once
// The colours of FLIP (flip.h), relative to the white of sRGB, D65.
#include <array>

namespace voyager::tools {

using Colour = std::array<double, 3>;

// YyCxCz of sRGB code values in [0, 1]: CIELAB without its cube roots, so that it may be filtered.
// White is (100, 0, 0).
Colour opponent(const Colour& code_values);
// Luminance, 0 to 1, of the first of its components.
double luminance(double opponent_y);

// CIELAB of a colour in YyCxCz, clamped to what sRGB can show, its chroma scaled by L*/100 as Hunt
// saw it.
Colour hunt_lab(const Colour& opponent);

// |ΔL| + √(Δa² + Δb²), of large differences.
double hyab(const Colour& a, const Colour& b);

// HyAB^0.7 of green against blue, the largest of two colours that sRGB can show.
double largest_colour_distance();

// HyAB^0.7 as an error from 0 to 1: up to 0.4 of the largest linearly to 0.95, the rest to 1.
double colour_error(double distance);

}  // namespace voyager::tools
