#include <fmt/core.h>

#include <memory>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/backend_module.h"
#include "tools/cameras.h"
#include "tools/commands/commands.h"
#include "tools/options.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"
#include "tools/search_bench.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

enum class Stages { search };
enum class BenchBackend { automatic, cpu, cuda };
enum class SearchChoice { all, exhaustive, streaming, temporal };

struct Arguments {
  std::string scene, cameras, json;
  Stages stages = Stages::search;
  BenchBackend backend = BenchBackend::automatic;
  SearchChoice search = SearchChoice::all;
  bool slack = true;
  bool verify = false;
  double tau = 3;
  unsigned multiprocessors = 0;
  ImageSize size;
};

bool wanted(const SearchCandidate& candidate, const Arguments& arguments) {
  switch (arguments.search) {
    case SearchChoice::exhaustive:
      return candidate.kind == Search::exhaustive;
    case SearchChoice::streaming:
      return candidate.kind == Search::streaming;
    case SearchChoice::temporal:
      return candidate.kind == (arguments.slack ? Search::temporal : Search::temporal_visit);
    case SearchChoice::all:
      break;
  }
  return true;
}

std::unique_ptr<Backend> create_backend(const Arguments& arguments) {
  const BackendModuleOptions options{0, arguments.multiprocessors, nullptr};
  if (arguments.backend == BenchBackend::cuda) return load_backend("cuda", options);
  if (arguments.backend == BenchBackend::automatic) {
    try {
      return load_backend("cuda", options);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::no_device) throw;
    }
  }
  if (arguments.multiprocessors != 0)
    throw Error(ErrorCode::invalid_argument,
                "--sms: found the CPU backend, expected --backend cuda");
  return create_cpu_backend();
}

std::vector<Camera> read_walk(const Arguments& arguments) {
  std::vector<Camera> cameras = read_cameras(arguments.cameras);
  if (arguments.size.width != 0)
    for (Camera& camera : cameras)
      camera = camera.resized(arguments.size.width, arguments.size.height);
  return cameras;
}

Json bench_search(const Arguments& arguments, Backend& backend,
                  const std::shared_ptr<const Scene>& scene, Workers& workers) {
  const std::vector<CutQuery> path = cut_path(read_walk(arguments), arguments.tau, scene->origin);
  std::vector<SearchCandidate> searches;
  for (const SearchCandidate& candidate : kSearchCandidates)
    if (wanted(candidate, arguments)) searches.push_back(candidate);
  const Progress progress = progress_bar();
  Json rows = Json::array();
  for (size_t i = 0; i < searches.size(); ++i) {
    Json row = {{"search", searches[i].name}, {"slack", searches[i].slack}};
    row.update(time_search(backend, scene, searches[i].kind, path, workers, [&](size_t frame) {
      progress("searching", i * 2 * path.size() + frame + 1, searches.size() * 2 * path.size());
    }));
    if (arguments.verify && searches[i].kind != Search::exhaustive &&
        !same_cuts(backend, scene, Search::exhaustive, searches[i].kind, path, workers))
      throw Error(ErrorCode::internal,
                  fmt::format("--verify: found another cut or weight by {}, expected that of the "
                              "exhaustive search",
                              searches[i].name));
    rows.push_back(row);
  }
  print_searches(rows);
  return rows;
}

void bench(const Arguments& arguments) {
  require_extension("--json", arguments.json, {".json"});
  require_distinct({arguments.json}, {arguments.scene, arguments.cameras});
  AtomicFile file(arguments.json);  // refused before the work, not after it
  Workers workers;
  const auto scene =
      load_scene(open_file_source(arguments.scene), std::pmr::get_default_resource(), workers);
  if (scene->tree.size() == 0)
    throw Error(
        ErrorCode::refused_input,
        arguments.scene + ": found a scene without a tree, expected a .voy that is not empty");
  const auto backend = create_backend(arguments);
  Json report = {{"scene", arguments.scene},
                 {"cameras", arguments.cameras},
                 {"version", VOYAGER_VERSION},
                 {"device", backend->device_name()},
                 {"multiprocessors_asked", arguments.multiprocessors},
                 {"tau", arguments.tau},
                 {"leaves", scene->leaf_count},
                 {"nodes", scene->tree.size()},
                 {"subtrees", scene->search.subtrees.size()},
                 {"chunks", scene->search.chunk_count()},
                 {"search_bytes", scene->search.bytes()}};
  report["searches"] = bench_search(arguments, *backend, scene, workers);
  const std::string text = report.dump(2) + "\n";
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

}  // namespace

void add_bench(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("bench", "Time the stages of a frame along a camera path");
  command->add_option("scene", arguments->scene, "A .voy")->required();
  command->add_option("--cameras", arguments->cameras, "INRIA cameras.json, as one walk")
      ->required();
  add_choice<Stages>(*command, "--stages", arguments->stages, {{"search", Stages::search}},
                     "What to time");
  add_choice<BenchBackend>(
      *command, "--backend", arguments->backend,
      {{"auto", BenchBackend::automatic}, {"cpu", BenchBackend::cpu}, {"cuda", BenchBackend::cuda}},
      "Where; auto is CUDA where there is a device");
  add_choice<SearchChoice>(*command, "--search", arguments->search,
                           {{"all", SearchChoice::all},
                            {"exhaustive", SearchChoice::exhaustive},
                            {"streaming", SearchChoice::streaming},
                            {"temporal", SearchChoice::temporal}},
                           "Which; all compares them in one run");
  add_choice<bool>(*command, "--slack", arguments->slack, {{"on", true}, {"off", false}},
                   "off: --search temporal visits every subtree of the last cut");
  add_tau_option(*command, arguments->tau);
  add_size_option(*command, arguments->size);
  command
      ->add_option("--sms", arguments->multiprocessors,
                   "Confine CUDA to so many multiprocessors (green context)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--verify", arguments->verify,
                    "Also compare every frame's cut and weights with the exhaustive search's");
  command->add_option("--json", arguments->json, "Where the figures go")->required();
  command->footer(
      "Example: voyager bench city.voy --cameras city.cameras.json --stages search --tau 6 --json "
      "search.json");
  command->callback([arguments] { bench(*arguments); });
}

}  // namespace voyager::tools
