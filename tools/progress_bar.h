#pragma once
#include <chrono>

#include "runtime/base/progress.h"

namespace voyager::tools {

// Shows what long work is doing, on standard error: on a terminal a bar from the first second on,
// which the next output takes the place of; in a log a plain line after two seconds, and one every
// ten seconds from then on. Nothing for shorter work, or with --quiet. A total of 0 is not known:
// the time that has passed is shown instead. A stage ends when all of it is done.
struct ProgressPace {
  std::chrono::milliseconds refresh{200}, first_bar{1000}, first_line{2000}, next_line{10000};
};
Progress progress_bar(ProgressPace pace = {});

}  // namespace voyager::tools
