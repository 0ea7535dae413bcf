#include "runtime/scene/export/compressed_ply_chunk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/math/byte_code.h"
#include "runtime/scene/export/unit_code.h"

namespace voyager::compressed_ply {
namespace {

using Triple = std::array<float, 3>;

Triple world_position(const GaussianCloud& cloud, size_t i) {
  Triple world;
  for (size_t k = 0; k < 3; ++k)
    world[k] = static_cast<float>(cloud.origin[k] + static_cast<double>(cloud.position[3 * i + k]));
  return world;
}

Triple log_scale(const GaussianCloud& cloud, size_t i) {
  return {cloud.log_scale[3 * i], cloud.log_scale[3 * i + 1], cloud.log_scale[3 * i + 2]};
}

Triple colour(const GaussianCloud& cloud, size_t i) {
  const float* f_dc = &cloud.sh[i * static_cast<size_t>(cloud.coefficients()) * 3];
  return {flat_colour(f_dc[0]), flat_colour(f_dc[1]), flat_colour(f_dc[2])};
}

template <class Value>
Range range_of(const GaussianCloud& cloud, std::span<const uint32_t> indices, const Value& value) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Range range{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const uint32_t i : indices) {
    const Triple v = value(cloud, i);
    for (size_t k = 0; k < 3; ++k) {
      range.least[k] = std::min(range.least[k], v[k]);
      range.most[k] = std::max(range.most[k], v[k]);
    }
  }
  return range;
}

// In double: a range between binary32 values may be beyond binary32.
uint32_t code_in(const Range& range, size_t axis, float value, int bits) {
  const double least = double{range.least[axis]}, width = double{range.most[axis]} - least;
  return width > 0 ? unit_code(static_cast<float>((double{value} - least) / width), bits) : 0;
}

uint32_t code_11_10_11(const Range& range, const Triple& v) {
  return code_in(range, 0, v[0], 11) << 21 | code_in(range, 1, v[1], 10) << 11 |
         code_in(range, 2, v[2], 11);
}

uint32_t colour_code(const Range& range, const Triple& v, float opacity) {
  return code_in(range, 0, v[0], 8) << 24 | code_in(range, 1, v[1], 8) << 16 |
         code_in(range, 2, v[2], 8) << 8 | unit_code(opacity, 8);
}

uint32_t rotation_code(const Quatf& any_length) {
  const Quatf unit = normalise(any_length);
  const SmallestThree three = smallest_three({unit.w, unit.x, unit.y, unit.z});
  auto code = static_cast<uint32_t>(three.largest);
  for (const float other : three.others)
    code = code << 10 | unit_code(0.5f + other / (2 * kSqrtHalf), 10);
  return code;
}

}  // namespace

Chunk encode_chunk(const GaussianCloud& cloud, std::span<const uint32_t> indices) {
  Chunk chunk;
  chunk.bounds = {range_of(cloud, indices, world_position), range_of(cloud, indices, log_scale),
                  range_of(cloud, indices, colour)};
  chunk.vertices.reserve(indices.size());
  for (const uint32_t i : indices)
    chunk.vertices.push_back(
        {code_11_10_11(chunk.bounds.position, world_position(cloud, i)),
         rotation_code(cloud.words(i).rotation),
         code_11_10_11(chunk.bounds.log_scale, log_scale(cloud, i)),
         colour_code(chunk.bounds.colour, colour(cloud, i), sigmoid(cloud.opacity[i]))});
  return chunk;
}

uint8_t sh_code(float coefficient) {
  const float steps = (coefficient / 8.0f + 0.5f) * 256.0f;
  return static_cast<uint8_t>(std::fmin(std::fmax(steps, 0.0f), 255.0f));
}

}  // namespace voyager::compressed_ply
