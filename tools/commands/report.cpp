#include "tools/report/report.h"

#include <fmt/core.h>

#include "tools/commands/commands.h"
#include "tools/commands/measured_backend.h"
#include "tools/options.h"
#include "tools/report/curve.h"

namespace voyager::tools {
namespace {

struct ReportArguments {
  ReportRequest request;
  bool quick = false, full = false, curve = false;
  std::vector<std::string> trees;  // beside the scene's
  BackendChoice backend;
};

// What the measurements depend on.
std::vector<std::string> words(const ReportArguments& arguments) {
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

void run(ReportArguments& arguments) {
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
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand(
      "report", "Measure image error against run time on this machine, and recommend options");
  command
      ->add_option("scene", arguments->request.scene,
                   "Scene to measure, a .voy or a flat one of any format, or its URL")
      ->required();
  command
      ->add_option("--cameras", arguments->request.cameras,
                   "Cameras of the path, as a cameras.json of 3DGS (INRIA)")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("-o", arguments->request.output,
                   "Folder for report.html, report.csv, report.json and the plots. A report "
                   "that was stopped goes on from there when it is run again")
      ->type_name("DIR")
      ->required();
  CLI::Option* quick = command->add_flag("--quick", arguments->quick, "Measure few configurations");
  command->add_flag("--full", arguments->full, "Measure many configurations, each for longer")
      ->excludes(quick);
  CLI::Option* target = add_number_option(
                            *command, "--target", arguments->request.target,
                            [](double value) { return value >= 0.01 && value <= 10000; },
                            "a number of milliseconds from 0.01 to 10000",
                            "Milliseconds that a frame may take, for the recommendation")
                            ->type_name("MS")
                            ->default_str("11.1, which is 90 frames a second");
  add_backend_options(*command, arguments->backend);
  add_size_option(*command, arguments->request.size);
  name_group(*command, kCommonOptions);
  CLI::Option* curve =
      command
          ->add_flag("--curve", arguments->curve,
                     "Measure only what cuts of 90 % to 10 % of the leaves look like against the "
                     "truth, and what they cost. Writes curve.html, curve.csv, curve.json and "
                     "plots")
          ->excludes(target);
  command
      ->add_option("--trees", arguments->trees,
                   "Other trees of the same scene, for --curve; each is compared with the last")
      ->type_name("FILE ...")
      ->needs(curve);
  name_group(*command, "The curve of a tree");
  command->footer("Example: voyager report city.voy --cameras city.cameras.json -o report");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace voyager::tools
