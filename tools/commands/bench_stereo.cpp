#include <fmt/core.h>

#include "runtime/base/error.h"
#include "runtime/frame/view.h"
#include "tools/commands/bench_arguments.h"
#include "tools/console.h"
#include "tools/frame_path.h"
#include "tools/frame_report.h"
#include "tools/frame_table.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

// What a pair of eyes costs, against one of them and against both in views of their own: by
// medians, of the frame and of each stage.
Json stereo_costs(const Json& rows) {
  const Json &left = rows[0]["ms"], &right = rows[1]["ms"], &both = rows[2]["ms"];
  Json costs;
  for (const auto& [part, times] : both.items()) {
    const auto of = [&part = part](const Json& ms) { return ms[part]["median"].get<double>(); };
    const double apart = of(left) + of(right), together = of(both);
    costs[part] = {{"left", of(left)},
                   {"right", of(right)},
                   {"both", together},
                   {"saved", apart - together},
                   {"of_one_eye", apart > 0 ? Json(2 * together / apart) : Json()}};
  }
  return costs;
}

void print_costs(const Json& costs) {
  say(fmt::format("\n{:<14}{:>10}{:>10}{:>10}{:>10}{:>14}\n", "median ms", "left", "right", "both",
                  "saved", "of one eye"));
  for (const auto& [part, cost] : costs.items())
    say(fmt::format(
        "{:<14}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}{:>14}\n", part, cost["left"].get<double>(),
        cost["right"].get<double>(), cost["both"].get<double>(), cost["saved"].get<double>(),
        cost["of_one_eye"].is_null() ? "-"
                                     : fmt::format("{:.2f}", cost["of_one_eye"].get<double>())));
}

std::vector<Camera> every_other(const std::vector<Camera>& cameras, size_t first) {
  std::vector<Camera> chosen;
  for (size_t i = first; i < cameras.size(); i += 2) chosen.push_back(cameras[i]);
  return chosen;
}

}  // namespace

Json bench_stereo(const BenchArguments& arguments, const BenchSubject& subject) {
  const std::pair<const char*, std::vector<FrameInput>> paths[] = {
      {"left", frame_path(every_other(subject.cameras, 0), arguments.tau)},
      {"right", frame_path(every_other(subject.cameras, 1), arguments.tau)},
      {"both", stereo_path(subject.cameras, arguments.tau)}};
  const FrameMaker maker{subject.backend, subject.scene, subject.workers};
  const PipelineDesc chosen = chosen_desc(arguments, subject);
  // Draws nothing; the scene stays on its device from row to row.
  const View keeper(subject.scene, subject.backend, chosen, std::pmr::get_default_resource(),
                    subject.workers);
  const Progress progress = progress_bar();
  Json rows = Json::array();
  size_t repeats = 1;
  for (size_t i = 0; i < std::size(paths); ++i) {
    FramePath path{paths[i].second};
    path.repeats = repeats = chosen_repeats(arguments, path.frames.size());
    FrameRow row{paths[i].first, chosen};
    row.desc.eyes = static_cast<uint32_t>(path.frames[0].eyes.size());
    const size_t frames = path.frames_drawn();
    const FrameRun run = run_frames(maker, row.desc, path, [&](size_t drawn) {
      progress("timing", i * frames + drawn, std::size(paths) * frames);
    });
    rows.push_back(report_row(
        row, run,
        {path, subject.backend.rates(), subject.scene->sh_degree, subject.scene->flat()}));
  }
  progress("timing", 1, 1);  // a backend that counts no pixels draws fewer frames
  const Json costs = stereo_costs(rows);
  print_frames(rows);
  print_costs(costs);
  return {{"stages", "all"},
          {"eyes", 2},
          {"stereo", costs},
          {"frames", subject.cameras.size() / 2},
          {"repeats", repeats},
          {"leaves", subject.scene->leaf_count},
          {"nodes", subject.scene->node_count},
          {"rows", rows}};
}

}  // namespace voyager::tools
