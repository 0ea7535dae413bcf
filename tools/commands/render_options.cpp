#include <algorithm>
#include <string>
#include <vector>

#include "tools/commands/render_arguments.h"
#include "tools/options.h"

namespace voyager::tools {
namespace {

// "R,G,B"
void set_background(const std::string& text, float* background) {
  const std::vector<std::string> parts = CLI::detail::split(text, ',');
  const auto fits = [](const std::string& part) {
    const auto value = parse_number(part);
    return value && *value >= 0 && *value <= 1;
  };
  if (parts.size() != 3 || !std::all_of(parts.begin(), parts.end(), fits))
    throw CLI::ValidationError("--background", "found " + text +
                                                   ", expected R,G,B, three numbers from 0 to 1, "
                                                   "as 0.5,0.5,1");
  std::transform(parts.begin(), parts.end(), background,
                 [](const std::string& part) { return static_cast<float>(*parse_number(part)); });
}

void add_common(CLI::App& command, RenderArguments& arguments) {
  command
      .add_option("-o", arguments.outputs.image,
                  "Image to write, a .png (8-bit) or a .pfm (float). With --all or --stereo the "
                  "name of a folder")
      ->type_name("FILE")
      ->required();
  CLI::Option* cameras =
      command
          .add_option(
              "--cameras", arguments.cameras,
              "Cameras to render, as a cameras.json of 3DGS (INRIA). Without it one picture "
              "of the scene is rendered, from above at an angle")
          ->type_name("FILE");
  CLI::Option* one = add_camera_option(command, arguments.camera)->needs(cameras);
  command.add_flag("--all", arguments.all, "Render every camera of the file, as one walk")
      ->excludes(one)
      ->needs(cameras);
  add_size_option(command, arguments.size);
  add_choice<VoyBackend>(
      command, "--backend", arguments.choices.backend,
      {{"auto", VOY_BACKEND_AUTO},
       {"cpu", VOY_BACKEND_CPU},
       {"cuda", VOY_BACKEND_CUDA},
       {"reference", VOY_BACKEND_REFERENCE}},
      "What draws. auto is CUDA if there is a device for it, else the CPU; reference is exact "
      "(float64) and slow. `voyager devices` lists what this machine has");
  add_tau_or_budget_options(command, arguments.choices.tau, arguments.choices.time_budget);
  name_group(command, kCommonOptions);
}

void add_outputs(CLI::App& command, RenderArguments& arguments) {
  command.add_flag("--float", arguments.choices.floats,
                   "Write float images (.pfm), before colours are clamped");
  command
      .add_option("--depth", arguments.outputs.depth,
                  "Also write depth in metres, +inf where there is nothing: a .pfm, or a folder "
                  "where -o is one")
      ->type_name("FILE");
  command
      .add_option("--stats", arguments.outputs.stats,
                  "Also write counters and milliseconds of each frame: a .json")
      ->type_name("FILE");
  command
      .add_option("--dump-cut", arguments.outputs.cut,
                  "Also write the ids of the nodes that were drawn: a .txt, or a folder with --all")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--background",
          [&arguments](const std::string& text) {
            set_background(text, arguments.choices.background);
          },
          "Colour behind everything, each from 0 to 1")
      ->type_name("R,G,B")
      ->default_str("0,0,0");
  command
      .add_flag("--stereo", arguments.stereo,
                "Take the cameras two by two, left eye then right eye. Each pair is one view with "
                "one cut; with --camera I the pair is I and I + 1")
      ->needs(command.get_option("--cameras"));
  name_group(command, "Output");
}

void add_streaming(CLI::App& command, RenderArguments& arguments) {
  add_number_option(
      command, "--budget", arguments.choices.budget,
      [](double value) { return value >= 1e-6 && value <= 1e9; },
      "a number of MB above 0, from 1e-6 (a byte) to 1e9",
      "Keep at most so many MB (10^6 bytes) of a .voy in the memory of the device that draws; the "
      "rest is read as frames need it")
      ->type_name("MB");
  add_choice<std::optional<bool>>(
      command, "--wait-resident", arguments.wait_resident, {{"off", false}, {"on", true}},
      "on: a frame waits until all that it needs is read. off: it draws what is in memory, coarser "
      "where something is missing. Both values stream the scene");
  command.add_flag(
      "--keep-going", arguments.choices.keep_going,
      "Draw damaged parts of a .voy by their coarser ancestors in place of stopping "
      "there. The scene is streamed, and frames wait for it unless --wait-resident is off");
  name_group(command, "Streaming");
}

void add_detail(CLI::App& command, RenderArguments& arguments) {
  add_lod_options(command, arguments.lod);
  add_choice<VoySearch>(command, "--search", arguments.choices.experiment.search,
                        {{"auto", VOY_SEARCH_AUTO},
                         {"temporal", VOY_SEARCH_TEMPORAL},
                         {"sweep", VOY_SEARCH_SWEEP},
                         {"streaming", VOY_SEARCH_STREAMING},
                         {"exhaustive", VOY_SEARCH_EXHAUSTIVE}},
                        "How the nodes to draw are found. All find the same ones. auto: temporal, "
                        "or on a GPU a sweep of all nodes where that is faster");
  add_choice<bool>(command, "--slack", arguments.choices.slack, {{"on", true}, {"off", false}},
                   "off: the temporal search visits all of the last cut, for measurements");
  name_group(command, "Level of detail");
}

void add_splatting(CLI::App& command, RenderChoices& choices) {
  add_choice<VoyAlphaFilter>(command, "--filter", choices.experiment.alphaFilter,
                             {{"on", VOY_ALPHA_FILTER_ON}, {"off", VOY_ALPHA_FILTER_OFF}},
                             "The α-filter. off gives the same image, slower");
  add_choice<VoySplatting>(
      command, "--splat", choices.experiment.splatting,
      {{"ours", VOY_SPLATTING_OURS}, {"3dgs", VOY_SPLATTING_3DGS}},
      "How Gaussians become pixels. 3dgs is the baseline of measurements, on CUDA only");
  add_choice<VoyExponential>(
      command, "--exp", choices.experiment.exponential,
      {{"auto", VOY_EXPONENTIAL_AUTO},
       {"exact", VOY_EXPONENTIAL_EXACT},
       {"ex2", VOY_EXPONENTIAL_EX2},
       {"lut", VOY_EXPONENTIAL_LUT},
       {"half2", VOY_EXPONENTIAL_HALF2}},
      "How the exponential is computed. auto is ex2 on CUDA with --splat ours, else exact");
  add_choice<VoyAntialias>(command, "--antialias", choices.antialias,
                           {{"on", VOY_ANTIALIAS_ON}, {"off", VOY_ANTIALIAS_OFF}},
                           "off is the picture of 3DGS, in which what is smaller than a pixel "
                           "swells");
  add_whole_option(command, "--supersample", {1, 16}, choices.supersample,
                   "Draw so many samples a pixel along each axis and average them: the truth that "
                   "pictures are judged by (docs/method.md), of every leaf")
      ->type_name("S");
  add_whole_option(command, "--lut-size", {1, 4096}, choices.experiment.lutSize,
                   "Intervals of the table of --exp lut")
      ->default_str("32");
  name_group(command, "Splatting, for measurements");
}

}  // namespace

void add_render_options(CLI::App& command, RenderArguments& arguments) {
  command
      .add_option("scene", arguments.scene,
                  "Scene to draw, a .voy or a flat one of any format, or its URL")
      ->required();
  add_common(command, arguments);
  add_outputs(command, arguments);
  add_streaming(command, arguments);
  add_detail(command, arguments);
  add_splatting(command, arguments.choices);
}

}  // namespace voyager::tools
