#include "tools/metrics/flip_colour.h"

#include <algorithm>
#include <cmath>

namespace voyager::tools {
namespace {

using Matrix = std::array<Colour, 3>;

// XYZ over that of white, from linear sRGB: each row of the matrix from the chromaticities of
// ITU-R BT.709, in fractions, over its sum.
constexpr Matrix kFromRgb = {{{10135552. / 23359437, 8788810. / 23359437, 4435075. / 23359437},
                              {2613072. / 12288897, 8788810. / 12288897, 887015. / 12288897},
                              {1425312. / 80288307, 8788810. / 80288307, 70074185. / 80288307}}};

constexpr Matrix inverse(const Matrix& m) {
  Matrix cofactors = {};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) {
      const size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactors[j][i] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
    }
  const double determinant =
      m[0][0] * cofactors[0][0] + m[0][1] * cofactors[1][0] + m[0][2] * cofactors[2][0];
  for (Colour& row : cofactors)
    for (double& value : row) value /= determinant;
  return cofactors;
}

constexpr Matrix kToRgb = inverse(kFromRgb);

Colour times(const Matrix& m, const Colour& v) {
  Colour product;
  for (size_t i = 0; i < 3; ++i) product[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return product;
}

double linear(double code_value) {
  return code_value <= 0.04045 ? code_value / 12.92 : std::pow((code_value + 0.055) / 1.055, 2.4);
}

// CIELAB's cube root, straight near 0.
double lab_root(double value) {
  constexpr double limit = 6. / 29;
  return value > limit * limit * limit ? std::cbrt(value) : value / (3 * limit * limit) + 4. / 29;
}

// Of x, y and z, or of their roots.
Colour differences(const Colour& xyz) {
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

Colour hunt_lab_of_rgb(const Colour& rgb) {
  Colour xyz = times(kFromRgb, rgb);
  for (double& value : xyz) value = lab_root(value);
  const Colour lab = differences(xyz);
  return {lab[0], 0.01 * lab[0] * lab[1], 0.01 * lab[0] * lab[2]};
}

}  // namespace

Colour opponent(const Colour& code_values) {
  Colour rgb;
  for (size_t i = 0; i < 3; ++i) rgb[i] = linear(code_values[i]);
  return differences(times(kFromRgb, rgb));
}

double luminance(double opponent_y) {
  return (opponent_y + 16) / 116;
}

Colour hunt_lab(const Colour& opponent) {
  const double y = luminance(opponent[0]);
  Colour rgb = times(kToRgb, {y + opponent[1] / 500, y, y - opponent[2] / 200});
  for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
  return hunt_lab_of_rgb(rgb);
}

double hyab(const Colour& a, const Colour& b) {
  const double da = a[1] - b[1], db = a[2] - b[2];
  return std::fabs(a[0] - b[0]) + std::sqrt(da * da + db * db);
}

double largest_colour_distance() {
  static const double largest =
      std::pow(hyab(hunt_lab_of_rgb({0, 1, 0}), hunt_lab_of_rgb({0, 0, 1})), 0.7);
  return largest;
}

double colour_error(double distance) {
  constexpr double knee = 0.4, error_at_knee = 0.95;
  const double share = distance / largest_colour_distance();
  if (share < knee) return error_at_knee / knee * share;
  return std::min(1.0, error_at_knee + (share - knee) / (1 - knee) * (1 - error_at_knee));
}

}  // namespace voyager::tools
