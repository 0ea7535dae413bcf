#pragma once
// The files that a report keeps in its hidden folder, by name: nothing else is ever removed from
// it.
#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/frame/draw_list.h"

namespace voyager::tools {

// Of a row: its figures, its picture, the difference of that from what it is compared with.
inline constexpr const char* kRowFigures = ".json";
inline constexpr const char* kRowPicture = ".png";
inline constexpr const char* kRowDifference = ".difference.png";
std::string kept_row_name(uint64_t mark, const char* ending);

// An image of the reference.
std::string kept_reference_name(size_t frame, Lod lod, double tau);

// The truth of a frame.
std::string kept_truth_name(size_t frame);

// The scene in the storages that its own file lacks, and what these are baked from.
inline constexpr const char* kLosslessScene = "lossless.voy";
inline constexpr const char* kCompactScene = "compact.voy";
inline constexpr const char* kSceneLeaves = "leaves.ply";

bool is_kept_file(std::string_view name);

}  // namespace voyager::tools
