#pragma once
// What `voyager bench` was asked, and the runs behind it.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "runtime/frame/backend.h"
#include "tools/cameras.h"
#include "tools/commands/measured_backend.h"
#include "tools/image_size.h"
#include "tools/lod_options.h"

namespace voyager::tools {

enum class BenchStages { search, splat, all };
enum class SearchChoice { all, automatic, exhaustive, streaming, temporal, sweep };

// Options that were not given have no value where that means something else than a default.
struct BenchArguments {
  std::string scene, cameras, json;
  std::optional<BenchStages> stages_asked;
  BenchStages stages = BenchStages::search;  // whole frames where only these can be meant
  BackendChoice backend;
  LodChoice lod;
  std::optional<SearchChoice> search;
  std::optional<bool> slack, filter;
  std::optional<Splatting> splatting;
  std::optional<Exponential> exponential;
  Antialias antialias = Antialias::on;
  Occlusion occlusion = Occlusion::automatic;
  std::optional<uint32_t> lut_size;
  std::optional<size_t> repeat;
  bool verify = false, stereo = false, close_up = false;
  double tau = 3;
  double time_budget = 0;  // milliseconds; 0: tau is fixed
  ImageSize size;
};

struct BenchSubject {
  std::shared_ptr<const Scene> scene;
  Backend& backend;
  std::vector<Camera> cameras;
  Workers& workers;
};

// Of whole frames; what is not chosen is as in the row "ours". The search is the one that runs.
PipelineDesc chosen_desc(const BenchArguments& arguments, const BenchSubject& subject);
// How often a path of so many frames is timed: enough that a median means something.
size_t chosen_repeats(const BenchArguments& arguments, size_t frames);

// Each prints a table and gives its part of the report.
nlohmann::ordered_json bench_searches(const BenchArguments& arguments, const BenchSubject& subject);
nlohmann::ordered_json bench_frames(const BenchArguments& arguments, const BenchSubject& subject);
nlohmann::ordered_json bench_stereo(const BenchArguments& arguments, const BenchSubject& subject);

}  // namespace voyager::tools
