#pragma once
// The files of a work folder, by name: nothing else is ever removed from it. docs/baking.md says
// what is in each.
#include <cstdint>
#include <string>
#include <string_view>

namespace voyager {

inline constexpr const char* kPositionRows = "positions";
inline constexpr const char* kOtherRows = "words";
inline constexpr const char* kSpoolDone = "spool";
inline constexpr const char* kSplitDone = "split";
inline constexpr const char* kMerged = "merged";

std::string cell_rows_name(uint32_t cell);
// Child counts and topmost nodes of a cell: what all cells need of each other. It is
// written last: a cell that has it is built.
std::string cell_tree_name(uint32_t cell);
// The rest of the layout: which Gaussian each leaf is, and how it shows.
std::string cell_leaves_name(uint32_t cell);
std::string cell_chunks_name(uint32_t cell);

// Of a bake that has cut the scene into `cells`; 0 before that.
bool is_work_file(std::string_view name, uint32_t cells);

}  // namespace voyager
