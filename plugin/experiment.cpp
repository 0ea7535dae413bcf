#include "plugin/experiment.h"

#include "plugin/structs.h"

namespace voyager {
namespace {

constexpr uint32_t kDefaultLutSize = 32, kMaxLutSize = 4096;

Search search_of(VoySearch search) {
  switch (search) {
    case VOY_SEARCH_EXHAUSTIVE:
      return Search::exhaustive;
    case VOY_SEARCH_STREAMING:
      return Search::streaming;
    case VOY_SEARCH_TEMPORAL:
      return Search::temporal;
    case VOY_SEARCH_SWEEP:
      return Search::sweep;
    case VOY_SEARCH_TEMPORAL_VISIT:
      return Search::temporal_visit;
    default:
      return Search::fastest;
  }
}

VoySearch search_of(const FrameStats& stats) {
  if (!stats.searched) return VOY_SEARCH_AUTO;
  switch (stats.search) {
    case Search::exhaustive:
      return VOY_SEARCH_EXHAUSTIVE;
    case Search::streaming:
      return VOY_SEARCH_STREAMING;
    case Search::temporal:
      return VOY_SEARCH_TEMPORAL;
    case Search::temporal_visit:
      return VOY_SEARCH_TEMPORAL_VISIT;
    case Search::sweep:
    case Search::fastest:
      break;
  }
  return VOY_SEARCH_SWEEP;
}

Exponential exponential_of(const VoyExperiment& experiment, VoyBackend backend) {
  switch (experiment.exponential) {
    case VOY_EXPONENTIAL_EXACT:
      return Exponential::exact;
    case VOY_EXPONENTIAL_EX2:
      return Exponential::ex2;
    case VOY_EXPONENTIAL_HALF2:
      return Exponential::half2;
    case VOY_EXPONENTIAL_LUT:
      return Exponential::lut;
    default:
      return backend == VOY_BACKEND_CUDA && experiment.splatting == VOY_SPLATTING_OURS
                 ? Exponential::ex2
                 : Exponential::exact;
  }
}

void check(const VoyExperiment& experiment, const PipelineDesc& choices) {
  check_enum(experiment.selection, VOY_SELECTION_LEVELS, "desc.next.selection");
  check_enum(experiment.search, VOY_SEARCH_SWEEP, "desc.next.search");
  check_enum(experiment.alphaFilter, VOY_ALPHA_FILTER_OFF, "desc.next.alphaFilter");
  check_enum(experiment.exponential, VOY_EXPONENTIAL_HALF2, "desc.next.exponential");
  check_count(experiment.lutSize, 0, kMaxLutSize, "desc.next.lutSize");
  check_enum(experiment.splatting, VOY_SPLATTING_3DGS, "desc.next.splatting");
  check_count(experiment.truth, 0, 1, "desc.next.truth");
  check_count(experiment.reserved, 0, 0, "desc.next.reserved");
  if (experiment.selection != VOY_SELECTION_CUT && choices.lod != Lod::cut)
    refuse("desc.next.selection: found BLOCKS or LEVELS with VOY_LOD_ALL_LEAVES, expected CUT");
  if (experiment.truth == 1 && choices.antialias != Antialias::on)
    refuse("desc.next.truth: found 1 with VOY_ANTIALIAS_OFF, expected 0");
}

// A bit for each enumerant from 0 to last.
template <class Enum>
constexpr uint32_t bits_up_to(Enum last) {
  return (2u << last) - 1;
}

VoyExponential last_exponential(VoyBackend backend) {
  if (backend == VOY_BACKEND_CUDA) return VOY_EXPONENTIAL_HALF2;
  return backend == VOY_BACKEND_CPU ? VOY_EXPONENTIAL_LUT : VOY_EXPONENTIAL_EXACT;
}

}  // namespace

void apply_experiment(const VoyExperiment* wanted, VoyBackend backend, PipelineDesc& choices) {
  const VoyExperiment experiment = wanted ? *wanted : VoyExperiment VOY_EXPERIMENT_INIT;
  check(experiment, choices);
  if (experiment.selection == VOY_SELECTION_BLOCKS) choices.lod = Lod::blocks;
  if (experiment.selection == VOY_SELECTION_LEVELS) choices.lod = Lod::levels;
  choices.search = search_of(experiment.search);
  choices.alpha_filter = experiment.alphaFilter == VOY_ALPHA_FILTER_ON;
  choices.lut_size = experiment.lutSize == 0 ? kDefaultLutSize : experiment.lutSize;
  choices.exponential = exponential_of(experiment, backend);
  if (experiment.splatting == VOY_SPLATTING_3DGS) choices.splatting = Splatting::baseline_3dgs;
  if (experiment.truth == 1) choices.antialias = Antialias::truth;
}

void fill(VoyExperimentCapabilities& out, VoyBackend backend) {
  out.searches = bits_up_to(VOY_SEARCH_SWEEP);
  out.exponentials = bits_up_to(last_exponential(backend));
  out.splattings =
      bits_up_to(backend == VOY_BACKEND_CUDA ? VOY_SPLATTING_3DGS : VOY_SPLATTING_OURS);
  out.reserved = 0;
}

void fill(VoyExperimentStats& out, const FrameStats& stats) {
  out.search = search_of(stats);
  out.redrawCount = stats.redraws;
}

}  // namespace voyager
