#include <fmt/core.h>

#include "runtime/base/error.h"
#include "tools/commands/bench_arguments.h"
#include "tools/console.h"
#include "tools/progress_bar.h"
#include "tools/search_bench.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

bool wanted(const SearchCandidate& candidate, const BenchArguments& arguments,
            const BenchSubject& subject) {
  switch (arguments.search.value_or(SearchChoice::all)) {
    case SearchChoice::automatic:
      throw Error(ErrorCode::invalid_argument,
                  "--search: found auto with --stages search, expected a search by its name, or "
                  "all");
    case SearchChoice::sweep:
      if (subject.backend.search_for(*subject.scene, Search::sweep) != Search::sweep)
        throw Error(ErrorCode::unsupported,
                    "--search: found sweep, expected another: a sweep runs on CUDA only, of a "
                    "resident tree without damage whose leaves have no extent");
      return candidate.kind == Search::sweep;
    case SearchChoice::exhaustive:
      return candidate.kind == Search::exhaustive;
    case SearchChoice::streaming:
      return candidate.kind == Search::streaming;
    case SearchChoice::temporal:
      return candidate.kind ==
             (arguments.slack.value_or(true) ? Search::temporal : Search::temporal_visit);
    case SearchChoice::all:
      break;
  }
  return subject.backend.search_for(*subject.scene, candidate.kind) == candidate.kind;
}

Json time_searches(const BenchArguments& arguments, const BenchSubject& subject) {
  const std::vector<CutQuery> path =
      cut_path(subject.cameras, arguments.tau, subject.scene->origin);
  std::vector<SearchCandidate> searches;
  for (const SearchCandidate& candidate : kSearchCandidates)
    if (wanted(candidate, arguments, subject)) searches.push_back(candidate);
  const Progress progress = progress_bar();
  Json rows = Json::array();
  for (size_t i = 0; i < searches.size(); ++i) {
    Json row = {{"search", searches[i].name}, {"slack", searches[i].slack}};
    row.update(time_search(
        subject.backend, subject.scene, searches[i].kind, path, subject.workers, [&](size_t frame) {
          progress("searching", i * 2 * path.size() + frame + 1, searches.size() * 2 * path.size());
        }));
    if (arguments.verify) progress("verifying", 0, 0);
    if (arguments.verify && searches[i].kind != Search::exhaustive &&
        !same_cuts(subject.backend, subject.scene, Search::exhaustive, searches[i].kind, path,
                   subject.workers))
      throw Error(ErrorCode::internal,
                  fmt::format("--verify: found another cut or weight by {}, expected that of the "
                              "exhaustive search",
                              searches[i].name));
    rows.push_back(row);
  }
  progress("verifying", 1, 1);
  return rows;
}

}  // namespace

Json bench_searches(const BenchArguments& arguments, const BenchSubject& subject) {
  const Scene& scene = *subject.scene;
  Json report = {{"leaves", scene.leaf_count},
                 {"nodes", scene.node_count},
                 {"subtrees", scene.search.subtree_count()},
                 {"chunks", scene.search.chunk_count},
                 {"search_bytes", scene.search.bytes()}};
  report["searches"] = time_searches(arguments, subject);
  print_searches(report["searches"]);
  return report;
}

}  // namespace voyager::tools
