#include "tools/report/report_csv.h"

#include <fmt/core.h>

#include "tools/frame_rows.h"
#include "tools/lod_options.h"
#include "tools/report/csv_line.h"
#include "voyager/voyager.h"

namespace voyager::tools {
namespace {

const char* const kColumns[] = {
    "scene",         "camera_set",   "backend",       "group",          "lod",
    "tau",           "search",       "select",        "filter",         "splat",
    "exp",           "lut_size",     "sh_degree",     "quality",        "time_budget_ms",
    "cut",           "splats",       "pairs",         "psnr_ref_db",    "psnr_truth_db",
    "ssim",          "flip",         "max_abs",       "p999_abs",       "popping",
    "ssim_truth",    "flip_truth",   "max_abs_truth", "p999_abs_truth", "popping_truth",
    "shimmer_dolly", "shimmer_turn", "ms_median",     "ms_p95",         "ms_p99",
    "bytes",         "joules"};

void add_choices(CsvLine& line, const ReportRow& row) {
  const PipelineDesc& desc = row.is.desc;
  const bool cut = draws_cut(desc.lod);
  line.text(row.is.group).text(cut ? "on" : "off").where(cut, row.tau);
  line.where(cut, std::string(search_name(desc.search)) +
                      (desc.search == Search::temporal_visit ? " without slack" : ""));
  line.text(select_name(desc.lod)).text(desc.alpha_filter ? "on" : "off");
  line.text(splatting_name(desc.splatting)).text(exponential_name(desc.exponential));
  line.where(desc.exponential == Exponential::lut, desc.lut_size);
  line.number(row.is.sh_degree).text(storage_name(row.is.storage));
  line.where(row.is.time_budget > 0, row.is.time_budget);
}

void add_errors(CsvLine& line, const ReportError& error) {
  line.number(error.ssim).number(error.flip);
  line.number(error.largest).number(error.p999).number(error.popping);
}

}  // namespace

std::string report_csv(const ReportNames& names, const std::vector<ReportRow>& rows) {
  CsvLine header;
  for (const char* column : kColumns) header.text(column);
  std::string csv = header.take();
  for (size_t stage = 0; stage < static_cast<size_t>(kStageCount); ++stage)
    csv.insert(csv.size() - 1,
               fmt::format(",ms_{}_median", voyStageName(static_cast<VoyStage>(stage))));
  csv.insert(csv.size() - 1, ",not_finite");
  for (const ReportRow& row : rows) {
    CsvLine line;
    line.text(names.scene).text(names.camera_set).text(names.backend);
    add_choices(line, row);
    line.number(row.cut).number(row.splats).number(row.pairs);
    line.decibels(row.same.psnr);
    line.decibels(row.truth.psnr);
    add_errors(line, row.same);
    add_errors(line, row.truth);
    line.number(row.dolly).number(row.turn);
    line.number(row.frame.median).number(row.frame.p95).number(row.frame.p99);
    line.where(row.bytes > 0, row.bytes).number(row.joules);
    for (const ReportTimes& stage : row.stages) line.number(stage.median);
    line.number(static_cast<double>(row.not_finite()));
    csv += line.take();
  }
  return csv;
}

}  // namespace voyager::tools
