#pragma once
// What is asked of each device once.
#include <array>
#include <atomic>
#include <cstddef>

namespace voyager::cuda {

// A host may draw on several devices, of which each has its own answer. Any thread.
template <class T>
class PerDevice {
 public:
  // The device's answer; ask() finds it, of a thread whose device it is. An answer of T{} is asked
  // for again.
  template <class Ask>
  T of(int device, const Ask& ask) {
    const auto index = static_cast<size_t>(device);
    if (index >= kKnownDevices) return ask();
    if (const T known = known_[index].load(std::memory_order_relaxed); known != T{}) return known;
    const T answer = ask();
    known_[index].store(answer, std::memory_order_relaxed);
    return answer;
  }

 private:
  static constexpr size_t kKnownDevices = 32;

  std::array<std::atomic<T>, kKnownDevices> known_{};
};

}  // namespace voyager::cuda
