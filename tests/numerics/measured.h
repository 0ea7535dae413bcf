#pragma once
// What the sweeps share: the unit that errors are told in, and how measured values are kept.
#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace voyager::test {

inline constexpr double kEpsilon = 0x1p-24;  // half a unit in the last place of 1, binary32

// Into the test's report (--gtest_output), for the tables of docs/numerics.md.
inline void record(const std::string& name, double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  testing::Test::RecordProperty(name, text.str());
}

}  // namespace voyager::test
