#include "runtime/bake/work_files.h"

#include <algorithm>
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

bool is_work_file(std::string_view name) {
  if (is_one_of(name, {kPositionRows, kOtherRows, kSpoolDone, kSplitDone, kMerged})) return true;
  if (!name.starts_with(kCell)) return false;
  name.remove_prefix(kCell.size());
  const size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
  return digits > 0 && is_one_of(name.substr(digits), {kRows, kTree, kLeaves, kChunks});
}

}  // namespace voyager
