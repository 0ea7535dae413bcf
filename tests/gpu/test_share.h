#pragma once
// Tools that watch every access of a device take a thousand times as long. VOYAGER_TEST_SHARE=0.1
// has clouds, trees and paths a tenth as large. Properties hold for those, too; what a test says of
// its own numbers (that some frame had many of something) may not.
#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace voyager::test {

// Never below 24, or below `whole` if that is less.
inline size_t share_of(size_t whole) {
  static const char* const text = std::getenv("VOYAGER_TEST_SHARE");
  if (text == nullptr) return whole;
  const double share = std::clamp(std::atof(text), 0.0, 1.0);
  return std::max(static_cast<size_t>(share * static_cast<double>(whole)),
                  std::min(whole, size_t{24}));
}
inline int share_of(int whole) {
  return static_cast<int>(share_of(static_cast<size_t>(whole)));
}
inline uint32_t share_of(uint32_t whole) {
  return static_cast<uint32_t>(share_of(size_t{whole}));
}

}  // namespace voyager::test
