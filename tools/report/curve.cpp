#include "tools/report/curve.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/format/reader.h"
#include "runtime/scene/import/importer.h"
#include "tools/console.h"
#include "tools/output_folder.h"
#include "tools/progress_bar.h"
#include "tools/report/curve_measure.h"
#include "tools/report/curve_page.h"
#include "tools/report/curve_text.h"
#include "tools/report/provenance.h"
#include "tools/report/report_plan.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

// Reads the file's header alone.
uint32_t leaf_count(const std::string& path) {
  const std::shared_ptr<const ByteSource> source = open_source(path);
  std::array<std::byte, 64> buffer;
  const std::span<std::byte> first =
      std::span(buffer).first(std::min<uint64_t>(buffer.size(), source->size()));
  source->read(0, first);
  if (is_importable(first, source->name()))
    throw Error(ErrorCode::invalid_argument,
                "--curve: found the flat scene " + source->name() + ", expected a .voy: its tree");
  return SceneFile(source).info().leaf_count;
}

void require_one_scene(const std::vector<std::string>& trees) {
  const uint32_t expected = leaf_count(trees[0]);
  for (const std::string& tree : trees) {
    const uint32_t found = leaf_count(tree);
    if (found != expected)
      throw Error(
          ErrorCode::refused_input,
          fmt::format("{}: found {} leaves, expected {} as in {}: trees of one scene",
                      open_source(tree)->name(), found, expected, open_source(trees[0])->name()));
  }
}

// File names without their ends, each its own.
std::vector<std::string> names_of(const std::vector<std::string>& trees) {
  std::vector<std::string> names;
  for (const std::string& tree : trees) {
    const std::string stem =
        std::filesystem::path(open_source(tree)->name()).filename().replace_extension().string();
    std::string name = stem;
    for (int i = 2; std::find(names.begin(), names.end(), name) != names.end(); ++i)
      name = fmt::format("{} ({})", stem, i);
    names.push_back(name);
  }
  return names;
}

void write_text(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

constexpr const char* kCsv = "curve.csv";
constexpr const char* kJson = "curve.json";
constexpr const char* kPage = "curve.html";

std::vector<std::string> inputs_of(const CurveRequest& request) {
  std::vector<std::string> inputs = request.trees;
  inputs.push_back(request.cameras);
  return inputs;
}

class CurveReport {
 public:
  CurveReport(const CurveRequest& request, Backend& backend)
      : request_(request),
        backend_(backend),
        output_(request.output, inputs_of(request)),
        plan_(curve_plan(request.cameras, request.size, request.extent)) {
    for (const char* name : {kCsv, kJson, kPage}) output_.require_place(name);
    for (const char* name : kCurvePlotFiles) output_.require_place(name);
    require_one_scene(request.trees);
    names_ = names_of(request.trees);
    provenance_ = provenance(request.trees[0], request.cameras, backend, request.arguments);
    for (size_t i = 0; i < names_.size(); ++i) {
      Json tree = {{"tree", names_[i]}};
      tree.update(file_identity(*open_source(request.trees[i])));
      provenance_["trees"].push_back(tree);
    }
  }

  // One tree at a time is in memory.
  void run() {
    note("measuring on " + backend_.device_name());
    std::optional<CurveMeasurement> measurement;
    const size_t steps = std::size(kCurveShares) * plan_.compared.size() * names_.size();
    size_t done = 0;
    for (size_t i = 0; i < names_.size(); ++i) {
      if (done == 0) progress_("opening", 0, 0);
      const std::shared_ptr<const Scene> scene =
          load_scene(open_source(request_.trees[i]), std::pmr::get_default_resource(), workers_);
      if (!measurement) measurement.emplace(backend_, scene, plan_, workers_);
      const std::vector<CurveRow> rows =
          measurement->run(names_[i], scene, [&] { progress_("measuring", ++done, steps); });
      rows_.insert(rows_.end(), rows.begin(), rows.end());
    }
    write();
  }

 private:
  void write() {
    const std::vector<Curve> curves = mean_curves(rows_);
    const std::string method = curve_method_text(plan_, names_[0], backend_);
    Json json = {{"provenance", provenance_},
                 {"method", method},
                 {"rows", Json::array()},
                 {"means", Json::array()}};
    for (const CurveRow& row : rows_) json["rows"].push_back(to_json(row));
    for (const Curve& curve : curves)
      for (const CurveRow& mean : curve.means) json["means"].push_back(to_json(mean));
    write_text(output_.place(kCsv), curve_csv(rows_));
    write_text(output_.place(kJson),
               json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    const std::vector<PagePlot> plots = curve_plots(rows_, curves);
    write_text(output_.place(kPage), html(CurvePage{provenance_, method, plots, rows_, curves}));
    for (const PagePlot& plot : plots) write_plot_png(output_.place(plot.file), plot.plot);
    output_.commit();
    say(fmt::format("{}{}/{}\n", curve_table(curves), request_.output, kPage));
  }

  const CurveRequest& request_;
  Backend& backend_;
  OutputFolder output_;
  const ReportPlan plan_;
  Workers workers_;
  const Progress progress_ = progress_bar();
  std::vector<std::string> names_;
  Json provenance_;
  std::vector<CurveRow> rows_;
};

}  // namespace

void make_curve(const CurveRequest& request, Backend& backend) {
  CurveReport(request, backend).run();
}

}  // namespace voyager::tools
