#pragma once
// voyager_experiment.h in the runtime's terms.
#include "runtime/frame/backend.h"
#include "voyager/voyager_experiment.h"

namespace voyager {

// Sets the choices of `experiment`, or their defaults if it is NULL; `choices` has the view's own.
// Throws ApiError.
void apply_experiment(const VoyExperiment* experiment, VoyBackend backend, PipelineDesc& choices);

// Those that the backend has; `next` stays.
void fill(VoyExperimentCapabilities& out, VoyBackend backend);

void fill(VoyExperimentStats& out, const FrameStats& stats);

}  // namespace voyager
