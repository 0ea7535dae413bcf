// How many of an eye's tiles a thread block of bin counts at once.
#include "cuda/splat/bin_bands.h"

#include <gtest/gtest.h>

#include "cuda/device/shared_memory.h"

namespace voyager::cuda {
namespace bin_bands_test {
namespace {

// Of compute capability 8.7, and of 8.6 and 8.9, which have the least.
constexpr SharedMemory kOrin{164 << 10, 1 << 10, 163 << 10}, kLeast{100 << 10, 1 << 10, 99 << 10};
// The eye of a headset.
constexpr uint32_t kEyeTiles = 2064 / 16 * 2208 / 16;

TEST(BinBands, OrinCountsAnEyeOfAHeadsetAtOnce) {
  const BinBands bands = bin_bands(kEyeTiles, bytes_of_block(kOrin, kBinBlocks));
  EXPECT_EQ(bands.bands, 1u);
  EXPECT_EQ(bands.tiles, kEyeTiles);
}

// All tiles are in some band, no band is empty or larger than the memory, and the blocks that are
// to be resident together fit the multiprocessor.
TEST(BinBands, HoldAllTilesAndFitTheMemory) {
  for (const SharedMemory& memory : {kOrin, kLeast}) {
    const size_t bytes = bytes_of_block(memory, kBinBlocks);
    EXPECT_LE(kBinBlocks * (bytes + static_cast<size_t>(memory.reserved_of_block)),
              static_cast<size_t>(memory.of_multiprocessor));
    EXPECT_LE(bytes, static_cast<size_t>(memory.most_of_block));
    const auto most = static_cast<uint32_t>((bytes - kBinScratchBytes) / sizeof(uint32_t));
    for (const uint32_t tiles :
         {1u, 12'000u, most - 1, most, most + 1, kEyeTiles, 3 * most, 1u << 20}) {
      const BinBands bands = bin_bands(tiles, bytes);
      EXPECT_LE(bands.tiles, most);
      EXPECT_GE(bands.bands * bands.tiles, tiles);
      EXPECT_LT((bands.bands - 1) * bands.tiles, tiles);
    }
  }
}

// A multiprocessor's share may be more than one block may have.
TEST(BinBands, ABlockHasNoMoreThanItMay) {
  EXPECT_EQ(bytes_of_block(kOrin, 1), size_t{163} << 10);
}

}  // namespace
}  // namespace bin_bands_test
}  // namespace voyager::cuda
