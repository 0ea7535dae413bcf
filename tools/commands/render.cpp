#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "runtime/base/error.h"
#include "tools/commands/commands.h"
#include "tools/frame_files.h"
#include "tools/lod_options.h"
#include "tools/options.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"
#include "tools/renderer.h"

namespace voyager::tools {
namespace {

struct Arguments {
  std::string scene, cameras;
  size_t camera = 0;
  bool all = false, stereo = false;
  ImageSize size;
  std::optional<bool> wait_resident;
  LodChoice lod;
  RenderChoices choices;
  OutputPaths outputs;
};

[[noreturn]] void bad_usage(const std::string& message) {
  throw Error(ErrorCode::invalid_argument, message);
}

// Those of one frame, or of all.
std::vector<Camera> choose_cameras(const Arguments& arguments) {
  std::vector<Camera> cameras = read_cameras(arguments.cameras);
  const size_t eyes = arguments.choices.eyes;
  if (arguments.all) {
    require_pairs(arguments.stereo, cameras.size(), arguments.cameras);
  } else {
    if (cameras.size() < eyes || arguments.camera > cameras.size() - eyes)
      bad_usage(fmt::format("--camera: found {}, expected at most {}{} ({} has {} cameras)",
                            arguments.camera, cameras.size() - std::min(eyes, cameras.size()),
                            arguments.stereo ? " with --stereo" : "", arguments.cameras,
                            cameras.size()));
    const auto first = cameras.begin() + static_cast<std::ptrdiff_t>(arguments.camera);
    cameras = {first, first + static_cast<std::ptrdiff_t>(eyes)};
  }
  if (arguments.size.width != 0)
    for (Camera& camera : cameras)
      camera = camera.resized(arguments.size.width, arguments.size.height);
  return cameras;
}

bool is_file_name(const std::string& path) {
  const auto extension = std::filesystem::path(path).extension();
  return extension == ".png" || extension == ".pfm" || extension == ".txt";
}

void refuse_file_name(const std::string& option, const std::string& path, bool all) {
  if (is_file_name(path))
    bad_usage(fmt::format("{}: found {}, expected a folder with {}", option, path,
                          all ? "--all" : "--stereo"));
}

// Settles what the names of the outputs say: image format, or folders.
void settle_outputs(Arguments& arguments) {
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
    arguments.choices.floats = std::filesystem::path(outputs.image).extension() == ".pfm";
  }
  outputs.floats = arguments.choices.floats;
}

// A scene is streamed where its memory is bounded, or what is damaged of it is to be stood in for.
void settle_streaming(Arguments& arguments) {
  RenderChoices& choices = arguments.choices;
  choices.streamed =
      choices.budget > 0 || choices.keep_going || arguments.wait_resident.has_value();
  choices.wait_resident = arguments.wait_resident.value_or(choices.keep_going);
}

VoyLod public_lod(Lod lod) {
  switch (lod) {
    case Lod::all_leaves:
      return VOY_LOD_ALL_LEAVES;
    case Lod::blocks:
      return VOY_LOD_BLOCKS;
    case Lod::levels:
      return VOY_LOD_LEVELS;
    case Lod::cut:
      break;
  }
  return VOY_LOD_CUT;
}

void render(Arguments& arguments) {
  arguments.choices.eyes = arguments.stereo ? 2 : 1;
  arguments.choices.lod = public_lod(arguments.lod.value());
  settle_outputs(arguments);
  settle_streaming(arguments);
  if (arguments.choices.time_budget > 0 && arguments.choices.lod == VOY_LOD_ALL_LEAVES)
    bad_usage(
        "--time-budget: found it with --lod off or --select flat, expected a cut: tau is what it "
        "changes");
  const std::vector<Camera> cameras = choose_cameras(arguments);
  uint32_t width = 0, height = 0;
  for (const Camera& camera : cameras) {
    width = std::max(width, camera.width);
    height = std::max(height, camera.height);
  }
  arguments.choices.start = cameras.front().pose.position;
  Renderer renderer(arguments.scene, arguments.choices, width, height);
  if (!renderer.has_tree()) arguments.lod.refuse_without_tree(arguments.scene);
  if (!arguments.outputs.cut.empty() && !renderer.draws_cut())
    bad_usage("--dump-cut: found a scene drawn without a cut, expected a .voy with --lod on");
  FrameFiles files(arguments.outputs);
  const Progress progress = progress_bar();
  const size_t eyes = arguments.choices.eyes;
  const size_t number = arguments.stereo && !arguments.all ? arguments.camera : 0;
  for (size_t i = 0; i < cameras.size(); i += eyes) {
    const auto frame = std::span(cameras).subspan(i, eyes);
    renderer.render(frame);
    files.write(number + i, frame, renderer);
    if (cameras.size() > eyes) progress("rendering", i + eyes, cameras.size());
  }
  files.finish(renderer);
  fmt::print("{}\n", arguments.outputs.image);
}

void add_cut_choices(CLI::App& command, LodChoice& lod, RenderChoices& choices) {
  add_lod_options(command, lod);
  add_tau_or_budget_options(command, choices.tau, choices.time_budget);
  add_choice<VoySearch>(command, "--search", choices.search,
                        {{"temporal", VOY_SEARCH_TEMPORAL},
                         {"streaming", VOY_SEARCH_STREAMING},
                         {"exhaustive", VOY_SEARCH_EXHAUSTIVE}},
                        "How the cut is found; all find the same");
  add_choice<bool>(command, "--slack", choices.slack, {{"on", true}, {"off", false}},
                   "off: the temporal search visits all of the last cut, for measurements");
}

void add_splat_choices(CLI::App& command, RenderChoices& choices) {
  add_choice<VoyAlphaFilter>(command, "--filter", choices.alpha_filter,
                             {{"on", VOY_ALPHA_FILTER_ON}, {"off", VOY_ALPHA_FILTER_OFF}},
                             "The α-filter; off gives the same image, slower");
  add_choice<VoySplatting>(
      command, "--splat", choices.splatting,
      {{"ours", VOY_SPLATTING_OURS}, {"3dgs", VOY_SPLATTING_3DGS}},
      "How Gaussians become pixels; 3dgs is the baseline of measurements, on CUDA only");
  add_choice<VoyExponential>(command, "--exp", choices.exponential,
                             {{"auto", VOY_EXPONENTIAL_AUTO},
                              {"exact", VOY_EXPONENTIAL_EXACT},
                              {"ex2", VOY_EXPONENTIAL_EX2},
                              {"lut", VOY_EXPONENTIAL_LUT},
                              {"half2", VOY_EXPONENTIAL_HALF2}},
                             "The exponential; auto is ex2 on CUDA with --splat ours, else exact");
  command.add_option("--lut-size", choices.lut_size, "Intervals of --exp lut")
      ->check(CLI::Range(1, 4096))
      ->type_name("M")
      ->capture_default_str();
}

void add_choices(CLI::App& command, LodChoice& lod, RenderChoices& choices) {
  add_choice<VoyBackend>(
      command, "--backend", choices.backend,
      {{"auto", VOY_BACKEND_AUTO},
       {"cpu", VOY_BACKEND_CPU},
       {"cuda", VOY_BACKEND_CUDA},
       {"reference", VOY_BACKEND_REFERENCE}},
      "Who renders; auto is CUDA where there is a device, else the CPU; reference is "
      "float64, slow, and judges the others");
  add_cut_choices(command, lod, choices);
  add_splat_choices(command, choices);
  command
      .add_option_function<std::vector<float>>(
          "--background",
          [&choices](const std::vector<float>& rgb) {
            std::copy_n(rgb.begin(), 3, choices.background);
          },
          "Code values behind everything, each 0 to 1")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(0.0f, 1.0f))
      ->type_name("R,G,B")
      ->default_str("0,0,0");
}

void add_streaming(CLI::App& command, Arguments& arguments) {
  command
      .add_option("--budget", arguments.choices.budget,
                  "Stream the scene: its data takes at most so many MB (10^6 bytes) of the memory "
                  "of the device that renders")
      ->check(CLI::Validator(
          [](const std::string& text) {
            const double found = std::strtod(text.c_str(), nullptr);
            return found > 0 && found <= 1e9 ? "" : "found " + text + ", expected up to 1e9 MB";
          },
          "MB"))
      ->type_name("MB");
  add_choice<std::optional<bool>>(
      command, "--wait-resident", arguments.wait_resident, {{"off", false}, {"on", true}},
      "Stream the scene; on: each frame waits for all that it sees; off: it draws what is there, "
      "coarser where something is missing");
  command.add_flag("--keep-going", arguments.choices.keep_going,
                   "Stream the scene, wait unless told not to, and draw what is damaged by its "
                   "ancestors");
}

void add_outputs(CLI::App& command, OutputPaths& outputs, bool& floats) {
  command
      .add_option("-o", outputs.image,
                  "out.png (8-bit), out.pfm (float), or a folder with --all or --stereo")
      ->required();
  command.add_flag("--float", floats, "Float images (.pfm), before clamping");
  command.add_option("--depth", outputs.depth,
                     "Also depth, d.pfm (or a folder, as -o): metres, +inf where none");
  command.add_option("--dump-cut", outputs.cut,
                     "Also the cut's node ids, cut.txt (or a folder with --all)");
  command.add_option("--stats", outputs.stats, "Also counters and times, stats.json");
}

}  // namespace

void add_render(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("render", "Render cameras of a scene to image files");
  command->add_option("scene", arguments->scene, "A .voy, .ply or .spz")->required();
  command->add_option("--cameras", arguments->cameras, "INRIA cameras.json")->required();
  CLI::Option* one = command->add_option("--camera", arguments->camera, "Index in the file")
                         ->capture_default_str();
  command->add_flag("--all", arguments->all, "Every camera, as one walk")->excludes(one);
  command->add_flag("--stereo", arguments->stereo,
                    "Cameras two by two, left then right, as the eyes of one view with one cut; "
                    "with --camera I, I and I + 1. Images are numbered by camera, cuts by pair");
  add_size_option(*command, arguments->size);
  add_choices(*command, arguments->lod, arguments->choices);
  add_streaming(*command, *arguments);
  add_outputs(*command, arguments->outputs, arguments->choices.floats);
  command->footer(
      "Example: voyager render city.voy --cameras city.cameras.json --camera 0 --tau 3 -o "
      "city.png");
  command->callback([arguments] { render(*arguments); });
}

}  // namespace voyager::tools
