#include "tools/report/report_row.h"

#include <cmath>

#include "runtime/frame/backend.h"
#include "tools/frame_rows.h"
#include "tools/lod_options.h"
#include "voyager/voyager.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json number(const std::optional<double>& value) {
  return value ? number(*value) : Json();
}

std::optional<double> optional_of(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

double number_of(const Json& json) {
  return json.is_null() ? INFINITY : json.get<double>();
}

ReportError error_of(const Json& json) {
  ReportError error;
  error.psnr = number_of(json["psnr_db"]);
  error.ssim = optional_of(json["ssim"]);
  error.flip = json["flip"];
  error.largest = json["max_abs"];
  error.p999 = json["p999_abs"];
  error.popping = optional_of(json["popping"]);
  error.not_finite = json.at("not_finite");
  return error;
}

Json to_json(const ReportTimes& times) {
  return {{"median", times.median}, {"p95", times.p95}, {"p99", times.p99}};
}

ReportTimes times_of(const Json& json) {
  return {json["median"], json["p95"], json["p99"]};
}

Json choices(const ReportCase& is) {
  const bool cut = draws_cut(is.desc.lod);
  return {{"lod", cut ? "on" : "off"},
          {"time_budget_ms", is.time_budget > 0 ? Json(is.time_budget) : Json()},
          {"search", cut ? Json(search_name(is.desc.search)) : Json()},
          {"slack", cut && is.desc.search == Search::temporal},
          {"select", select_name(is.desc.lod)},
          {"filter", is.desc.alpha_filter ? "on" : "off"},
          {"splat", splatting_name(is.desc.splatting)},
          {"exp", exponential_name(is.desc.exponential)},
          {"lut_size", is.desc.exponential == Exponential::lut ? Json(is.desc.lut_size) : Json()},
          {"sh_degree", is.sh_degree},
          {"quality", storage_name(is.storage)}};
}

}  // namespace

Json to_json(const ReportError& error) {
  return {{"psnr_db", number(error.psnr)},
          {"ssim", number(error.ssim)},
          {"flip", error.flip},
          {"max_abs", error.largest},
          {"p999_abs", error.p999},
          {"popping", number(error.popping)},
          {"not_finite", error.not_finite}};
}

Json to_json(const ReportRow& row) {
  Json json = {{"name", row.is.name()}, {"group", row.is.group}};
  json.update(choices(row.is));
  json["tau"] = draws_cut(row.is.desc.lod) ? Json(row.tau) : Json();
  json["cut"] = row.cut;
  json["splats"] = row.splats;
  json["pairs"] = row.pairs;
  json["bytes"] = row.bytes;
  json["timed_frames"] = row.timed;
  json["joules"] = number(row.joules);
  json["ms"]["frame"] = to_json(row.frame);
  for (size_t stage = 0; stage < row.stages.size(); ++stage)
    json["ms"][voyStageName(static_cast<VoyStage>(stage))] = to_json(row.stages[stage]);
  json["error"] = to_json(row.same);
  json["total_error"] = to_json(row.truth);
  json["shimmer"] = {{"dolly", number(row.dolly)}, {"turn", number(row.turn)}};
  return json;
}

ReportRow row_from_json(const Json& json, const ReportCase& is) {
  ReportRow row;
  row.is = is;
  row.tau = json["tau"].is_null() ? 0 : json["tau"].get<double>();
  row.cut = json["cut"];
  row.splats = json["splats"];
  row.pairs = json["pairs"];
  row.bytes = json["bytes"];
  row.timed = json["timed_frames"];
  row.joules = optional_of(json["joules"]);
  row.frame = times_of(json["ms"]["frame"]);
  for (int stage = 0; stage < kStageCount; ++stage)
    row.stages.push_back(times_of(json["ms"][voyStageName(static_cast<VoyStage>(stage))]));
  row.same = error_of(json["error"]);
  row.truth = error_of(json["total_error"]);
  row.dolly = optional_of(json["shimmer"]["dolly"]);
  row.turn = optional_of(json["shimmer"]["turn"]);
  return row;
}

}  // namespace voyager::tools
