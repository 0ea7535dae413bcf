#pragma once
// Positions whose steps are finest near the world's origin, as SOG codes them: sign(x) ln(|x| + 1).
#include <cmath>

namespace voyager {

inline double signed_log(double x) {
  return std::copysign(std::log1p(std::fabs(x)), x);
}
// Its inverse.
inline double signed_exp(double v) {
  return std::copysign(std::expm1(std::fabs(v)), v);
}

}  // namespace voyager
