#pragma once
// The 256 values that stand for many, each of which is then one byte.
#include <array>
#include <cstdint>
#include <vector>

namespace voyager::sog_export {

using Codebook = std::array<float, 256>;  // ascending

// By k-means in one dimension (Lloyd), from values as dense as the cube root of their number, which
// is the best density of many (Panter and Dite). The same for the same values, in whatever order.
// At least one, all finite.
Codebook codebook_of(std::vector<float> values);

// The nearest value's index.
uint8_t code_of(const Codebook& codebook, float value);

}  // namespace voyager::sog_export
