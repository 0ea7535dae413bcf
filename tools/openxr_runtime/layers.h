#pragma once
// xrEndFrame's layers: checked, and read back.
#include "session.h"

namespace test_runtime {

// Refuses what breaks a rule; then hands the first projection layer to the run's capture.
void end_with_layers(Session& session, const Frame& frame, const XrFrameEndInfo& info);

}  // namespace test_runtime
