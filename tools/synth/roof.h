#pragma once
#include "tools/synth/pieces.h"

namespace voyager::synth {

// Flat with a parapet and machines on it, gable or hip, as the building says.
void add_roof(Surfaces& out, const Building& building, const Vec3f& wall, const Vec3f& trim);

}  // namespace voyager::synth
