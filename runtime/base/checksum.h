#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace voyager {

// XXH3, 64 bits, seed 0.
uint64_t checksum(std::span<const std::byte> bytes);

// The same of bytes that come one piece after the other.
class RunningChecksum {
 public:
  RunningChecksum();
  ~RunningChecksum();
  void add(std::span<const std::byte> bytes);
  uint64_t value() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace voyager
