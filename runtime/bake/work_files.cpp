#include "runtime/bake/work_files.h"

#include <algorithm>
#include <charconv>
#include <initializer_list>

namespace voyager {
namespace {

constexpr std::string_view kCell = "cell-", kRows = ".rows", kTree = ".tree", kLeaves = ".leaves",
                           kChunks = ".chunks";

std::string cell_name(uint32_t cell, std::string_view ending) {
  return std::string(kCell) + std::to_string(cell) + std::string(ending);
}

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string cell_rows_name(uint32_t cell) {
  return cell_name(cell, kRows);
}

std::string cell_tree_name(uint32_t cell) {
  return cell_name(cell, kTree);
}

std::string cell_leaves_name(uint32_t cell) {
  return cell_name(cell, kLeaves);
}

std::string cell_chunks_name(uint32_t cell) {
  return cell_name(cell, kChunks);
}

bool is_work_file(std::string_view name, uint32_t cells) {
  if (is_one_of(name, {kPositionRows, kOtherRows, kSpoolDone, kSplitDone, kMerged})) return true;
  if (!name.starts_with(kCell)) return false;
  uint32_t cell = 0;
  const std::string_view number = name.substr(kCell.size());
  const auto end = std::from_chars(number.data(), number.data() + number.size(), cell).ptr;
  const std::string_view ending = number.substr(static_cast<size_t>(end - number.data()));
  return cell < cells && is_one_of(ending, {kRows, kTree, kLeaves, kChunks}) &&
         name == cell_name(cell, ending);
}

}  // namespace voyager
