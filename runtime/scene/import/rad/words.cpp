#include "runtime/scene/import/rad/words.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/math/byte_code.h"
#include "runtime/math/half.h"
#include "runtime/scene/import/load.h"

namespace voyager::rad {
namespace {

// Number k of Gaussian i is element k * count + i.
class Numbers {
 public:
  Numbers(const Property& property, std::span<const std::byte> planes, size_t count)
      : property_(property),
        bytes_(planes.data()),
        stride_(count * numbers_of(property.kind)),
        count_(count) {}

  float operator()(size_t i, size_t k) const {
    const size_t at = k * count_ + i;
    switch (property_.encoding) {
      case Encoding::f32:
        return load<float>(bytes_ + 4 * at);
      case Encoding::f32_lebytes:
        return std::bit_cast<float>(from_planes(at, 4));
      case Encoding::f16_lebytes:
        return half_to_float(static_cast<uint16_t>(from_planes(at, 2)));
      case Encoding::f16:
      case Encoding::ln_f16:
        return half_to_float(load<uint16_t>(bytes_ + 2 * at));
      case Encoding::r8:
      case Encoding::r8_delta:
        return between(property_.min, property_.max, code(at), 255);
      case Encoding::s8:
      case Encoding::s8_delta:
        return property_.max * load<int8_t>(bytes_ + at) / 127.0f;
      case Encoding::ln_0r8:
        return code(at) == 0 ? -INFINITY : between(property_.min, property_.max, code(at) - 1, 254);
      case Encoding::oct88r8:
      case Encoding::u16:
      case Encoding::u32:
        break;
    }
    return 0;
  }

 private:
  uint32_t code(size_t at) const { return std::to_integer<uint32_t>(bytes_[at]); }
  uint32_t from_planes(size_t at, uint32_t planes) const {
    uint32_t word = 0;
    for (uint32_t b = 0; b < planes; ++b) word |= code(b * stride_ + at) << 8 * b;
    return word;
  }

  const Property& property_;
  const std::byte* bytes_;
  size_t stride_, count_;
};

// A logarithm of a scale of 0 is infinite.
float log_scale_of(const Property& property, float number) {
  if (property.encoding == Encoding::f32) return log_of_scale(number);
  return number == -INFINITY ? log_of_scale(0.0f) : number;
}

void decode_rotations(const Property& property, std::span<const std::byte> planes,
                      const Numbers& numbers, GaussianCloud& cloud) {
  for (size_t i = 0; i < cloud.size(); ++i) {
    float* wxyz = &cloud.rotation[4 * i];
    if (property.encoding == Encoding::oct88r8) {
      const auto code = [&](size_t k) { return std::to_integer<uint32_t>(planes[3 * i + k]); };
      const std::array<float, 4> q = rotation_of_oct88r8(code(0), code(1), code(2));
      std::copy_n(q.begin(), 4, wxyz);
      continue;
    }
    for (size_t k = 0; k < 3; ++k) wxyz[1 + k] = numbers(i, k);
    complete_unit(wxyz, 0);
  }
}

void decode_sh(size_t first, const Numbers& numbers, size_t values, GaussianCloud& cloud) {
  const auto width = static_cast<size_t>(cloud.coefficients()) * 3;
  for (size_t i = 0; i < cloud.size(); ++i)
    for (size_t k = 0; k < values; ++k) cloud.sh[i * width + first + k] = numbers(i, k);
}

void decode_colours(const Numbers& numbers, GaussianCloud& cloud) {
  const auto width = static_cast<size_t>(cloud.coefficients()) * 3;
  for (size_t i = 0; i < cloud.size(); ++i)
    for (size_t k = 0; k < 3; ++k) cloud.sh[i * width + k] = sh_of_colour(double{numbers(i, k)});
}

}  // namespace

void decode_property(const Property& property, std::span<const std::byte> planes,
                     GaussianCloud& cloud) {
  const size_t count = cloud.size();
  const Numbers numbers(property, planes, count);
  switch (property.kind) {
    case Kind::center:
      for (size_t i = 0; i < 3 * count; ++i) cloud.position[i] = numbers(i / 3, i % 3);
      return;
    case Kind::alpha:
      for (size_t i = 0; i < count; ++i) cloud.opacity[i] = logit_of_opacity(double{numbers(i, 0)});
      return;
    case Kind::rgb:
      return decode_colours(numbers, cloud);
    case Kind::scales:
      for (size_t i = 0; i < 3 * count; ++i)
        cloud.log_scale[i] = log_scale_of(property, numbers(i / 3, i % 3));
      return;
    case Kind::orientation:
      return decode_rotations(property, planes, numbers, cloud);
    // Three numbers for each of the bands' 1, 3, 5 and 7 coefficients.
    case Kind::sh1:
      return decode_sh(3, numbers, 9, cloud);
    case Kind::sh2:
      return decode_sh(12, numbers, 15, cloud);
    case Kind::sh3:
      return decode_sh(27, numbers, 21, cloud);
    case Kind::child_count:
    case Kind::child_start:
      return;
  }
}

}  // namespace voyager::rad
