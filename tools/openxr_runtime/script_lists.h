#pragma once
// The script's lists: frames, events, input, failures. All throw std::runtime_error naming the
// field.
#include "script.h"

namespace test_runtime {

Pose read_pose(const Reader& json);  // position and orientation (x, y, z, w)
void read_ranges(const Reader& json, const std::string& name, Ranges& ranges);
std::vector<Event> read_events(const Reader& json);  // in the order of frames
std::vector<Input> read_inputs(const Reader& json);  // in the order of frames
std::vector<Failure> read_failures(const Reader& json);

}  // namespace test_runtime
