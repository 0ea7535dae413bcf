#include "tools/report/report.h"

#include <fmt/core.h>

#include "tools/commands/commands.h"
#include "tools/commands/measured_backend.h"
#include "tools/options.h"

namespace voyager::tools {
namespace {

struct Arguments {
  ReportRequest request;
  bool quick = false, full = false;
  BackendChoice backend;
};

// What the measurements depend on.
std::vector<std::string> words(const Arguments& arguments) {
  std::vector<std::string> found = {arguments.quick  ? "--quick"
                                    : arguments.full ? "--full"
                                                     : "standard"};
  if (arguments.request.size.width != 0)
    found.push_back(
        fmt::format("--size {}x{}", arguments.request.size.width, arguments.request.size.height));
  if (arguments.backend.multiprocessors != 0)
    found.push_back(fmt::format("--sms {}", arguments.backend.multiprocessors));
  return found;
}

}  // namespace

void add_report(CLI::App& app) {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value >= 0.01 && value <= 10000) return {};
    return "found " + text + ", expected a number of milliseconds from 0.01 to 10000";
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "report", "Measure error against run time, for this scene on this machine");
  command->add_option("scene", arguments->request.scene, "A .voy, .ply or .spz")->required();
  command->add_option("--cameras", arguments->request.cameras, "INRIA cameras.json, as one walk")
      ->required();
  command
      ->add_option("-o", arguments->request.output,
                   "The folder for report.html, report.csv, report.json and the plots. A report "
                   "that was ended goes on from there when it is run again")
      ->required();
  CLI::Option* quick = command->add_flag("--quick", arguments->quick, "Some configurations");
  command->add_flag("--full", arguments->full, "Many, each timed for longer")->excludes(quick);
  command
      ->add_option("--target", arguments->request.target,
                   "Milliseconds that a frame may take, for the recommendation (11.1: 90 Hz)")
      ->check(CLI::Validator(check, ""))
      ->type_name("MS");
  add_backend_options(*command, arguments->backend);
  add_size_option(*command, arguments->request.size);
  command->footer("Example: voyager report city.voy --cameras city.cameras.json -o report");
  command->callback([arguments] {
    ReportRequest& request = arguments->request;
    if (arguments->quick) request.extent = ReportExtent::quick;
    if (arguments->full) request.extent = ReportExtent::full;
    request.arguments = words(*arguments);
    make_report(request, *create_backend(arguments->backend));
  });
}

}  // namespace voyager::tools
