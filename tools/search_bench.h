#pragma once
// Times the searches of one scene along a camera path.
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "runtime/frame/backend.h"
#include "tools/cameras.h"

namespace voyager::tools {

// The searches that a report compares, by their names on the command line.
struct SearchCandidate {
  Search kind;
  const char* name;
  bool slack;
};
inline constexpr SearchCandidate kSearchCandidates[] = {{Search::exhaustive, "exhaustive", false},
                                                        {Search::streaming, "streaming", false},
                                                        {Search::temporal_visit, "temporal", false},
                                                        {Search::temporal, "temporal", true},
                                                        {Search::sweep, "sweep", false}};

// What a camera path asks of the search.
std::vector<CutQuery> cut_path(const std::vector<Camera>& cameras, double tau, const Vec3d& origin);

// A table of rows that time_search() gave, with "search" and "slack" in front.
void print_searches(const nlohmann::ordered_json& rows);

// Once along the path without and once with weights, after a start on its first frames.
// "ms" and "ms_with_weights" are of the device; counters are means over the path.
nlohmann::ordered_json time_search(Backend& backend, const std::shared_ptr<const Scene>& scene,
                                   Search kind, const std::vector<CutQuery>& path, Workers& workers,
                                   const std::function<void(size_t)>& frame_done);

// Runs two searches beside one another over the path; false where a cut or a weight differs.
bool same_cuts(Backend& backend, const std::shared_ptr<const Scene>& scene, Search a, Search b,
               const std::vector<CutQuery>& path, Workers& workers);

}  // namespace voyager::tools
