#pragma once
// Long work reports here. Called from one thread at a time.
#include <cstdint>
#include <functional>

namespace voyager {

// stage: a short phrase ("reading", "building"); done of total in the stage's own units.
using Progress = std::function<void(const char* stage, uint64_t done, uint64_t total)>;

inline void report(const Progress& progress, const char* stage, uint64_t done, uint64_t total) {
  if (progress) progress(stage, done, total);
}

}  // namespace voyager
