#pragma once
#include "tools/synth/city.h"
#include "tools/synth/layout.h"

namespace voyager::synth {

// The layout that a description leads to. Throws Error(invalid_argument).
Layout city_layout(const CityDesc& desc);

}  // namespace voyager::synth
