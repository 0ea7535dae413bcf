#pragma once
#include "tools/view/view_options.h"

namespace voyager::view {

// Opens the window, until it is closed, its script ends, or SIGINT or SIGTERM comes. Throws
// voyager::Error and voy::Error as the library does for what it cannot begin with, host::Failure
// for a machine without a display or without Vulkan; at the end of a script voyager::Error for what
// was refused.
void run_viewer(const ViewOptions& options);

}  // namespace voyager::view
