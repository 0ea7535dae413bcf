#include "tools/frame_report.h"

#include "tools/frame_floor.h"
#include "tools/lod_options.h"
#include "tools/statistics.h"
#include "voyager/voyager.h"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

// Search to rasterize: resolve, which hands the image out, is apart.
constexpr int kFrameEnd = kResolve;

double time_between(const FrameStats& stats, int first, int end) {
  double sum = 0;
  for (int stage = first; stage < end; ++stage) sum += stats.milliseconds[stage];
  return sum;
}

const char* stage_name(int stage) {
  return voyStageName(static_cast<VoyStage>(stage));
}

// reduce(samples) of the frame, of splatting (project to rasterize) and of every stage.
template <class Reduce>
Json times(const std::vector<FrameStats>& frames, const Reduce& reduce) {
  const auto between = [&](int first, int end) {
    std::vector<double> samples;
    samples.reserve(frames.size());
    for (const FrameStats& stats : frames) samples.push_back(time_between(stats, first, end));
    return reduce(samples);
  };
  Json json = {{"frame", between(kSearch, kFrameEnd)}, {"splat", between(kProject, kFrameEnd)}};
  for (int stage = 0; stage < kStageCount; ++stage)
    json[stage_name(stage)] = between(stage, stage + 1);
  return json;
}

template <class Value>
double mean(const std::vector<FrameStats>& frames, const Value& value) {
  double sum = 0;
  for (const FrameStats& stats : frames) sum += static_cast<double>(value(stats));
  return frames.empty() ? 0 : sum / static_cast<double>(frames.size());
}

double mean(const std::vector<FrameStats>& frames, uint64_t FrameStats::*counter) {
  return mean(frames, [&](const FrameStats& stats) { return stats.*counter; });
}

double mean_bytes(const FrameRun& run, int stage) {
  return mean(run.timed, [&](const FrameStats& stats) { return stats.bytes[stage]; });
}

Json choices(const FrameRow& row, const ReportContext& context) {
  const PipelineDesc& desc = row.desc;
  const bool searched = draws_cut(desc.lod) && !context.flat;
  const bool ours = desc.splatting == Splatting::ours;
  Json json = {{"name", row.name}, {"lod", draws_cut(desc.lod) ? "on" : "off"}};
  json["select"] = select_name(searched ? desc.lod : Lod::all_leaves);
  json["search"] = searched ? Json(search_name(desc.search)) : Json();
  json["slack"] = searched && desc.search == Search::temporal;
  json["splat"] = splatting_name(desc.splatting);
  json["filter"] = ours && desc.alpha_filter ? "on" : "off";
  json["antialias"] = desc.antialias == Antialias::off ? "off" : "on";
  json["exp"] = exponential_name(desc.exponential);
  json["lut_size"] = desc.exponential == Exponential::lut ? Json(desc.lut_size) : Json();
  return json;
}

Json counters(const FrameRun& run) {
  Json json = {{"nodes_tested", mean(run.timed, &FrameStats::nodes_tested)},
               {"cut", mean(run.timed, &FrameStats::cut_size)},
               {"splats", mean(run.timed, &FrameStats::splats)},
               {"pairs_before", mean(run.timed, &FrameStats::pairs_before)},
               {"pairs_after", mean(run.timed, &FrameStats::pairs_after)},
               {"tiles_redrawn", mean(run.timed, &FrameStats::tiles_redrawn)},
               {"pairs_dropped", mean(run.timed, &FrameStats::pairs_dropped)},
               {"pixels_evaluated", nullptr},
               {"pixels_blended", nullptr},
               {"list_places", nullptr},
               {"list_places_read", nullptr}};
  if (!run.counted.empty()) {
    json["pixels_evaluated"] = mean(run.counted, &FrameStats::pixels_evaluated);
    json["pixels_blended"] = mean(run.counted, &FrameStats::pixels_blended);
    json["list_places"] = mean(run.counted, &FrameStats::pairs_after);
    json["list_places_read"] = mean(run.counted, &FrameStats::places_read);
  }
  return json;
}

FrameWork work_of(const FrameRun& run, const ReportContext& context) {
  FrameWork work;
  work.cut = mean(run.timed, &FrameStats::cut_size);
  work.splats = mean(run.timed, &FrameStats::splats);
  work.pairs = mean(run.timed, &FrameStats::pairs_after);
  work.pixels_blended = mean(run.counted, &FrameStats::pixels_blended);
  for (const FrameInput& frame : context.path.frames)
    for (const FrameEye& eye : frame.eyes)
      work.pixels += double{1} * eye.camera.width * eye.camera.height /
                     static_cast<double>(context.path.frames.size());
  work.pixel_bytes = static_cast<double>(pixel_bytes(ColorFormat::rgba8));
  work.attribute_bytes =
      attribute_bytes(mean(run.timed, [](const FrameStats& stats) { return stats.gaussian_bytes; }),
                      context.sh_degree);
  return work;
}

// Without pixel counts neither the blend's floor nor the frame's is known.
Json floor_json(const FrameWork& work, bool counted, const DeviceRates& rates) {
  const FrameFloor floor = frame_floor(work, rates);
  return {{"project", floor.project},
          {"sort", floor.sort},
          {"blend", counted ? Json(floor.blend) : Json()},
          {"out", floor.out},
          {"frame", counted ? Json(floor.frame()) : Json()}};
}

Json ratio(const Json& value, double to) {
  return value.is_null() || to <= 0 ? Json() : Json(value.get<double>() / to);
}

Json floor_and_scores(const FrameWork& work, bool counted, const Json& ms,
                      const DeviceRates& rates) {
  if (rates.bytes <= 0 || rates.lane_instructions <= 0) return nullptr;
  const auto median = [&](int stage) { return ms[stage_name(stage)]["median"].get<double>(); };
  const Json floor = floor_json(work, counted, rates);
  return {{"attribute_bytes", work.attribute_bytes},
          {"ms", floor},
          {"score",
           {{"project", ratio(floor["project"], median(kProject))},
            {"sort", ratio(floor["sort"], median(kSort) + median(kBin))},
            {"rasterize", ratio(floor["blend"], median(kRasterize))},
            {"frame", ratio(floor["frame"], ms["frame"]["median"].get<double>())}}}};
}

// The model's floors, and those of the bytes that the stages really move.
Json orin(const FrameWork& work, const FrameRun& run) {
  Json stages;
  double moved = 0;
  for (int stage = 0; stage < kFrameEnd; ++stage) {
    const double bytes = mean_bytes(run, stage);
    const double blended = stage == kRasterize ? work.pixels_blended : 0;
    const bool known = bytes > 0 || stage == kSearch;  // a view may have nothing to search
    stages[stage_name(stage)] =
        known ? Json(stage_floor(bytes, blended * kBlendInstructions, kOrin)) : Json();
    moved += bytes;
  }
  return {{"model_ms", floor_json(work, !run.counted.empty(), kOrin)},
          {"stage_ms", moved > 0 ? stages : Json()}};
}

// Medians of each camera, where it was drawn more than once.
Json cameras(const FrameRun& run, const ReportContext& context) {
  Json json = Json::array();
  const size_t count = context.path.frames.size();
  for (size_t camera = 0; camera < count; ++camera) {
    std::vector<FrameStats> frames;
    for (size_t i = camera; i < run.timed.size(); i += count) frames.push_back(run.timed[i]);
    json.push_back(
        {{"index", camera},
         {"ms", times(frames, [](const auto& samples) { return percentile(samples, 0.5); })},
         {"splats", frames[0].splats},
         {"pairs_after", frames[0].pairs_after}});
  }
  return json;
}

}  // namespace

Json report_row(const FrameRow& row, const FrameRun& run, const ReportContext& context) {
  Json json = choices(row, context);
  json["ms"] = times(run.timed, [](const auto& samples) { return summary(samples); });
  json["counters"] = counters(run);
  for (int stage = 0; stage < kStageCount; ++stage)
    json["bytes"][stage_name(stage)] = mean_bytes(run, stage);
  const bool counted = !run.counted.empty();
  const FrameWork work = work_of(run, context);
  const double evaluated = mean(run.counted, &FrameStats::pixels_evaluated);
  json["work_efficiency"] = evaluated > 0 ? Json(work.pixels_blended / evaluated) : Json();
  json["floor"] = floor_and_scores(work, counted, json["ms"], context.rates);
  json["orin"] = orin(work, run);
  if (context.path.repeats > 1) json["cameras"] = cameras(run, context);
  return json;
}

void add_speedups(Json& rows) {
  const auto frame_of = [](const Json& row) { return row["ms"]["frame"]["median"].get<double>(); };
  for (const char* name : {"base", "3dgs"}) {
    Json slower;
    for (const Json& row : rows)
      if (row["name"] == name) slower = frame_of(row);
    for (Json& row : rows) row["speedup"][name] = ratio(slower, frame_of(row));
  }
}

void add_error(Json& row, const ImageError& error, size_t images) {
  // JSON has no infinity.
  row["error"] = {{"psnr", std::isfinite(error.psnr) ? Json(error.psnr) : Json()},
                  {"largest", error.largest},
                  {"images", images}};
}

}  // namespace voyager::tools
