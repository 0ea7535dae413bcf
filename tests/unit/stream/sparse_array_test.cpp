#include "runtime/stream/sparse_array.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace voyager::sparse_array_test {
namespace {

TEST(SparseArray, HasWhatAnArrayOfTheSameCallsHas) {
  std::mt19937 random(1);
  for (const size_t size : {1u, 63u, 64u, 65u, 200u}) {
    SparseArray<uint8_t> sparse(size);
    std::vector<uint8_t> expected(size);
    for (int step = 0; step < 3000; ++step) {
      const size_t at = random() % size;
      // Mostly 0 in the second half, so that pages go.
      const auto value = static_cast<uint8_t>(random() % 10 < (step < 1500 ? 2 : 9) ? 0 : random());
      sparse.set(at, value);
      expected[at] = value;
      for (size_t i = 0; i < size; ++i) ASSERT_EQ(sparse[i], expected[i]) << step;
    }
  }
}

}  // namespace
}  // namespace voyager::sparse_array_test
