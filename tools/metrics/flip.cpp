#include "tools/metrics/flip.h"

#include <fmt/core.h>

#include <numeric>

#include "runtime/base/error.h"
#include "tools/metrics/flip_colour.h"
#include "tools/metrics/flip_filters.h"

namespace voyager::tools {
namespace {

using Planes = std::array<Plane, 3>;

template <class Function>
void transform(Planes& planes, const Function& function) {
  for (size_t i = 0; i < planes[0].values.size(); ++i) {
    const Colour colour = function({planes[0].values[i], planes[1].values[i], planes[2].values[i]});
    for (size_t k = 0; k < 3; ++k) planes[k].values[i] = colour[k];
  }
}

Plane blue_yellow(const Plane& plane, const FlipFilters& filters) {
  Plane mixed = filter(plane, filters.blue_yellow[0]);
  const Plane second = filter(plane, filters.blue_yellow[1]);
  const double share = filters.blue_yellow_share;
  for (size_t i = 0; i < mixed.values.size(); ++i)
    mixed.values[i] = share * mixed.values[i] + (1 - share) * second.values[i];
  return mixed;
}

// Length of the gradient, or of the two second derivatives.
Plane strength(const Plane& light, const Plane& smooth_rows, const FlipFilters& filters,
               const Kernel& derivative) {
  Plane length = filter_columns(filter_rows(light, derivative), filters.smooth);
  const Plane across = filter_columns(smooth_rows, derivative);
  for (size_t i = 0; i < length.values.size(); ++i)
    length.values[i] =
        std::sqrt(length.values[i] * length.values[i] + across.values[i] * across.values[i]);
  return length;
}

// What eyes make of an image.
struct Seen {
  Planes colours;       // CIELAB of what they resolve, chroma as Hunt saw it
  Plane edges, points;  // how strong each is there, 0 to √2
};

Seen seen(Planes planes, const FlipFilters& filters) {
  transform(planes, opponent);
  Plane light = planes[0];
  for (double& value : light.values) value = luminance(value);
  const Plane smooth_rows = filter_rows(light, filters.smooth);
  Seen seen;
  seen.edges = strength(light, smooth_rows, filters, filters.edge);
  seen.points = strength(light, smooth_rows, filters, filters.point);
  seen.colours = {filter(planes[0], filters.light), filter(planes[1], filters.red_green),
                  blue_yellow(planes[2], filters)};
  transform(seen.colours, hunt_lab);
  return seen;
}

double error_at(const Seen& a, const Seen& b, size_t i) {
  const auto colour = [i](const Planes& p) {
    return Colour{p[0].values[i], p[1].values[i], p[2].values[i]};
  };
  const double colours = colour_error(std::pow(hyab(colour(a.colours), colour(b.colours)), 0.7));
  const double features = std::max(std::fabs(a.edges.values[i] - b.edges.values[i]),
                                   std::fabs(a.points.values[i] - b.points.values[i]));
  return std::pow(colours, 1 - std::sqrt(features / std::numbers::sqrt2));
}

}  // namespace

Flip flip(const RgbaImage& image, const RgbaImage& expected, size_t width,
          double pixels_per_degree) {
  if (!(pixels_per_degree >= 1 && pixels_per_degree <= 1000))
    throw Error(
        ErrorCode::invalid_argument,
        fmt::format("FLIP: found {} pixels per degree, expected 1 to 1000", pixels_per_degree));
  ScreenPair pair = screen_pair(image, expected, width);
  const FlipFilters filters = flip_filters(pixels_per_degree);
  const Seen a = seen(std::move(pair.image), filters), b = seen(std::move(pair.expected), filters);
  Flip flip;
  flip.map.resize(image.size() / 4);
  for (size_t i = 0; i < flip.map.size(); ++i) flip.map[i] = static_cast<float>(error_at(a, b, i));
  for (const size_t pixel : pair.not_finite) flip.map[pixel] = 1;
  flip.mean =
      std::accumulate(flip.map.begin(), flip.map.end(), 0.0) / static_cast<double>(flip.map.size());
  return flip;
}

}  // namespace voyager::tools
