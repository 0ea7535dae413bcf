#include "tools/report/report.h"

#include <fmt/core.h>

#include "tools/commands/commands.h"
#include "tools/commands/measured_backend.h"
#include "tools/options.h"
#include "tools/report/curve.h"

namespace voyager::tools {
namespace {

struct Arguments {
  ReportRequest request;
  bool quick = false, full = false, curve = false;
  std::vector<std::string> trees;  // beside the scene's
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
  if (arguments.curve) found.emplace_back("--curve");
  return found;
}

void run(Arguments& arguments) {
  ReportRequest& request = arguments.request;
  if (arguments.quick) request.extent = ReportExtent::quick;
  if (arguments.full) request.extent = ReportExtent::full;
  request.arguments = words(arguments);
  const std::unique_ptr<Backend> backend = create_backend(arguments.backend);
  if (!arguments.curve) return make_report(request, *backend);
  CurveRequest curve{{request.scene}, request.cameras, request.output,
                     request.extent,  request.size,    request.arguments};
  curve.trees.insert(curve.trees.end(), arguments.trees.begin(), arguments.trees.end());
  make_curve(curve, *backend);
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
  CLI::Option* target =
      command
          ->add_option("--target", arguments->request.target,
                       "Milliseconds that a frame may take, for the recommendation (11.1: 90 Hz)")
          ->check(CLI::Validator(check, ""))
          ->type_name("MS");
  CLI::Option* curve =
      command
          ->add_flag("--curve", arguments->curve,
                     "Only this: what cuts of 90 % to 10 % of a tree's leaves look like against "
                     "all leaves, and cost; --quick and --full choose how many views. Leaves "
                     "curve.html, curve.csv, curve.json and plots")
          ->excludes(target);
  command
      ->add_option("--trees", arguments->trees,
                   "With --curve: other trees of the same scene; the last is what the others are "
                   "compared with on standard output")
      ->type_name("FILE")
      ->needs(curve);
  add_backend_options(*command, arguments->backend);
  add_size_option(*command, arguments->request.size);
  command->footer("Example: voyager report city.voy --cameras city.cameras.json -o report");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace voyager::tools
