// The searches on made-up cities of sizes that nobody wants to write to a disk: the
// tree is built in memory, and of its Gaussians only places and sizes are kept.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <fstream>

#include "runtime/base/clock.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/backend_module.h"
#include "runtime/lod/build.h"
#include "runtime/lod/round_bounds.h"
#include "runtime/scene/append.h"
#include "tools/search_bench.h"
#include "tools/synth/city.h"

namespace {

using namespace voyager;
using namespace voyager::tools;
using Json = nlohmann::ordered_json;

GaussianCloud make_city(uint64_t gaussians) {
  GaussianCloud city;
  city.sh_degree = 0;
  city.position.reserve(3 * gaussians);
  city.log_scale.reserve(3 * gaussians);
  city.rotation.reserve(4 * gaussians);
  city.opacity.reserve(gaussians);
  city.sh.reserve(3 * gaussians);
  synth::generate_city({gaussians, 1, 0}, [&](const GaussianCloud& part) {
    append(city, GaussianCloud(part), "city");
  });
  return city;
}

// The tree without its Gaussians.
std::shared_ptr<Scene> make_scene(uint64_t gaussians, Workers& workers) {
  auto scene = std::make_shared<Scene>(std::pmr::get_default_resource());
  {
    BakedScene baked = build_tree(make_city(gaussians), workers);
    scene->tree = std::move(baked.tree);
    round_bounds(scene->tree, workers);
    scene->origin = {baked.origin[0], baked.origin[1], baked.origin[2]};
  }
  scene->storage = Storage::lossless;
  scene->leaf_count = gaussians;
  scene->partition = partition_tree(scene->tree, kDefaultChunkBytes);
  scene->search = make_search_tree(scene->tree, scene->partition, {}, workers);
  return scene;
}

Json bench(Backend& backend, const std::shared_ptr<const Scene>& scene,
           const std::vector<tools::Camera>& cameras, double tau, Workers& workers) {
  const std::vector<CutQuery> path = cut_path(cameras, tau, scene->origin);
  Json rows = Json::array();
  for (const SearchCandidate& candidate : kSearchCandidates) {
    if (backend.search_for(*scene, candidate.kind) != candidate.kind) continue;
    Json row = {{"search", candidate.name}, {"slack", candidate.slack}};
    row.update(time_search(backend, scene, candidate.kind, path, workers, [](size_t) {}));
    rows.push_back(row);
  }
  fmt::print("\n{} leaves, {} nodes, tau {}, {}: cut {}, changed a frame {:.4f} %\n",
             scene->leaf_count, scene->tree.size(), tau, backend.device_name(),
             rows.back()["last_cut"].get<uint64_t>(),
             100 * rows.back()["entered"].get<double>() / rows.back()["last_cut"].get<double>());
  print_searches(rows);
  return {{"device", backend.device_name()},
          {"leaves", scene->leaf_count},
          {"nodes", scene->tree.size()},
          {"subtrees", scene->search.subtrees.size()},
          {"chunks", scene->search.chunk_count},
          {"tau", tau},
          {"searches", rows}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Times the searches on cities built in memory"};
  std::vector<uint64_t> sizes;
  std::vector<double> taus{6};
  std::vector<unsigned> multiprocessors{0};
  std::string cameras, json, backend_name = "cuda";
  app.add_option("--gaussians", sizes, "Leaves of each city")->required();
  app.add_option("--cameras", cameras, "cameras.json, as one walk")->required();
  app.add_option("--tau", taus, "Granularities in pixels");
  app.add_option("--sms", multiprocessors, "Multiprocessors of CUDA; 0 is all");
  app.add_option("--backend", backend_name, "cuda or cpu");
  app.add_option("--json", json, "Where the figures go");
  CLI11_PARSE(app, argc, argv);
  Workers workers;
  Json reports = Json::array();
  const std::vector<tools::Camera> walk = read_cameras(cameras);
  for (const uint64_t gaussians : sizes) {
    const Stopwatch watch;
    const auto scene = make_scene(gaussians, workers);
    fmt::print("built in {:.1f} s\n", watch.milliseconds() / 1000);
    for (const unsigned sms : multiprocessors) {
      const auto backend =
          backend_name == "cpu" ? create_cpu_backend() : load_backend("cuda", {0, sms});
      for (const double tau : taus) {
        reports.push_back(bench(*backend, scene, walk, tau, workers));
        if (!json.empty()) std::ofstream(json) << reports.dump(1) << "\n";
        std::fflush(stdout);
      }
    }
  }
}
