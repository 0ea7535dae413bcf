#include "tools/report/report.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "tools/console.h"
#include "tools/output_folder.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"
#include "tools/report/close_up_times.h"
#include "tools/report/kept_rows.h"
#include "tools/report/measure.h"
#include "tools/report/pareto.h"
#include "tools/report/provenance.h"
#include "tools/report/report_csv.h"
#include "tools/report/report_plan.h"
#include "tools/report/report_plots.h"
#include "tools/report/report_text.h"
#include "tools/report/thumbnail.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCsv = "report.csv";
constexpr const char* kJson = "report.json";
constexpr const char* kPage = "report.html";

// Refused where a file that it will write has no place, or is an input.
std::unique_ptr<OutputFolder> checked_output(const ReportRequest& request,
                                             const std::filesystem::path& kept) {
  const std::vector<std::string> inputs = {request.scene, request.cameras};
  require_outside(kept.string(), inputs);
  auto output = std::make_unique<OutputFolder>(request.output, inputs);
  for (const char* name : {kCsv, kJson, kPage}) output->require_place(name);
  for (const std::string& name : report_plot_files()) output->require_place(name);
  return output;
}

class Report {
 public:
  Report(const ReportRequest& request, Backend& backend)
      : request_(request),
        folder_(std::filesystem::path(request.output) / ".report"),
        output_(checked_output(request, folder_)),
        backend_(backend),
        plan_(report_plan(request.cameras, request.size, request.extent)),
        scenes_(request.scene, folder_, workers_, progress_),
        provenance_(tools::provenance(request.scene, request.cameras, backend, request.arguments)),
        kept_(folder_, provenance_),
        references_(scenes_.own(), plan_.path, plan_.compared, folder_, workers_),
        truth_({backend, scenes_.own(), workers_}, plan_.path, plan_.compared, folder_, 0),
        slow_(slow_paths(plan_.path[plan_.compared[0]], *scenes_.own(), plan_.slow_frames)),
        slow_truth_(truth_of(slow_)),
        energy_(find_energy_meter(backend.device_uuid())),
        measurement_(backend, scenes_, references_, truth_, slow_, slow_truth_, plan_,
                     energy_.get(), workers_) {}

  void run() {
    note("measuring on " + backend_.device_name());
    std::vector<ReportCase> cases = report_cases(request_.extent, subject());
    const size_t budgets = scenes_.own()->flat() || request_.extent == ReportExtent::quick ? 0 : 2;
    total_ = cases.size() + budgets;
    for (const ReportCase& is : cases) add(is);
    if (budgets != 0 && !rows_.empty())
      for (const ReportCase& is : time_budget_cases(cases[0], rows_[0].frame.median)) add(is);
    progress_("measuring", 1, 1);
    close_up_ = close_up_times({backend_, scenes_.own(), workers_}, cases[0], plan_.first_compared,
                               request_.target);
    write();
    for (const std::string& name : kept_.remove())
      note(fmt::format("{}: not removed: {} is not a file of the report", folder_.string(), name));
  }

 private:
  TruthImages truth_of(const SlowPaths& slow) {
    std::vector<FrameInput> all = slow.dolly;
    all.insert(all.end(), slow.turn.begin(), slow.turn.end());
    const std::vector<size_t> every = every_index(all.size());
    return {{backend_, scenes_.own(), workers_}, std::move(all), every, folder_, plan_.path.size()};
  }

  ReportSubject subject() const {
    ReportSubject subject;
    subject.flat = scenes_.own()->flat();
    subject.sh_degree = scenes_.own()->sh_degree;
    subject.storages = scenes_.storages();
    const bool cuda = backend_.memory_bytes() > 0;
    subject.exponentials = {Exponential::exact, Exponential::ex2, Exponential::lut};
    if (cuda) subject.exponentials.push_back(Exponential::half2);
    subject.baseline = cuda;
    subject.search = backend_.search_for(*scenes_.own(), Search::fastest);
    return subject;
  }

  void add(const ReportCase& is) {
    const size_t frames = measurement_.frames_drawn(is);
    std::optional<KeptRow> kept = kept_.find(is);
    if (!kept) {
      const size_t width = plan_.path[plan_.compared[0]].eyes[0].camera.width;
      KeptRow found{measurement_.run(is,
                                     [&](size_t drawn) {
                                       progress_("measuring",
                                                 done_ * frames + std::min(drawn, frames),
                                                 total_ * frames);
                                     }),
                    "", ""};
      found.picture = picture_png(measurement_.pictures().image, width);
      found.difference = difference_png(measurement_.pictures().difference, width);
      kept_.keep(found);
      kept = std::move(found);
    }
    ++done_;
    rows_.push_back(kept->row);
    pictures_.push_back({{"image", kept->picture}, {"FLIP against the truth", kept->difference}});
  }

  void write_text(const std::string& name, const std::string& text) {
    AtomicFile file(output_->place(name));
    file.write(std::as_bytes(std::span(text)));
    file.commit();
  }

  // With what the advice depends on, and no measurement.
  Json provenance() const {
    Json shown = provenance_;
    shown["arguments"].push_back(fmt::format("--target {:g}", request_.target));
    return shown;
  }

  std::string method() const { return method_text(plan_, energy_ ? energy_->name() : ""); }

  void write() {
    const std::vector<size_t> front = pareto_front(rows_);
    const Advice advised = advise(rows_, request_.target);
    const std::string advice = advice_text(rows_, advised, request_.target);
    const std::string told = advice + (close_up_.empty() ? "" : " ") + close_up_text(close_up_);
    const auto stem = [](const std::string& path) {
      return std::filesystem::path(path).filename().replace_extension().string();
    };
    write_text(
        kCsv,
        report_csv({stem(request_.scene), stem(request_.cameras), backend_.device_name()}, rows_));
    Json json = {{"provenance", provenance()}, {"method", method()}, {"rows", Json::array()}};
    for (const ReportRow& row : rows_) json["rows"].push_back(to_json(row));
    json["front"] = front;
    json["target_ms"] = request_.target;
    json["recommended"] = advised.in_time ? Json(advised.row) : Json();
    json["recommendation"] = advice;
    json["close_up"] = Json::array();
    for (const CloseUpTimes& times : close_up_) json["close_up"].push_back(to_json(times));
    write_text(kJson, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    ReportPage page{"Error against run time: " + stem(request_.scene),
                    provenance(),
                    method(),
                    told,
                    report_plots(rows_, front),
                    rows_,
                    front,
                    {}};
    for (const size_t i : front) page.shown.push_back({i, pictures_[i]});
    write_text(kPage, html(page));
    for (const PagePlot& plot : page.plots) write_plot_png(output_->place(plot.file), plot.plot);
    output_->commit();
    say(fmt::format("{}\n{}/{}\n", told, request_.output, kPage));
  }

  const ReportRequest& request_;
  const std::filesystem::path folder_;
  const std::unique_ptr<OutputFolder> output_;  // before all that takes time or writes
  Workers workers_;
  const Progress progress_ = progress_bar();
  Backend& backend_;
  const ReportPlan plan_;
  ReportScenes scenes_;  // before what writes: a file that is refused leaves nothing
  const Json provenance_;
  KeptRows kept_;
  ReferenceImages references_;
  TruthImages truth_;
  const SlowPaths slow_;
  TruthImages slow_truth_;
  std::unique_ptr<EnergyMeter> energy_;
  Measurement measurement_;
  size_t done_ = 0, total_ = 1;
  std::vector<ReportRow> rows_;
  std::vector<std::vector<PagePicture>> pictures_;
  std::vector<CloseUpTimes> close_up_;
};

}  // namespace

void make_report(const ReportRequest& request, Backend& backend) {
  Report(request, backend).run();
}

}  // namespace voyager::tools
