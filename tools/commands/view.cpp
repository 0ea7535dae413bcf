#include <memory>

#include "tools/commands/commands.h"
#include "tools/view/view_options.h"
#include "tools/view/viewer.h"

namespace voyager::tools {

void add_view(CLI::App& app) {
  auto options = std::make_shared<view::ViewOptions>();
  CLI::App* command = app.add_subcommand("view", "Look at a scene in a window");
  view::add_view_options(*command, *options);
  command->footer("Example: voyager view city.voy --budget 500");
  command->callback([options] { view::run_viewer(*options); });
}

}  // namespace voyager::tools
