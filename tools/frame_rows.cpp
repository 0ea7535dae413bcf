#include "tools/frame_rows.h"

#include <fmt/core.h>

#include "tools/lod_options.h"

namespace voyager::tools {
namespace {

PipelineDesc baseline(Lod lod, Search search) {
  PipelineDesc desc;
  desc.lod = lod;
  desc.search = search;
  desc.splatting = Splatting::baseline_3dgs;
  desc.alpha_filter = false;
  return desc;
}

PipelineDesc ours(Search search, Exponential exponential) {
  PipelineDesc desc;
  desc.search = search;
  desc.exponential = exponential;
  return desc;
}

}  // namespace

std::vector<FrameRow> ablation_rows(Search fastest) {
  return {{"3dgs", baseline(Lod::all_leaves, Search::exhaustive)},
          {"base", baseline(Lod::cut, Search::exhaustive)},
          {"+ streaming", baseline(Lod::cut, Search::streaming)},
          {"+ temporal", baseline(Lod::cut, Search::temporal_visit)},
          {"+ alpha-filter", ours(Search::temporal_visit, Exponential::exact)},
          {"+ lut", ours(Search::temporal_visit, Exponential::lut)},
          {"ours", ours(fastest, Exponential::ex2)}};
}

std::vector<FrameRow> exponential_rows(PipelineDesc desc) {
  std::vector<FrameRow> rows;
  desc.exponential = Exponential::exact;
  rows.push_back({"exact", desc});
  desc.exponential = Exponential::ex2;
  rows.push_back({"ex2", desc});
  desc.exponential = Exponential::half2;
  rows.push_back({"half2", desc});
  desc.exponential = Exponential::lut;
  for (const uint32_t size : {8u, 16u, 32u, 64u, 128u}) {
    desc.lut_size = size;
    rows.push_back({fmt::format("lut {}", size), desc});
  }
  return rows;
}

FrameRow chosen_row(const PipelineDesc& desc, bool flat) {
  const bool searched = draws_cut(desc.lod) && !flat;
  std::string name =
      fmt::format("{}, {}, {}", searched ? search_name(desc.search) : "all leaves",
                  splatting_name(desc.splatting), exponential_name(desc.exponential));
  if (searched && desc.lod != Lod::cut) name = select_name(desc.lod) + (", " + name);
  if (desc.exponential == Exponential::lut) name += fmt::format(" {}", desc.lut_size);
  return {name, desc};
}

const char* search_name(Search search) {
  switch (search) {
    case Search::exhaustive:
      return "exhaustive";
    case Search::streaming:
      return "streaming";
    case Search::temporal:
    case Search::temporal_visit:
    case Search::fastest:  // never in a row
      return "temporal";
    case Search::sweep:
      break;
  }
  return "sweep";
}

const char* exponential_name(Exponential exponential) {
  switch (exponential) {
    case Exponential::ex2:
      return "ex2";
    case Exponential::lut:
      return "lut";
    case Exponential::half2:
      return "half2";
    case Exponential::exact:
      break;
  }
  return "exact";
}

const char* splatting_name(Splatting splatting) {
  return splatting == Splatting::ours ? "ours" : "3dgs";
}

}  // namespace voyager::tools
