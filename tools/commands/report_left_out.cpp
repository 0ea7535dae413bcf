// `voyager report` in a build without cairo, which draws its plots: it says so.
#include "runtime/base/error.h"
#include "tools/commands/commands.h"

namespace voyager::tools {

void add_report(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("report", "Not in this build, because cairo was not found");
  command->allow_extras();
  command->callback([] {
    throw Error(ErrorCode::unsupported,
                "report: found a build without cairo, which draws its plots, expected one with it: "
                "install libcairo2-dev and pkg-config, and build again");
  });
}

}  // namespace voyager::tools
