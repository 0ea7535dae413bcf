#include <fmt/core.h>

#include "runtime/base/error.h"
#include "runtime/frame/view.h"
#include "tools/budget_report.h"
#include "tools/commands/bench_arguments.h"
#include "tools/console.h"
#include "tools/frame_path.h"
#include "tools/frame_report.h"
#include "tools/frame_table.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kComparedImages = 8;  // for the error of an exponential

struct Plan {
  std::vector<FrameRow> rows;
  bool compares = false;  // rows with one another; one that the backend lacks is left out then
  bool images = false;    // also their images with the exact row's
};

bool has_choice(const BenchArguments& arguments) {
  const bool one_search = arguments.search.has_value() && *arguments.search != SearchChoice::all;
  return one_search || arguments.time_budget > 0 || arguments.lod.given() || arguments.slack ||
         arguments.filter || arguments.splatting || arguments.exponential;
}

Plan make_plan(const BenchArguments& arguments, const BenchSubject& subject) {
  if (arguments.stages == BenchStages::all && !has_choice(arguments))
    return {ablation_rows(subject.backend.search_for(*subject.scene, Search::fastest)), true,
            false};
  PipelineDesc desc = chosen_desc(arguments, subject);
  if (arguments.stereo) desc.eyes = 2;
  if (arguments.stages == BenchStages::splat && !arguments.exponential &&
      desc.splatting == Splatting::ours)
    return {exponential_rows(desc), true, true};
  return {{chosen_row(desc, subject.scene->flat())}, false, false};
}

FramePath make_path(const BenchArguments& arguments, const BenchSubject& subject) {
  FramePath path;
  path.frames = arguments.stereo ? stereo_path(subject.cameras, arguments.tau)
                                 : frame_path(subject.cameras, arguments.tau);
  path.repeats = chosen_repeats(arguments, path.frames.size());
  if (arguments.time_budget > 0) path.time_budget = TimeBudgetDesc{arguments.time_budget};
  return path;
}

// "WxH" where all frames have one size.
Json size_of(const FramePath& path) {
  const auto& first = path.frames[0].eyes[0].camera;
  for (const FrameInput& frame : path.frames)
    if (frame.eyes[0].camera.width != first.width || frame.eyes[0].camera.height != first.height)
      return nullptr;
  return fmt::format("{}x{}", first.width, first.height);
}

// Rows of one report.
class Rows {
 public:
  Rows(const BenchSubject& subject, const FramePath& path, const Plan& plan)
      : maker_{subject.backend, subject.scene, subject.workers},
        keeper_(subject.scene, subject.backend, plan.rows.back().desc,
                std::pmr::get_default_resource(), subject.workers),
        path_(path),
        plan_(plan),
        context_{path, subject.backend.rates(), subject.scene->sh_degree, subject.scene->flat()},
        compared_(spread_indices(path.frames.size(), kComparedImages)) {}

  void run() {
    for (size_t i = 0; i < plan_.rows.size(); ++i) {
      const FrameRow& row = plan_.rows[i];
      try {
        if (repeats_another(row))
          leave_out(row, "the scene has no tree: the same as 3dgs");
        else
          add(row, i);
      } catch (const Error& error) {
        if (error.code() != ErrorCode::unsupported || !plan_.compares) throw;
        leave_out(row, error.what());
      }
    }
    progress_("timing", 1, 1);  // a backend that counts no pixels draws fewer frames
  }

  Json rows = Json::array(), left_out = Json::array();

 private:
  // In a scene without a tree, steps of the search change nothing.
  bool repeats_another(const FrameRow& row) const {
    return context_.flat && plan_.compares && draws_cut(row.desc.lod) &&
           row.desc.splatting == Splatting::baseline_3dgs;
  }

  void leave_out(const FrameRow& row, const std::string& why) {
    left_out.push_back({{"name", row.name}, {"why", why}});
  }

  void add(const FrameRow& row, size_t index) {
    const size_t frames = path_.frames_drawn();
    const FrameRun run = run_frames(maker_, row.desc, path_, [&](size_t drawn) {
      progress_("timing", index * frames + drawn, plan_.rows.size() * frames);
    });
    Json json = report_row(row, run, context_);
    if (plan_.images || path_.time_budget) progress_("comparing", 0, 0);
    if (plan_.images) compare_images(row, json);
    if (path_.time_budget) json["time_budget"] = time_budget_json(run, lost_by(row, run));
    rows.push_back(json);
  }

  void compare_images(const FrameRow& row, Json& json) {
    const std::vector<RgbaImage> images = draw_images(maker_, row.desc, path_.frames, compared_);
    if (row.desc.exponential == Exponential::exact) expected_ = images;
    if (!expected_.empty()) add_error(json, image_error(images, expected_), images.size());
  }

  // Images of the path's first time: at the τ that they were timed with, and at the fixed one.
  std::vector<BudgetError> lost_by(const FrameRow& row, const FrameRun& run) {
    std::vector<FrameInput> steered = path_.frames;
    for (const size_t i : compared_) steered[i].tau = run.timed[i].tau;
    PipelineDesc leaves = row.desc;
    leaves.lod = Lod::all_leaves;
    const auto expected = draw_images(maker_, leaves, path_.frames, compared_);
    const auto budget = draw_images(maker_, row.desc, steered, compared_);
    const auto fixed = draw_images(maker_, row.desc, path_.frames, compared_);
    std::vector<BudgetError> errors;
    for (size_t i = 0; i < compared_.size(); ++i)
      errors.push_back({compared_[i], path_.frames[0].tau,
                        image_error({budget[i]}, {expected[i]}).psnr,
                        image_error({fixed[i]}, {expected[i]}).psnr});
    return errors;
  }

  FrameMaker maker_;
  View keeper_;  // draws nothing; the scene stays on its device from row to row
  const FramePath& path_;
  const Plan& plan_;
  ReportContext context_;
  std::vector<size_t> compared_;
  std::vector<RgbaImage> expected_;  // of the exact row, which is the first
  Progress progress_ = progress_bar();
};

}  // namespace

Json bench_frames(const BenchArguments& arguments, const BenchSubject& subject) {
  const Plan plan = make_plan(arguments, subject);
  const FramePath path = make_path(arguments, subject);
  Rows rows(subject, path, plan);
  rows.run();
  if (plan.compares && !plan.images) add_speedups(rows.rows);
  print_frames(rows.rows);
  if (path.time_budget) print_time_budget(rows.rows[0]["time_budget"]);
  for (const Json& row : rows.left_out)
    say(fmt::format("left out: {}: {}\n", row["name"].get<std::string>(),
                    row["why"].get<std::string>()));
  const DeviceRates rates = subject.backend.rates();
  return {{"stages", arguments.stages == BenchStages::all ? "all" : "splat"},
          {"size", size_of(path)},
          {"eyes", path.frames[0].eyes.size()},
          {"frames", path.frames.size()},
          {"repeats", path.repeats},
          {"leaves", subject.scene->leaf_count},
          {"nodes", subject.scene->node_count},
          {"sh_degree", subject.scene->sh_degree},
          {"rates",
           {{"bytes_per_second", rates.bytes},
            {"lane_instructions_per_second", rates.lane_instructions}}},
          {"rows", rows.rows},
          {"left_out", rows.left_out}};
}

}  // namespace voyager::tools
