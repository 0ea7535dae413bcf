#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace voyager {

// XXH3, 64 bits, seed 0.
uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace voyager
