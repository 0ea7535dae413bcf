#pragma once
// How a tree's curve is measured.
#include <functional>
#include <memory>
#include <vector>

#include "runtime/frame/backend.h"
#include "tools/metrics/screen_pair.h"
#include "tools/report/curve_row.h"
#include "tools/report/measure.h"

namespace voyager {
class View;
}

namespace voyager::tools {

class CutCounts;

class CurveMeasurement {
 public:
  // Of the plan's compared frames. scene: its truth is what all trees are compared with.
  // Throws Error(damaged_chunk).
  CurveMeasurement(Backend& backend, const std::shared_ptr<const Scene>& scene,
                   const ReportPlan& plan, Workers& workers);

  // A row for each view and share, then one for the flight at each share, where two views follow
  // one another. The scene has a tree. done(): after each view's share.
  std::vector<CurveRow> run(const std::string& tree, const std::shared_ptr<const Scene>& scene,
                            const std::function<void()>& done);
  size_t views() const { return plan_.compared.size(); }

 private:
  struct Drawn {
    RgbaImage image;
    CurveRow row;
  };
  struct ViewRows {
    std::vector<CurveRow> own, pair;  // one a share; the view's, and its and its follower's
  };

  ViewRows run_view(const CurveRow& named, CutCounts& counts, View& view, const Scene& scene,
                    size_t index, const std::function<void()>& done);
  Drawn draw(View& view, const std::vector<FrameInput>& frames, CurveRow row) const;
  void compare(std::vector<Drawn>& drawn, size_t index) const;
  std::vector<CurveRow> pairs_of(const std::vector<Drawn>& own, const std::vector<Drawn>& next,
                                 size_t index) const;
  bool followed(size_t index) const;
  const FrameInput& frame(size_t index) const { return plan_.path[plan_.compared[index]]; }
  size_t width(size_t index) const { return frame(index).eyes[0].camera.width; }

  Backend& backend_;
  const ReportPlan& plan_;
  Workers& workers_;
  PipelineDesc desc_;
  std::vector<RgbaImage> truth_;  // one a view
};

}  // namespace voyager::tools
