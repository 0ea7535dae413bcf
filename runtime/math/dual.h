#pragma once
// Forward-mode differentiation: a value and its derivatives by N inputs. A formula that is a
// template gives its gradient by being called with these, so that it is written once.
#include <cmath>

#include "runtime/math/host_device.h"

namespace voyager {

template <class T, int N>
struct Dual {
  T value;
  T by[N];

  Dual() = default;
  VOYAGER_HD Dual(T constant) : value(constant), by{} {}
  // The input of that index.
  VOYAGER_HD Dual(T input, int index) : value(input), by{} { by[index] = T(1); }
};

namespace detail {
// A function of `a` with this value and slope there.
template <class T, int N>
VOYAGER_HD Dual<T, N> chain(const Dual<T, N>& a, T value, T slope) {
  Dual<T, N> result(value);
  for (int i = 0; i < N; ++i) result.by[i] = slope * a.by[i];
  return result;
}
}  // namespace detail

template <class T, int N>
VOYAGER_HD Dual<T, N> operator+(const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> sum(a.value + b.value);
  for (int i = 0; i < N; ++i) sum.by[i] = a.by[i] + b.by[i];
  return sum;
}
template <class T, int N>
VOYAGER_HD Dual<T, N> operator-(const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> difference(a.value - b.value);
  for (int i = 0; i < N; ++i) difference.by[i] = a.by[i] - b.by[i];
  return difference;
}
template <class T, int N>
VOYAGER_HD Dual<T, N> operator*(const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> product(a.value * b.value);
  for (int i = 0; i < N; ++i) product.by[i] = a.value * b.by[i] + b.value * a.by[i];
  return product;
}
template <class T, int N>
VOYAGER_HD Dual<T, N> operator/(const Dual<T, N>& a, const Dual<T, N>& b) {
  const T inverse = T(1) / b.value;
  Dual<T, N> quotient(a.value * inverse);
  for (int i = 0; i < N; ++i) quotient.by[i] = (a.by[i] - quotient.value * b.by[i]) * inverse;
  return quotient;
}
template <class T, int N>
VOYAGER_HD Dual<T, N>& operator+=(Dual<T, N>& a, const Dual<T, N>& b) {
  return a = a + b;
}
template <class T, int N>
VOYAGER_HD bool operator<(const Dual<T, N>& a, const Dual<T, N>& b) {
  return a.value < b.value;
}
template <class T, int N>
VOYAGER_HD bool operator>(const Dual<T, N>& a, const Dual<T, N>& b) {
  return a.value > b.value;
}
template <class T, int N>
VOYAGER_HD Dual<T, N> sqrt(const Dual<T, N>& a) {
  const T root = std::sqrt(a.value);
  return detail::chain(a, root, T(0.5) / root);
}
template <class T, int N>
VOYAGER_HD Dual<T, N> log(const Dual<T, N>& a) {
  return detail::chain(a, std::log(a.value), T(1) / a.value);
}

}  // namespace voyager
