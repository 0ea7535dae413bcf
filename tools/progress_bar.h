#pragma once
#include "runtime/base/progress.h"

namespace voyager::tools {

// A bar on standard error where that is a terminal; otherwise a plain line at
// each quarter of each stage.
Progress progress_bar();

}  // namespace voyager::tools
