#pragma once
// Bisection of integers.

namespace voyager {

// The least of [least, most] for which it holds, as it does for all greater ones; `most` is not
// asked.
template <class Integer, class Holds>
Integer first_that(Integer least, Integer most, const Holds& holds) {
  while (least < most) {
    const Integer middle = least + (most - least) / 2;
    if (holds(middle))
      most = middle;
    else
      least = middle + 1;
  }
  return least;
}

}  // namespace voyager
