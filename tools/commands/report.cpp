#include <fmt/core.h>

#include <cmath>
#include <filesystem>

#include "runtime/base/error.h"
#include "tools/commands/commands.h"
#include "tools/commands/measured_backend.h"
#include "tools/frame_path.h"
#include "tools/options.h"
#include "tools/output_folder.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"
#include "tools/report/kept_rows.h"
#include "tools/report/measure.h"
#include "tools/report/pareto.h"
#include "tools/report/provenance.h"
#include "tools/report/report_csv.h"
#include "tools/report/report_plots.h"
#include "tools/report/thumbnail.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string scene, cameras, output;
  bool quick = false, full = false;
  double target = 1000.0 / 90;  // milliseconds
  BackendChoice backend;
  ImageSize size;
};

struct Extent {
  ReportExtent cases;
  size_t path, compared, timed;  // frames, at most; timed: at least, by repeats
};

Extent extent_of(const Arguments& arguments) {
  if (arguments.quick) return {ReportExtent::quick, 16, 2, 16};
  if (arguments.full) return {ReportExtent::full, 600, 8, 200};
  return {ReportExtent::standard, 60, 3, 40};
}

// The first frames of the walk, and of these some, each with the one behind it where there is one.
ReportPlan make_plan(const Arguments& arguments, const Extent& extent) {
  std::vector<Camera> cameras = read_cameras(arguments.cameras);
  if (cameras.empty())
    throw Error(ErrorCode::refused_input,
                arguments.cameras + ": found no camera, expected one or more");
  cameras.resize(std::min(cameras.size(), extent.path));
  if (arguments.size.width != 0)
    for (Camera& camera : cameras)
      camera = camera.resized(arguments.size.width, arguments.size.height);
  ReportPlan plan;
  plan.path = frame_path(cameras, 0);
  plan.repeats = std::max<size_t>(1, extent.timed / plan.path.size());
  for (const size_t i : spread_indices(plan.path.size(), extent.compared)) {
    if (plan.compared.empty() || plan.compared.back() < i) plan.compared.push_back(i);
    if (i + 1 < plan.path.size()) plan.compared.push_back(i + 1);
  }
  return plan;
}

class Report {
 public:
  explicit Report(const Arguments& arguments)
      : arguments_(arguments),
        extent_(extent_of(arguments)),
        output_(arguments.output),
        backend_(create_backend(arguments.backend)),
        plan_(make_plan(arguments, extent_)),
        provenance_(provenance(arguments.scene, arguments.cameras, *backend_, words(arguments))),
        kept_(std::filesystem::path(arguments.output) / ".report", provenance_),
        scenes_(arguments.scene, kept_.folder(), workers_, progress_),
        references_(scenes_.own(), plan_.path, kept_.folder(), workers_),
        energy_(find_energy_meter(backend_->rates().bytes > 0)),
        measurement_(*backend_, scenes_, references_, plan_, energy_.get(), workers_) {}

  void run() {
    std::vector<ReportCase> cases = report_cases(extent_.cases, subject());
    const size_t budgets = scenes_.own()->flat() || arguments_.quick ? 0 : 2;
    total_ = cases.size() + budgets;
    for (const ReportCase& is : cases) add(is);
    if (budgets != 0 && !rows_.empty())
      for (const ReportCase& is : time_budget_cases(cases[0], rows_[0].frame.median)) add(is);
    progress_("measuring", 1, 1);
    write();
    kept_.remove();
  }

 private:
  static std::vector<std::string> words(const Arguments& arguments) {
    std::vector<std::string> found = {arguments.quick  ? "--quick"
                                      : arguments.full ? "--full"
                                                       : "standard"};
    if (arguments.size.width != 0)
      found.push_back(fmt::format("--size {}x{}", arguments.size.width, arguments.size.height));
    if (arguments.backend.multiprocessors != 0)
      found.push_back(fmt::format("--sms {}", arguments.backend.multiprocessors));
    found.push_back(fmt::format("--target {:.4g}", arguments.target));
    return found;
  }

  ReportSubject subject() const {
    ReportSubject subject;
    subject.flat = scenes_.own()->flat();
    subject.sh_degree = scenes_.own()->sh_degree;
    subject.storages = scenes_.storages();
    const bool cuda = backend_->rates().bytes > 0;
    subject.exponentials = {Exponential::exact, Exponential::ex2, Exponential::lut};
    if (cuda) subject.exponentials.push_back(Exponential::half2);
    subject.baseline = cuda;
    return subject;
  }

  void add(const ReportCase& is) {
    const size_t frames = measurement_.frames_drawn();
    std::optional<KeptRow> kept = kept_.find(is);
    if (!kept) {
      const size_t width = plan_.path[plan_.compared[0]].eyes[0].camera.width;
      KeptRow found{measurement_.run(is,
                                     [&](size_t drawn) {
                                       progress_("measuring", done_ * frames + drawn,
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
    pictures_.push_back({{"image", kept->picture}, {"FLIP against all leaves", kept->difference}});
  }

  std::string recommendation(std::optional<size_t> best, size_t fastest) const {
    if (best)
      return fmt::format(
          "For {:.4g} ms a frame: {} (SH degree {}, {}). It takes {:.3f} ms, {:.3f} at p95, for a "
          "FLIP of {:.4f} against all leaves.",
          arguments_.target, render_options(rows_[*best].is, rows_[*best].tau),
          rows_[*best].is.sh_degree, storage_name(rows_[*best].is.storage),
          rows_[*best].frame.median, rows_[*best].frame.p95, rows_[*best].all.flip);
    return fmt::format(
        "Nothing that was measured stays within {:.4g} ms at p95. The fastest, {}, takes {:.3f} "
        "ms, "
        "{:.3f} at p95.",
        arguments_.target, render_options(rows_[fastest].is, rows_[fastest].tau),
        rows_[fastest].frame.median, rows_[fastest].frame.p95);
  }

  std::string method() const {
    const auto& camera = plan_.path[0].eyes[0].camera;
    return fmt::format(
        "{} frames of {} x {} along the cameras, {} times after a start on the first {}; errors "
        "over "
        "{} of them, against the float64 reference. Figures:",
        plan_.path.size(), camera.width, camera.height, plan_.repeats,
        std::min<size_t>(plan_.path.size(), 32), plan_.compared.size());
  }

  void write_text(const std::string& name, const std::string& text) {
    AtomicFile file(output_.place(name));
    file.write(std::as_bytes(std::span(text)));
    file.commit();
  }

  void write() {
    const std::vector<size_t> front = pareto_front(rows_);
    const auto best = recommend(rows_, front, arguments_.target);
    const std::string advice = recommendation(best, front.front());
    const auto stem = [](const std::string& path) {
      return std::filesystem::path(path).filename().replace_extension().string();
    };
    write_text("report.csv", report_csv({stem(arguments_.scene), stem(arguments_.cameras),
                                         backend_->device_name()},
                                        rows_));
    Json json = {{"provenance", provenance_}, {"method", method()}, {"rows", Json::array()}};
    for (const ReportRow& row : rows_) json["rows"].push_back(to_json(row));
    json["front"] = front;
    json["target_ms"] = arguments_.target;
    json["recommended"] = best ? Json(*best) : Json();
    json["recommendation"] = advice;
    write_text("report.json", json.dump(1) + "\n");
    ReportPage page{"Error against run time: " + stem(arguments_.scene),
                    provenance_,
                    method(),
                    advice,
                    report_plots(rows_, front),
                    rows_,
                    front,
                    {}};
    for (const size_t i : front) page.shown.push_back({i, pictures_[i]});
    write_text("report.html", html(page));
    for (const PagePlot& plot : page.plots) write_plot_png(output_.place(plot.file), plot.plot);
    output_.commit();
    fmt::print("{}\n{}/report.html\n", advice, arguments_.output);
  }

  const Arguments& arguments_;
  const Extent extent_;
  OutputFolder output_;
  Workers workers_;
  const Progress progress_ = progress_bar();
  std::unique_ptr<Backend> backend_;
  const ReportPlan plan_;
  const Json provenance_;
  KeptRows kept_;
  ReportScenes scenes_;
  ReferenceImages references_;
  std::unique_ptr<EnergyMeter> energy_;
  Measurement measurement_;
  size_t done_ = 0, total_ = 1;
  std::vector<ReportRow> rows_;
  std::vector<std::vector<PagePicture>> pictures_;
};

}  // namespace

void add_report(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "report", "Measure error against run time, for this scene on this machine");
  command->add_option("scene", arguments->scene, "A .voy, .ply or .spz")->required();
  command->add_option("--cameras", arguments->cameras, "INRIA cameras.json, as one walk")
      ->required();
  command
      ->add_option("-o", arguments->output,
                   "The folder for report.html, report.csv, report.json and the plots. A report "
                   "that was ended goes on from there when it is run again")
      ->required();
  CLI::Option* quick = command->add_flag("--quick", arguments->quick, "Some configurations");
  command->add_flag("--full", arguments->full, "Many, each timed for longer")->excludes(quick);
  command
      ->add_option("--target", arguments->target,
                   "Milliseconds that a frame may take, for the recommendation (11.1: 90 Hz)")
      ->check(CLI::Range(0.01, 10000.0))
      ->type_name("MS");
  add_backend_options(*command, arguments->backend);
  add_size_option(*command, arguments->size);
  command->footer("Example: voyager report city.voy --cameras city.cameras.json -o report");
  command->callback([arguments] { Report(*arguments).run(); });
}

}  // namespace voyager::tools
