#include "tools/search_bench.h"

#include <fmt/core.h>

#include <cstring>

#include "runtime/frame/frame_search.h"
#include "tools/console.h"
#include "tools/frame_path.h"
#include "tools/statistics.h"

namespace voyager::tools {
namespace {

constexpr size_t kWarmUpFrames = 32;

struct Totals {
  std::vector<double> milliseconds;
  double tested = 0, visited = 0, chunks = 0, bytes = 0, entered = 0, left = 0;
  size_t streamed = 0;
};

void add(Totals& totals, SceneSearch& search) {
  const SearchTimes times = search.times();
  const SearchStats stats = search.stats();
  totals.milliseconds.push_back(times.search + times.weights);
  totals.tested += static_cast<double>(stats.nodes_tested);
  totals.visited += static_cast<double>(stats.subtrees_visited);
  totals.chunks += static_cast<double>(stats.chunks_read);
  totals.bytes += static_cast<double>(stats.bytes_read);
  totals.entered += static_cast<double>(stats.entered);
  totals.left += static_cast<double>(stats.left);
  totals.streamed += stats.ran == Search::streaming;
}

Totals run_path(SceneSearch& search, const std::vector<CutQuery>& path,
                const std::function<void(size_t)>& frame_done) {
  for (size_t i = 0; i < std::min(path.size(), kWarmUpFrames); ++i) search.run(path[i]);
  search.run(path[0]);
  Totals totals;
  for (size_t i = 0; i < path.size(); ++i) {
    search.run(path[i]);
    add(totals, search);
    frame_done(i);
  }
  return totals;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void print_row(const nlohmann::ordered_json& row) {
  say(fmt::format("{:<11}{:<7}{:>10.4f}{:>10.4f}{:>14.4f}{:>12.3f} %{:>12.0f}\n",
                  row["search"].get<std::string>(), row["slack"].get<bool>() ? "slack" : "",
                  row["ms"]["median"].get<double>(), row["ms"]["p99"].get<double>(),
                  row["ms_with_weights"]["median"].get<double>(),
                  100 * row["nodes_tested_share"].get<double>(), row["entered"].get<double>()));
}

}  // namespace

std::vector<CutQuery> cut_path(const std::vector<Camera>& cameras, double tau,
                               const Vec3d& origin) {
  std::vector<CutQuery> path;
  for (const FrameInput& frame : frame_path(cameras, tau))
    path.push_back(cut_query(frame, 0, origin));
  return path;
}

void print_searches(const nlohmann::ordered_json& rows) {
  say(fmt::format("{:<18}{:>10}{:>10}{:>14}{:>14}{:>12}\n", "milliseconds", "median", "p99",
                  "with weights", "nodes tested", "entered"));
  for (const auto& row : rows) print_row(row);
}

nlohmann::ordered_json time_search(Backend& backend, const std::shared_ptr<const Scene>& scene,
                                   Search kind, const std::vector<CutQuery>& path, Workers& workers,
                                   const std::function<void(size_t)>& frame_done) {
  std::pmr::memory_resource* memory = std::pmr::get_default_resource();
  std::vector<uint32_t> cut;
  std::vector<float> weights;
  Totals totals;
  {
    const auto search = backend.create_search(scene, {kind, false}, memory, workers);
    totals = run_path(*search, path, frame_done);
    search->read(cut, weights);
  }
  const auto weighted = backend.create_search(scene, {kind, true}, memory, workers);
  const Totals with_weights =
      run_path(*weighted, path, [&](size_t i) { frame_done(path.size() + i); });

  const auto frames = static_cast<double>(path.size());
  const auto nodes = static_cast<double>(scene->node_count);
  return {{"ms", summary(totals.milliseconds)},
          {"ms_with_weights", summary(with_weights.milliseconds)},
          {"nodes_tested", totals.tested / frames},
          {"nodes_tested_share", totals.tested / frames / nodes},
          {"subtrees_visited", totals.visited / frames},
          {"chunks_read", totals.chunks / frames},
          {"bytes_read", totals.bytes / frames},
          {"entered", totals.entered / frames},
          {"left", totals.left / frames},
          {"changed_share", cut.empty() ? 0.0
                                        : (totals.entered + totals.left) / 2 / frames /
                                              static_cast<double>(cut.size())},
          {"streamed_frames", totals.streamed},
          {"last_cut", cut.size()}};
}

bool same_cuts(Backend& backend, const std::shared_ptr<const Scene>& scene, Search a, Search b,
               const std::vector<CutQuery>& path, Workers& workers) {
  std::pmr::memory_resource* memory = std::pmr::get_default_resource();
  const auto first = backend.create_search(scene, {a, true}, memory, workers);
  const auto second = backend.create_search(scene, {b, true}, memory, workers);
  std::vector<uint32_t> cuts[2];
  std::vector<float> weights[2];
  for (const CutQuery& query : path) {
    first->run(query);
    second->run(query);
    first->read(cuts[0], weights[0]);
    second->read(cuts[1], weights[1]);
    if (!same_bits(cuts[0], cuts[1]) || !same_bits(weights[0], weights[1])) return false;
  }
  return true;
}

}  // namespace voyager::tools
