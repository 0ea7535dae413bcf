#include "runtime/scene/import/spz_decode.h"

#include <algorithm>
#include <cmath>

#include "runtime/math/byte_code.h"
#include "runtime/math/half.h"
#include "runtime/scene/import/load.h"

namespace voyager::spz {
namespace {

using Code = std::span<const std::byte>;  // of an attribute of one Gaussian
using Wxyz = std::span<float, 4>;

void decode_position(const Header& header, Code code, std::span<float, 3> position) {
  const HalfTurn& to_inria = header.to_inria;
  const float step = std::ldexp(1.0f, -header.fractional_bits);  // products with it are exact
  for (size_t axis = 0; axis < 3; ++axis) {
    if (header.version == 1) {
      const float half = half_to_float(load<uint16_t>(&code[2 * axis]));
      position[axis] = to_inria.turned(half, axis);
    } else {
      const Code three = code.subspan(3 * axis, 3);
      const int bits = integer(three[0]) | integer(three[1]) << 8 | integer(three[2]) << 16;
      const int fixed = bits >= 1 << 23 ? bits - (1 << 24) : bits;
      position[axis] = static_cast<float>(to_inria.turned(fixed, axis)) * step;
    }
  }
}

// x, y, z in bytes; w is what is left of a unit quaternion.
void decode_rotation_bytes(Code code, Wxyz wxyz) {
  for (size_t i = 0; i < 3; ++i) wxyz[1 + i] = static_cast<float>(integer(code[i])) / 127.5f - 1.0f;
  complete_unit(wxyz.data(), 0);
}

void decode_rotation_smallest_three(Code code, Wxyz wxyz) {
  auto bits = load<uint32_t>(code.data());
  SmallestThree three{static_cast<int>(bits >> 30), {}};
  for (size_t i = 3; i-- > 0; bits >>= 10) {
    const float magnitude = static_cast<float>(bits & 511u) / kRotationSteps * kSqrtHalf;
    three.others[i] = bits & 512u ? -magnitude : magnitude;
  }
  const std::array<float, 4> xyzw = quaternion_of(three);
  wxyz[0] = xyzw[3];
  std::copy_n(xyzw.begin(), 3, wxyz.begin() + 1);
}

void decode_rotation(const Header& header, Code code, Wxyz wxyz) {
  header.version < 3 ? decode_rotation_bytes(code, wxyz)
                     : decode_rotation_smallest_three(code, wxyz);
  for (size_t axis = 0; axis < 3; ++axis)
    wxyz[1 + axis] = header.to_inria.turned(wxyz[1 + axis], axis);
}

void decode_gaussian(const Header& header, Attribute attribute, Code code, size_t i,
                     GaussianCloud& cloud) {
  const size_t coefficients = static_cast<size_t>(cloud.coefficients());
  switch (attribute) {
    case kPositions:
      return decode_position(header, code, std::span<float, 3>(&cloud.position[3 * i], 3));
    case kAlphas:
      cloud.opacity[i] = logit_of_byte(integer(code[0]));
      return;
    case kColours:
      for (size_t k = 0; k < 3; ++k)
        cloud.sh[i * coefficients * 3 + k] =
            (static_cast<float>(integer(code[k])) / 255.0f - 0.5f) / kColourScale;
      return;
    case kScales:
      for (size_t k = 0; k < 3; ++k)
        cloud.log_scale[3 * i + k] = static_cast<float>(integer(code[k])) / 16.0f - 10.0f;
      return;
    case kRotations:
      return decode_rotation(header, code, Wxyz(&cloud.rotation[4 * i], 4));
    default:
      for (size_t k = 1; k < coefficients; ++k)
        for (size_t channel = 0; channel < 3; ++channel)
          cloud.sh[(i * coefficients + k) * 3 + channel] =
              static_cast<float>((integer(code[3 * (k - 1) + channel]) - 128) *
                                 header.to_inria.sh[k]) /
              128.0f;
  }
}

}  // namespace

void decode(const Header& header, Attribute attribute, std::span<const std::byte> codes,
            size_t first, GaussianCloud& cloud) {
  const size_t step = header.bytes_of(attribute);
  for (size_t i = 0; i < codes.size() / step; ++i)
    decode_gaussian(header, attribute, codes.subspan(i * step, step), first + i, cloud);
}

}  // namespace voyager::spz
