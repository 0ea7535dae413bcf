#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "runtime/base/error.h"
#include "runtime/base/name_ending.h"
#include "tools/commands/commands.h"
#include "tools/commands/render_arguments.h"
#include "tools/console.h"
#include "tools/default_camera.h"
#include "tools/options.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

// Without a file: one that sees the scene.
std::vector<Camera> read_or_choose(const RenderArguments& arguments, const Progress& progress) {
  if (!arguments.cameras.empty()) return read_cameras(arguments.cameras);
  progress("choosing a camera", 0, 0);
  return {default_camera(arguments.scene)};
}

// Those of one frame, or of all.
std::vector<Camera> choose_cameras(const RenderArguments& arguments, const Progress& progress) {
  std::vector<Camera> cameras = read_or_choose(arguments, progress);
  const size_t eyes = arguments.choices.eyes;
  if (arguments.all) {
    require_pairs(arguments.stereo, cameras.size(), arguments.cameras);
  } else {
    cameras = camera_at(arguments.camera, eyes, cameras, arguments.cameras);
  }
  if (arguments.size.width != 0)
    for (Camera& camera : cameras)
      camera = camera.resized(arguments.size.width, arguments.size.height);
  return cameras;
}

bool is_file_name(const std::string& path) {
  return has_ending(path, ".png") || has_ending(path, ".pfm") || has_ending(path, ".txt");
}

void refuse_file_name(const std::string& option, const std::string& path, bool all) {
  if (is_file_name(path))
    bad_usage(fmt::format("{}: found {}, expected a folder with {}", option, path,
                          all ? "--all" : "--stereo"));
}

// Settles what the names of the outputs say: image format, or folders.
void settle_outputs(RenderArguments& arguments) {
  OutputPaths& outputs = arguments.outputs;
  require_distinct({outputs.image, outputs.depth, outputs.cut, outputs.stats},
                   {arguments.scene, arguments.cameras});
  outputs.images_in = arguments.all || arguments.stereo;
  // A pair has one cut.
  outputs.cuts_in = arguments.all || (arguments.stereo && !is_file_name(outputs.cut));
  arguments.choices.depth = !outputs.depth.empty();
  if (outputs.images_in) {
    refuse_file_name("-o", outputs.image, arguments.all);
    refuse_file_name("--depth", outputs.depth, arguments.all);
    if (arguments.all) refuse_file_name("--dump-cut", outputs.cut, true);
  } else {
    const bool floats = arguments.choices.floats;
    require_extension(
        floats ? "-o with --float" : "-o", outputs.image,
        floats ? std::vector<std::string>{".pfm"} : std::vector<std::string>{".png", ".pfm"});
    if (!outputs.depth.empty()) require_extension("--depth", outputs.depth, {".pfm"});
    arguments.choices.floats = has_ending(outputs.image, ".pfm");
  }
  outputs.floats = arguments.choices.floats;
}

// A scene is streamed where its memory is bounded, or what is damaged of it is to be stood in for.
void settle_streaming(RenderArguments& arguments) {
  RenderChoices& choices = arguments.choices;
  choices.streamed =
      choices.budget > 0 || choices.keep_going || arguments.wait_resident.has_value();
  choices.wait_resident = arguments.wait_resident.value_or(choices.keep_going);
}

// METHOD §12: every leaf, unless something else is asked for, antialiased, with the truth's α
// threshold.
void settle_truth(RenderArguments& arguments) {
  RenderChoices& choices = arguments.choices;
  if (!arguments.lod.given()) choices.lod = VOY_LOD_ALL_LEAVES;
  if (choices.lod != VOY_LOD_ALL_LEAVES)
    bad_usage("--supersample: found it with a cut, expected --lod off: the truth has every leaf");
  if (choices.antialias != VOY_ANTIALIAS_ON)
    bad_usage("--supersample: found it with --antialias off, expected on");
  if (choices.experiment.exponential == VOY_EXPONENTIAL_LUT ||
      choices.experiment.exponential == VOY_EXPONENTIAL_HALF2)
    bad_usage("--supersample: found it with --exp lut or half2, expected auto, exact or ex2");
  if (choices.depth) bad_usage("--supersample: found it with --depth, expected colours alone");
  choices.experiment.truth = 1;
}

void choose_detail(Lod lod, RenderChoices& choices) {
  if (lod == Lod::all_leaves) choices.lod = VOY_LOD_ALL_LEAVES;
  if (lod == Lod::blocks) choices.experiment.selection = VOY_SELECTION_BLOCKS;
  if (lod == Lod::levels) choices.experiment.selection = VOY_SELECTION_LEVELS;
}

// Once a frame was drawn, so that an error is the only line.
void describe(const RenderArguments& arguments, const Renderer& renderer, const Camera& camera) {
  renderer.describe();
  const double* p = camera.pose.position;
  if (arguments.cameras.empty())
    note(fmt::format("no --cameras: looking at the scene from {:.4g}, {:.4g}, {:.4g}, in {}x{}",
                     p[0], p[1], p[2], camera.width, camera.height));
}

void render(RenderArguments& arguments) {
  arguments.choices.eyes = arguments.stereo ? 2 : 1;
  choose_detail(arguments.lod.value(), arguments.choices);
  settle_outputs(arguments);
  settle_streaming(arguments);
  if (arguments.choices.supersample > 1) settle_truth(arguments);
  if (arguments.choices.time_budget > 0 && arguments.choices.lod == VOY_LOD_ALL_LEAVES)
    bad_usage(
        "--time-budget: found it with --lod off or --select flat, expected a cut: tau is what it "
        "changes");
  FrameFiles files(arguments.outputs, {arguments.scene, arguments.cameras});
  const Progress progress = progress_bar();
  const std::vector<Camera> cameras = choose_cameras(arguments, progress);
  const size_t eyes = arguments.choices.eyes;
  const size_t number =
      arguments.stereo && !arguments.all ? static_cast<size_t>(arguments.camera) : 0;
  files.expect(number, cameras, eyes);
  uint32_t width = 0, height = 0;
  for (const Camera& camera : cameras) {
    width = std::max(width, camera.width);
    height = std::max(height, camera.height);
  }
  if (uint64_t{std::max(width, height)} * arguments.choices.supersample > kLargestSide)
    bad_usage(
        fmt::format("--supersample: found {} with a picture of {}x{}, expected at most {} "
                    "samples along a side",
                    arguments.choices.supersample, width, height, kLargestSide));
  arguments.choices.start = cameras.front().pose.position;
  progress("opening", 0, 0);
  Renderer renderer(arguments.scene, arguments.choices, width, height);
  if (!renderer.has_tree()) arguments.lod.refuse_without_tree(arguments.scene);
  if (!arguments.outputs.cut.empty() && !renderer.draws_cut())
    bad_usage("--dump-cut: found a scene drawn without a cut, expected a .voy with --lod on");
  progress("rendering", 0, cameras.size() > eyes ? cameras.size() : 0);
  for (size_t i = 0; i < cameras.size(); i += eyes) {
    const auto frame = std::span(cameras).subspan(i, eyes);
    renderer.render(frame);
    files.write(number + i, frame, renderer);
    if (i == 0) describe(arguments, renderer, frame.front());
    progress("rendering", i + eyes, cameras.size());
  }
  files.finish(renderer);
  say(arguments.outputs.image + "\n");
}

}  // namespace

void add_render(CLI::App& app) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Render a scene to image files");
  add_render_options(*command, *arguments);
  command->footer(
      "Example: voyager render city.voy -o city.png\n"
      "Example: voyager render city.voy --cameras city.cameras.json --camera 0 --tau 3 -o "
      "city.png");
  command->callback([arguments] { render(*arguments); });
}

}  // namespace voyager::tools
