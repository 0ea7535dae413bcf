#include "tools/report/curve_measure.h"

#include <cmath>
#include <numeric>

#include "runtime/frame/frame_search.h"
#include "runtime/frame/view.h"
#include "runtime/frame/whole_tree.h"
#include "tools/metrics/popping.h"
#include "tools/report/compare_images.h"
#include "tools/report/cut_counts.h"
#include "tools/report/truth_images.h"
#include "tools/statistics.h"

namespace voyager::tools {
namespace {

// Timed: at most so many frames, and no more than the least where these are long enough.
constexpr size_t kMostFrames = 5, kLeastFrames = 3;
constexpr double kEnough = 250;  // milliseconds

// Search to rasterize: resolve, which hands the image out, is apart.
double frame_milliseconds(const FrameStats& stats) {
  return std::accumulate(stats.milliseconds, stats.milliseconds + kResolve, 0.0);
}

}  // namespace

CurveMeasurement::CurveMeasurement(Backend& backend, const std::shared_ptr<const Scene>& scene,
                                   const ReportPlan& plan, Workers& workers)
    : backend_(backend), plan_(plan), workers_(workers) {
  // What a host gets that chooses nothing, as in the other report.
  if (backend.memory_bytes() > 0) desc_.exponential = Exponential::ex2;
  desc_.search = Search::fastest;
  for (const size_t i : plan.compared)
    truth_.push_back(truth_image({backend, scene, workers}, plan.path[i]));
}

std::vector<CurveRow> CurveMeasurement::run(const std::string& tree,
                                            const std::shared_ptr<const Scene>& scene,
                                            const std::function<void()>& done) {
  View view(scene, backend_, desc_, std::pmr::get_default_resource(), workers_);
  const std::shared_ptr<const LodTree> whole = whole_tree(*scene);
  CutCounts counts(*whole, workers_);
  CurveRow named;
  named.tree = tree;
  std::vector<CurveRow> rows;
  std::vector<std::vector<CurveRow>> pairs(std::size(kCurveShares));
  for (size_t i = 0; i < views(); ++i) {
    named.view = std::to_string(plan_.compared[i]);
    const ViewRows found = run_view(named, counts, view, *scene, i, done);
    rows.insert(rows.end(), found.own.begin(), found.own.end());
    for (size_t s = 0; s < found.pair.size(); ++s) pairs[s].push_back(found.pair[s]);
  }
  for (const std::vector<CurveRow>& of_share : pairs)
    if (!of_share.empty()) rows.push_back(mean_row(of_share, kFlight));
  return rows;
}

CurveMeasurement::ViewRows CurveMeasurement::run_view(const CurveRow& named, CutCounts& counts,
                                                      View& view, const Scene& scene, size_t index,
                                                      const std::function<void()>& done) {
  FrameInput first = frame(index);
  const auto query = [&](double tau) {
    first.tau = tau;
    return cut_query(first, 0, scene.origin);
  };
  counts.look_from(query(0).centre);
  const auto cut_at = [&](double tau) { return counts.at(query(tau).target_size); };
  const auto leaves = static_cast<double>(scene.leaf_count);
  std::vector<Drawn> own, next;
  for (const double share : kCurveShares) {
    CurveRow row = named;
    row.share = share;
    row.tau = tau_of_cut(static_cast<uint64_t>(std::llround(share * leaves)), cut_at).tau;
    first.tau = row.tau;
    own.push_back(draw(view, {first}, row));
    if (followed(index)) {
      FrameInput second = frame(index + 1);
      second.tau = row.tau;
      next.push_back(draw(view, {first, second}, row));
    }
    done();
  }
  compare(own, index);
  compare(next, index + 1);
  for (std::vector<Drawn>* drawn : {&own, &next})
    for (Drawn& of : *drawn) of.row.cut_share = of.row.cut / leaves;
  ViewRows rows;
  for (const Drawn& of : own) rows.own.push_back(of.row);
  if (!next.empty()) rows.pair = pairs_of(own, next, index);
  return rows;
}

// The last of the frames, as it comes after those before it, over and over.
CurveMeasurement::Drawn CurveMeasurement::draw(View& view, const std::vector<FrameInput>& frames,
                                               CurveRow row) const {
  Drawn drawn{{}, std::move(row)};
  const auto next = [&] {
    for (const FrameInput& frame : frames) drawn.image = draw_image(view, frame);
    return frame_milliseconds(view.stats());
  };
  next();  // a start: the view comes from elsewhere
  std::vector<double> times;
  double sum = 0;
  while (times.size() < kLeastFrames || (times.size() < kMostFrames && sum < kEnough))
    sum += times.emplace_back(next());
  const FrameStats& stats = view.stats();
  drawn.row.cut = static_cast<double>(stats.cut_size);
  drawn.row.splats = static_cast<double>(stats.splats);
  drawn.row.pairs = static_cast<double>(stats.pairs_after);
  drawn.row.milliseconds = percentile(times, 0.5);
  return drawn;
}

// One image a task: metrics are on one thread each.
void CurveMeasurement::compare(std::vector<Drawn>& drawn, size_t index) const {
  workers_.for_blocks(drawn.size(), 1, [&](size_t i, size_t) {
    drawn[i].row.error = compare_images({drawn[i].image}, {truth_[index]},
                                        {{plan_.compared[index], width(index)}}, workers_);
  });
}

std::vector<CurveRow> CurveMeasurement::pairs_of(const std::vector<Drawn>& own,
                                                 const std::vector<Drawn>& next,
                                                 size_t index) const {
  std::vector<CurveRow> rows;
  for (size_t i = 0; i < own.size(); ++i) {
    CurveRow& row = rows.emplace_back(mean_row({own[i].row, next[i].row}, kFlight));
    row.milliseconds = next[i].row.milliseconds;
    // Cameras of a file may differ in size: there is no change from one to the other then.
    if (width(index) != width(index + 1) || own[i].image.size() != next[i].image.size()) continue;
    Popping popping;
    popping.add(own[i].image, truth_[index]);
    popping.add(next[i].image, truth_[index + 1]);
    row.error.popping = popping.mean();
  }
  return rows;
}

bool CurveMeasurement::followed(size_t index) const {
  return index + 1 < views() && plan_.compared[index] + 1 == plan_.compared[index + 1];
}

}  // namespace voyager::tools
