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

// The same of [0, most], sought from `near` outwards: in as many steps as the logarithm of how far
// it is from there.
template <class Integer, class Holds>
Integer first_near(Integer near, Integer most, const Holds& holds) {
  Integer low = near < most ? near : most;
  for (Integer step = 1; low > 0 && holds(low - 1); step *= 2) low -= step < low ? step : low;
  Integer high = low;
  for (Integer step = 1; high < most && !holds(high); step *= 2)
    high += step < most - high ? step : most - high;
  return first_that(low, high, holds);
}

}  // namespace voyager
