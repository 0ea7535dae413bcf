#pragma once
#include "tools/cameras.h"
#include "tools/report/energy_meter.h"
#include "tools/report/reference_images.h"
#include "tools/report/report_row.h"
#include "tools/report/report_scenes.h"
#include "tools/report/slow_paths.h"
#include "tools/report/truth_images.h"

namespace voyager::tools {

// The pictures of a row that a reader is shown: of the first compared frame, RGBA float.
struct ReportPictures {
  RgbaImage image;
  std::vector<float> difference;  // FLIP against the truth
};

// How a report times and compares.
struct ReportPlan {
  std::vector<FrameInput> path;  // timed, in order
  size_t repeats = 1;
  // Of the path, ascending: compared with the reference and the truth. Where two follow one
  // another, their change is compared as well.
  std::vector<size_t> compared;
  size_t slow_frames = 0;  // of each of slow_paths(), from the first compared one on
  Camera first_compared = {};
};

// From the search to the last pixel.
ReportTimes frame_times(const std::vector<FrameStats>& frames);
// As used.
double median_tau(const std::vector<FrameStats>& frames);

class Measurement {
 public:
  // references, truth: of the plan's path; slow_truth: of all of slow.dolly and slow.turn. Throws
  // Error(unsupported) where the backend lacks a choice.
  Measurement(Backend& backend, ReportScenes& scenes, ReferenceImages& references,
              TruthImages& truth, const SlowPaths& slow, TruthImages& slow_truth,
              const ReportPlan& plan, EnergyMeter* energy, Workers& workers)
      : backend_(backend),
        scenes_(scenes),
        references_(references),
        truth_(truth),
        slow_(slow),
        slow_truth_(slow_truth),
        plan_(plan),
        energy_(energy),
        workers_(workers) {}

  ReportRow run(const ReportCase& is, const std::function<void(size_t)>& frame_done);
  // Of the last run.
  const ReportPictures& pictures() const { return pictures_; }
  // By run(), before those that a sensor of energy asks for.
  size_t frames_drawn(const ReportCase& is) const;

 private:
  FramePath path_of(const ReportCase& is) const;
  void measure_shimmer(const FrameMaker& maker, ReportRow& row);

  Backend& backend_;
  ReportScenes& scenes_;
  ReferenceImages& references_;
  TruthImages& truth_;
  const SlowPaths& slow_;
  TruthImages& slow_truth_;
  const ReportPlan& plan_;
  EnergyMeter* energy_;
  Workers& workers_;
  ReportPictures pictures_;
};

}  // namespace voyager::tools
