#pragma once
#include <tbb/partitioner.h>

#include <atomic>
#include <mutex>
#include <vector>

#include "runtime/base/progress.h"
#include "runtime/base/workers.h"

namespace voyager {

// body(cell) for each, `at_once` of them at a time and no more: threads that are left
// over help inside. After the first that throws, no other is begun. Progress counts cells.
template <class Body>
void for_cells(const std::vector<uint32_t>& cells, size_t at_once, Workers& workers,
               const Progress& progress, const char* stage, const Body& body) {
  std::atomic<size_t> next{0};
  std::mutex mutex;
  size_t done = 0;
  report(progress, stage, 0, cells.size());
  const auto lane = [&](size_t) {
    const FloatingPointMode mode;
    for (size_t i = next++; i < cells.size(); i = next++) {
      try {
        // A thread that waits inside one cell must not begin another.
        tbb::this_task_arena::isolate([&] { body(cells[i]); });
      } catch (...) {
        next = cells.size();
        throw;
      }
      const std::lock_guard lock(mutex);
      report(progress, stage, ++done, cells.size());
    }
  };
  workers.run([&] { tbb::parallel_for(size_t{0}, at_once, lane, tbb::simple_partitioner()); });
}

}  // namespace voyager
