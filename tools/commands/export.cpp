#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "runtime/base/error.h"
#include "runtime/format/export_hier.h"
#include "runtime/format/export_ply.h"
#include "runtime/format/reader.h"
#include "tools/commands/commands.h"
#include "tools/cut_export.h"
#include "tools/options.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

struct Arguments {
  std::string scene, output, cameras;
  size_t camera = 0;
  ImageSize size;
  double tau = 3;
};

Camera choose_camera(const Arguments& arguments) {
  const auto cameras = read_cameras(arguments.cameras);
  if (arguments.camera >= cameras.size())
    throw Error(
        ErrorCode::invalid_argument,
        fmt::format("--camera: found {}, expected at most {} ({} has {} cameras)", arguments.camera,
                    cameras.size() - 1, arguments.cameras, cameras.size()));
  const Camera& camera = cameras[arguments.camera];
  return arguments.size.width == 0 ? camera
                                   : camera.resized(arguments.size.width, arguments.size.height);
}

void export_scene(const Arguments& arguments) {
  const auto extension = std::filesystem::path(arguments.output).extension();
  if (!arguments.cameras.empty()) {
    if (extension != ".ply")
      throw Error(ErrorCode::invalid_argument, "--cut-camera: expected -o to end in .ply");
    export_cut(arguments.scene, choose_camera(arguments), arguments.tau, arguments.output);
  } else if (extension == ".hier") {
    export_hier(SceneFile(open_file_source(arguments.scene)), arguments.output, progress_bar());
  } else if (extension == ".ply") {
    export_ply(SceneFile(open_file_source(arguments.scene)), arguments.output, progress_bar());
  } else {
    throw Error(
        ErrorCode::invalid_argument,
        fmt::format("-o: found {}, expected a name that ends in .hier or .ply", arguments.output));
  }
  fmt::print("{}\n", arguments.output);
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("export", "Write a .voy's tree or Gaussians for other tools");
  command->add_option("scene", arguments->scene, "A scene.voy")->required();
  command
      ->add_option("-o", arguments->output,
                   "out.hier: the tree, in HierarchicalGS's layout; out.ply: the leaves, in the "
                   "input's order")
      ->required();
  CLI::Option* cameras =
      command->add_option("--cut-camera", arguments->cameras,
                          "cameras.json: write one camera's interpolated cut to out.ply instead");
  command->add_option("--camera", arguments->camera, "Index of the camera in it")
      ->needs(cameras)
      ->capture_default_str();
  add_size_option(*command, arguments->size);
  add_tau_option(*command, arguments->tau);
  command->footer("Example: voyager export city.voy -o city.hier");
  command->callback([arguments] { export_scene(*arguments); });
}

}  // namespace voyager::tools
