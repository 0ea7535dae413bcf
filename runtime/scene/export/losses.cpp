// What formats have no place for, in words.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "runtime/math/signed_log.h"
#include "runtime/scene/export/flat_file.h"
#include "runtime/scene/export/value_range.h"

namespace voyager {
namespace {

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", value);
  return text;
}

std::string place(const std::array<double, 3>& at) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.0f, %.0f, %.0f) m", at[0], at[1], at[2]);
  return text;
}

// Of a coordinate in binary32.
double step_at(float at) {
  return double{std::nextafter(at, std::numeric_limits<float>::infinity())} - double{at};
}

// Of a .sog the largest: 16 bits of sign(x) ln(|x| + 1) between the bounds.
double sog_step(const FlatContents& contents) {
  double largest = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double least = contents.least[axis], most = contents.most[axis];
    largest = std::max(largest, (signed_log(most) - signed_log(least)) / 65535 *
                                    (1 + std::max(std::fabs(least), std::fabs(most))));
  }
  return largest;
}
constexpr double kCoarse = 0.01;  // metres

std::string coarse_spz(float reach, const std::string& origin) {
  const int bits = spz_fractional_bits(reach);
  if (bits >= spz_fractional_bits(0)) return "";
  return "positions are in steps of " + metres(std::ldexp(1.0, -bits)) + ": one is " +
         metres(double{reach}) + " from " + origin;
}

// Positions of the world, where the scene is far from the world's origin.
std::string coarse_positions(FlatFormat format, const FlatContents& contents,
                             const FlatOptions& options) {
  const bool in_binary32 = format == FlatFormat::splat || format == FlatFormat::compressed_ply ||
                           format == FlatFormat::sog;
  if (in_binary32 && contents.is_moved())
    return "positions are in steps of " + metres(step_at(contents.reach())) + ": they are " +
           metres(contents.largest_coordinate) + " from the world's origin";
  if (format == FlatFormat::sog && sog_step(contents) > kCoarse)
    return "positions are in steps of up to " + metres(sog_step(contents)) +
           " where they are farthest from the world's origin";
  if (format == FlatFormat::spz) return coarse_spz(contents.reach(), "the world's origin");
  if (format == FlatFormat::glb && options.spz_inside)
    return coarse_spz(contents.reach_from_origin(),
                      "the scene's origin, " + place(contents.origin));
  return "";
}

bool has_spz(FlatFormat format, const FlatOptions& options) {
  return format == FlatFormat::spz || (format == FlatFormat::glb && options.spz_inside);
}

std::string lost_filter(FlatFormat format, const NativeScale& native, const FlatOptions& options) {
  if (!native.antialiased()) return "";
  const bool spz = has_spz(format, options);
  if (format == FlatFormat::splat || (format == FlatFormat::glb && !spz))
    return "the format cannot say that the scene was trained with a compensated (antialiasing) "
           "filter: left out";
  if ((spz || format == FlatFormat::sog) && native.low_pass == kMipSplattingLowPass)
    return "the format cannot say that the filter of the training is Mip-Splatting's: it is read "
           "as 3DGS's";
  return "";
}

std::string clamped_values(uint64_t clamped, uint64_t count, const ValueRange& range) {
  if (clamped == 0) return "";
  return "values outside of the format's range are clamped, in " + std::to_string(clamped) +
         " of " + std::to_string(count) + " Gaussians: it holds " + range.words;
}

std::string clamped_values(FlatFormat format, const FlatContents& contents,
                           const FlatOptions& options) {
  const ClampedCounts& clamped = contents.clamped;
  if (has_spz(format, options)) return clamped_values(clamped.spz, contents.count, kSpzRange);
  if (format == FlatFormat::splat)
    return clamped_values(clamped.splat, contents.count, kSplatRange);
  if (format == FlatFormat::compressed_ply)
    return clamped_values(clamped.compressed_ply, contents.count, kCompressedPlyRange);
  return "";
}

}  // namespace

// Only a tree has one; inputs of a conversion do not.
std::string lost_native_pixel(const NativeScale& native) {
  if (!(native.pixel > 0)) return "";
  return "the format has no place for the native pixel, " + metres(native.pixel) +
         ": a bake of this file estimates it, unless --native-pixel is given";
}

std::vector<std::string> losses(FlatFormat format, const FlatContents& contents,
                                const FlatOptions& options) {
  std::vector<std::string> lost;
  if (format == FlatFormat::splat && contents.sh_degree > 0)
    lost.push_back("the format has no spherical harmonics of degree 1 and more: left out");
  for (const std::string& text :
       {lost_filter(format, contents.native, options), lost_native_pixel(contents.native),
        coarse_positions(format, contents, options), clamped_values(format, contents, options)})
    if (!text.empty()) lost.push_back(text);
  return lost;
}

}  // namespace voyager
