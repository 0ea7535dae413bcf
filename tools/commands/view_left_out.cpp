// `voyager view` in a build without a window: it says so.
#include "runtime/base/error.h"
#include "tools/commands/commands.h"

namespace voyager::tools {

void add_view(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("view", "Not in this build, because what a window needs was not found");
  command->allow_extras();
  command->callback([] {
    throw Error(
        ErrorCode::unsupported,
        "view: found a build without a window, expected one with it: install libvulkan-dev, "
        "libglfw3-dev, libimgui-dev, libglm-dev and libstb-dev, and build again");
  });
}

}  // namespace voyager::tools
