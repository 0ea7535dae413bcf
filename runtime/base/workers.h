#pragma once
// The threads of one device: a oneTBB arena. Bodies run under the default
// floating-point mode. Work is split by `grain` alone, never by the number of
// threads, so a result that depends on the split is the same everywhere.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

#include "runtime/base/floating_point_mode.h"
#include "runtime/base/thread_sanitizer.h"

namespace voyager {

// A loop over blocks, for the threads that take part in it.
template <class Body>
struct Loop {
  const Body& body;
  size_t n, grain;
  LoopOrder order;

  void run(size_t block) {
    order.begin_task();
    {
      const FloatingPointMode mode;
      body(block * grain, std::min(n, (block + 1) * grain));
    }
    order.end_task();
  }
};

class Workers {
 public:
  // At most as many as the machine has, which is also what 0 means: oneTBB has no
  // more to give, and says so on standard error when asked.
  explicit Workers(unsigned threads = 0)
      : arena_(threads == 0 ? tbb::task_arena::automatic
                            : std::min(static_cast<int>(std::min(threads, 1u << 16)),
                                       tbb::this_task_arena::max_concurrency())) {}

  int count() { return arena_.max_concurrency(); }

  // body(begin, end) over [0, n) in blocks of exactly `grain` (the last may be shorter).
  template <class Body>
  void for_blocks(size_t n, size_t grain, const Body& body) {
    if (n == 0) return;
    const size_t blocks = (n + grain - 1) / grain;
    if (blocks == 1) {
      const FloatingPointMode mode;
      body(size_t{0}, n);
      return;
    }
    Loop<Body> loop{body, n, grain, {}};
    arena_.execute([&loop, blocks] {
      tbb::parallel_for(size_t{0}, blocks, [own = &loop](size_t block) { own->run(block); });
    });
  }

  // `less` must be a strict total order, so that the result is unique.
  template <class Iterator, class Less>
  void sort(Iterator first, Iterator last, const Less& less) {
    arena_.execute([&] { tbb::parallel_sort(first, last, less); });
  }

  // Runs `work` inside the arena; for code that uses oneTBB's algorithms itself.
  template <class Work>
  void run(const Work& work) {
    arena_.execute(work);
  }

 private:
  tbb::task_arena arena_;
};

}  // namespace voyager
