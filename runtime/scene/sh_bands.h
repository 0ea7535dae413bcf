#pragma once
// SH bands that are zero in every Gaussian add ±0 to sums that are never -0 when they count, so
// that colours are the same to the bit without them: they are left out (docs/omissions.md).
#include <span>

#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

// The highest band in which some coefficient is not ±0, from 0 to degree. sh: [k][rgb] of any
// number of Gaussians, sh_coefficients(degree) * 3 each.
int used_sh_degree(std::span<const float> sh, int degree);
// The same where -0 counts as used: for what is to come back to the bit.
int stored_sh_degree(std::span<const float> sh, int degree);

// Lowers or raises the degree of coefficients; new bands are +0.
void change_sh_degree(std::vector<float>& sh, int from, int to);
void change_sh_degree(std::pmr::vector<float>& sh, int from, int to);

// Leaves out the bands above the highest that is used. A band between used ones stays.
void leave_out_zero_bands(GaussianCloud& cloud);
// The opposite, for what is written as the input was.
void put_back_zero_bands(GaussianCloud& cloud);

}  // namespace voyager
