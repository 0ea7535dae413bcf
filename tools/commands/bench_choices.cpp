#include "runtime/base/error.h"
#include "tools/commands/bench_arguments.h"

namespace voyager::tools {
namespace {

// --slack without --search chooses the temporal search: no other has slack.
Search chosen_search(const BenchArguments& arguments) {
  switch (arguments.search.value_or(arguments.slack ? SearchChoice::temporal
                                                    : SearchChoice::automatic)) {
    case SearchChoice::automatic:
      return Search::fastest;
    case SearchChoice::sweep:
      return Search::sweep;
    case SearchChoice::exhaustive:
      return Search::exhaustive;
    case SearchChoice::streaming:
      return Search::streaming;
    case SearchChoice::temporal:
      break;
    case SearchChoice::all:
      throw Error(ErrorCode::invalid_argument,
                  "--search: found all, expected one search (--stages all without another choice "
                  "compares them)");
  }
  return arguments.slack.value_or(true) ? Search::temporal : Search::temporal_visit;
}

}  // namespace

// 3DGS has expf only.
PipelineDesc chosen_desc(const BenchArguments& arguments, const BenchSubject& subject) {
  PipelineDesc desc;
  desc.lod = arguments.lod.value();
  const Search asked = chosen_search(arguments);
  desc.search = desc.lod == Lod::cut ? subject.backend.search_for(*subject.scene, asked)
                                     : without_sweep(asked);
  desc.splatting = arguments.splatting.value_or(Splatting::ours);
  const bool ours = desc.splatting == Splatting::ours;
  desc.alpha_filter = ours && arguments.filter.value_or(true);  // 3DGS has none
  desc.exponential = arguments.exponential.value_or(ours ? Exponential::ex2 : Exponential::exact);
  desc.antialias = arguments.antialias;
  desc.occlusion = arguments.occlusion;
  desc.lut_size = arguments.lut_size.value_or(desc.lut_size);
  return desc;
}

size_t chosen_repeats(const BenchArguments& arguments, size_t frames) {
  constexpr size_t kFewestFrames = 100;
  return arguments.repeat.value_or((kFewestFrames + frames - 1) / frames);
}

}  // namespace voyager::tools
