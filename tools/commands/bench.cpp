#include <CLI/CLI.hpp>
#include <memory>

#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "tools/close_up.h"
#include "tools/commands/bench_arguments.h"
#include "tools/commands/commands.h"
#include "tools/console.h"
#include "tools/options.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

// It is whole frames of one configuration that a budget is for.
void refuse_misplaced_budget(const BenchArguments& arguments) {
  if (arguments.stages != BenchStages::all)
    bad_usage("--time-budget: found it with --stages search or splat, expected --stages all");
  if (!draws_cut(arguments.lod.value()))
    bad_usage(
        "--time-budget: found it with --lod off or --select flat, expected a cut: tau is what it "
        "changes");
}

// An option that the chosen stages make nothing of would be a figure misread.
void refuse_misplaced(const BenchArguments& arguments) {
  const bool frames = arguments.stages != BenchStages::search;
  const std::pair<const char*, bool> of_frames[] = {
      {"--lod", arguments.lod.on.has_value()},      {"--select", arguments.lod.select.has_value()},
      {"--filter", arguments.filter.has_value()},   {"--splat", arguments.splatting.has_value()},
      {"--exp", arguments.exponential.has_value()}, {"--lut-size", arguments.lut_size.has_value()},
      {"--repeat", arguments.repeat.has_value()}};
  for (const auto& [option, given] : of_frames)
    if (given && !frames)
      bad_usage(std::string(option) +
                ": found it with --stages search, expected --stages splat or all");
  if (arguments.time_budget > 0) refuse_misplaced_budget(arguments);
  if (arguments.verify && frames)
    bad_usage("--verify: found it with whole frames, expected --stages search");
  if (arguments.stereo && arguments.stages != BenchStages::all)
    bad_usage("--stereo: found it with a part of the frame, expected --stages all");
}

std::vector<Camera> read_walk(const BenchArguments& arguments) {
  std::vector<Camera> cameras = read_cameras(arguments.cameras);
  require_pairs(arguments.stereo, cameras.size(), arguments.cameras);
  if (arguments.size.width != 0)
    for (Camera& camera : cameras)
      camera = camera.resized(arguments.size.width, arguments.size.height);
  return cameras;
}

std::shared_ptr<const Scene> load(const std::string& path, Workers& workers) {
  const Progress progress = progress_bar();
  progress("opening", 0, 0);
  return load_scene(open_source(path), std::pmr::get_default_resource(), workers);
}

// In place of the cameras, from the first of them on.
void walk_close_up(const BenchArguments& arguments, BenchSubject& subject) {
  constexpr size_t kSteps = 60;
  const std::span<const Camera> start(subject.cameras.data(), arguments.stereo ? 2 : 1);
  subject.cameras =
      close_up_cameras({subject.backend, subject.scene, subject.workers}, start, kSteps);
  if (subject.cameras.empty())
    throw Error(ErrorCode::refused_input, arguments.cameras +
                                              ": found nothing in front of its first camera, "
                                              "expected a surface with --close-up");
}

void bench(BenchArguments& arguments) {
  const bool whole = arguments.stereo || arguments.time_budget > 0;
  arguments.stages =
      arguments.stages_asked.value_or(whole ? BenchStages::all : BenchStages::search);
  refuse_misplaced(arguments);
  require_extension("--json", arguments.json, {".json"});
  require_distinct({arguments.json}, {arguments.scene, arguments.cameras});
  AtomicFile file(arguments.json);  // refused before the work, not after it
  Workers workers;
  const auto scene = load(arguments.scene, workers);
  const bool search = arguments.stages == BenchStages::search;
  if (search && scene->node_count == 0)
    throw Error(ErrorCode::refused_input,
                scene->name + ": found a scene without a tree, expected a .voy that is not empty");
  if (scene->flat()) arguments.lod.refuse_without_tree(scene->name);
  if (arguments.time_budget > 0 && scene->flat())
    throw Error(ErrorCode::refused_input, scene->name +
                                              ": found a scene without a tree, "
                                              "expected a .voy with --time-budget");
  const auto backend = create_backend(arguments.backend);
  BenchSubject subject{scene, *backend, read_walk(arguments), workers};
  if (arguments.close_up) walk_close_up(arguments, subject);
  Json report = {{"scene", scene->name},
                 {"cameras", arguments.cameras},
                 {"close_up", arguments.close_up},
                 {"version", VOYAGER_VERSION},
                 {"device", backend->device_name()},
                 {"multiprocessors_asked", arguments.backend.multiprocessors},
                 {"tau", arguments.tau}};
  const bool costs = arguments.stereo && arguments.time_budget == 0;  // against one eye's
  const auto run = search ? bench_searches : costs ? bench_stereo : bench_frames;
  report.update(run(arguments, subject));
  say("measured on " + backend->device_name() + "\n");
  const std::string text = report.dump(2) + "\n";
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

void add_choices(CLI::App& command, BenchArguments& arguments) {
  add_lod_options(command, arguments.lod);
  add_choice<std::optional<SearchChoice>>(command, "--search", arguments.search,
                                          {{"all", SearchChoice::all},
                                           {"auto", SearchChoice::automatic},
                                           {"exhaustive", SearchChoice::exhaustive},
                                           {"streaming", SearchChoice::streaming},
                                           {"temporal", SearchChoice::temporal},
                                           {"sweep", SearchChoice::sweep}},
                                          "How the nodes to draw are found; all compares them in "
                                          "one run. Whole frames take auto: temporal, or on a GPU "
                                          "a sweep of all nodes where that is faster");
  add_choice<std::optional<bool>>(command, "--slack", arguments.slack,
                                  {{"on", true}, {"off", false}},
                                  "off: the temporal search visits all of the last cut");
  add_choice<std::optional<bool>>(command, "--filter", arguments.filter,
                                  {{"on", true}, {"off", false}},
                                  "The α-filter. off gives the same image, slower");
  add_choice<std::optional<Splatting>>(
      command, "--splat", arguments.splatting,
      {{"ours", Splatting::ours}, {"3dgs", Splatting::baseline_3dgs}},
      "How Gaussians become pixels; 3dgs is the baseline, on CUDA only");
  add_choice<Occlusion>(
      command, "--occlusion", arguments.occlusion,
      {{"auto", Occlusion::automatic}, {"on", Occlusion::on}, {"off", Occlusion::off}},
      "Leave out what the frame before shows to be hidden, on CUDA. The same image; auto: where "
      "that is less work");
  add_choice<Antialias>(command, "--antialias", arguments.antialias,
                        {{"on", Antialias::on}, {"off", Antialias::off}},
                        "off is the picture of 3DGS: say so in comparisons with it");
  add_choice<std::optional<Exponential>>(
      command, "--exp", arguments.exponential,
      {{"ex2", Exponential::ex2},
       {"exact", Exponential::exact},
       {"lut", Exponential::lut},
       {"half2", Exponential::half2}},
      "How the exponential is computed. --stages splat without it compares all, and their images "
      "with those of exact. --splat 3dgs takes exact");
  add_whole_option(command, "--lut-size", {1, 4096}, arguments.lut_size,
                   "Intervals of the table of --exp lut")
      ->default_str("32");
  name_group(command, "What is measured");
}

void add_conditions(CLI::App& command, BenchArguments& arguments) {
  add_backend_options(command, arguments.backend);
  add_tau_or_budget_options(command, arguments.tau, arguments.time_budget);
  add_size_option(command, arguments.size);
  add_whole_option(command, "--repeat", {1, 100000}, arguments.repeat,
                   "How often the path is timed. Without it, until 100 frames are timed");
  name_group(command, kCommonOptions);
}

}  // namespace

void add_bench(CLI::App& app) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = app.add_subcommand("bench", "Time the stages of frames along a camera path");
  command
      ->add_option("scene", arguments->scene,
                   "Scene to draw, a .voy or its URL; for whole frames also a flat one")
      ->required();
  command
      ->add_option("--cameras", arguments->cameras,
                   "Cameras of the path, as a cameras.json of 3DGS (INRIA)")
      ->type_name("FILE")
      ->required();
  command->add_option("--json", arguments->json, "File for the figures, a .json")
      ->type_name("FILE")
      ->required();
  add_choice<std::optional<BenchStages>>(
      *command, "--stages", arguments->stages_asked,
      {{"search", BenchStages::search}, {"splat", BenchStages::splat}, {"all", BenchStages::all}},
      "What is timed. search: finding the nodes to draw, alone. splat and all: whole frames. "
      "Without further choices splat compares the exponentials, and all goes from 3DGS to ours in "
      "steps. With --stereo or --time-budget the default is all");
  add_conditions(*command, *arguments);
  add_choices(*command, *arguments);
  command->add_flag("--stereo", arguments->stereo,
                    "Take the cameras two by two, left eye then right eye: what both cost against "
                    "one");
  command->add_flag("--close-up", arguments->close_up,
                    "Walk up to what stands in front of the first camera, to 0.3 m, and along it, "
                    "in place of the cameras");
  command->add_flag("--verify", arguments->verify,
                    "Also compare the nodes and weights of every frame with those of the "
                    "exhaustive search");
  name_group(*command, "What is measured");
  command->footer(
      "Example: voyager bench city.voy --cameras city.cameras.json --stages all --tau 3 --json "
      "all.json");
  command->callback([arguments] { bench(*arguments); });
}

}  // namespace voyager::tools
