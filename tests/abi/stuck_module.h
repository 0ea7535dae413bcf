#pragma once
// What stuck_module.cpp shows of itself.
#include <atomic>
#include <chrono>

inline constexpr std::chrono::milliseconds kStuckPatience{100};  // a fifth of what frames are given

struct StuckModule {
  std::atomic<bool> idle{true};  // no: frames in flight never end
  // Objects that live, and those that were destroyed beside a frame: CUDA would wait there,
  // without end.
  std::atomic<int> backends{0}, pipelines{0}, rings{0}, hangs{0};
};
inline constexpr char kStuckModuleSymbol[] = "voyager_stuck_module";
