#include "tools/report/kept_files.h"

#include <fmt/core.h>

#include "tools/lod_options.h"

namespace voyager::tools {
namespace {

constexpr std::string_view kRow = "row-", kReference = "reference-", kTruth = "truth-",
                           kImage = ".f32";
constexpr size_t kMarkDigits = 16;

bool is_row(std::string_view name) {
  if (!name.starts_with(kRow)) return false;
  name.remove_prefix(kRow.size());
  const size_t digits = std::min(name.find_first_not_of("0123456789abcdef"), name.size());
  const std::string_view ending = name.substr(digits);
  return digits == kMarkDigits &&
         (ending == kRowFigures || ending == kRowPicture || ending == kRowDifference);
}

}  // namespace

std::string kept_row_name(uint64_t mark, const char* ending) {
  return fmt::format("{}{:0{}x}{}", kRow, mark, kMarkDigits, ending);
}

std::string kept_reference_name(size_t frame, Lod lod, double tau) {
  return fmt::format("{}{}-{}-tau{:.17g}{}", kReference, frame, select_name(lod), tau, kImage);
}

std::string kept_truth_name(size_t frame) {
  return fmt::format("{}{}{}", kTruth, frame, kImage);
}

bool is_kept_file(std::string_view name) {
  return is_row(name) ||
         ((name.starts_with(kReference) || name.starts_with(kTruth)) && name.ends_with(kImage)) ||
         name == kLosslessScene || name == kCompactScene || name == kSceneLeaves;
}

}  // namespace voyager::tools
