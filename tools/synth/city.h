#pragma once
// A made-up city as Gaussians, of any size: streets, façades, roofs, trees.
// INRIA axes (x right, y down, z forward), metres, ground at y = 0.
//
// Everything follows from the description by integer arithmetic and +, -, *, /
// and square roots in binary64, which IEEE 754 rounds alike everywhere (built
// without contraction, as all of Voyager): same description, same bytes.
//
// Shapes follow a drone-captured district of 777,299 Gaussians; quartiles
// (25 %, 50 %, 75 %) there and in a made-up city of 1,000,000:
//                         captured              made up
//   opacity               0.51  0.81  0.98      0.49  0.83  0.98
//   longest axis, m       0.31  0.57  1.06      0.25  0.35  0.54   (denser: seen from the street)
//   longest / middle      1.8   2.7   5.4       1.3   1.7   2.4
//   longest / shortest    5     14    356       5.5   16    70     (99 %: 6e4 and 1e5)
//   SH bands 1, 2, 3, rms 0.08  0.09  0.10      0.13  0.05  0.05   (glass shines; less noise)
#include <cstdint>
#include <functional>
#include <string>

#include "runtime/base/progress.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager::synth {

struct CityDesc {
  uint64_t gaussians = 1'000'000;  // 1 to 2^40; about 40,000 a block, from 2 x 2 to 64 x 64 blocks
  uint64_t seed = 1;
  int sh_degree = 3;  // 0 to 3; a lower degree leaves coefficients out and changes nothing else
};

// Calls emit with clouds of at most 65,536 Gaussians, desc.gaussians in all;
// the cloud is the caller's to read until emit returns. Memory: one such batch
// and the layout (a few kilobytes a block). Single-threaded; what emit throws
// passes through. Throws Error(invalid_argument) for a description out of range.
void generate_city(const CityDesc& desc, const std::function<void(const GaussianCloud&)>& emit,
                   const Progress& progress = {});

// No position has a coordinate beyond this, metres: for writers with fixed-point
// positions. Below 2048 for every description.
float largest_coordinate(const CityDesc& desc);

// cameras.json as INRIA writes it: 60 poses of a walk (walk_000 to walk_059, eye
// 1.7 m above the ground, half a metre apart, turning at a crossing), then 60 of
// a flight over the roofs (flight_000 to flight_059).
std::string city_cameras_json(const CityDesc& desc);

// The same of a face against a wall: 60 poses (closeup_000 to closeup_059), 30 from the middle of a
// road until the eye is 0.3 m from the wall of a house, 30 along it at that distance, 0.2 m apart.
std::string city_close_up_json(const CityDesc& desc);

}  // namespace voyager::synth
