#include "tools/view/refusal.h"

#include <new>

#include "tools/console.h"
#include "voyager/voyager.hpp"

namespace voyager::view {
namespace {

// One that has the same exit code.
ErrorCode code_of(VoyResult result) {
  switch (result) {
    case VOY_ERROR_INVALID_ARGUMENT:
    case VOY_ERROR_UNSUPPORTED:
      return ErrorCode::invalid_argument;
    case VOY_ERROR_FILE_NOT_FOUND:
    case VOY_ERROR_REFUSED_INPUT:
      return ErrorCode::refused_input;
    case VOY_ERROR_DAMAGED_CHUNK:
      return ErrorCode::damaged_chunk;
    default:
      return ErrorCode::internal;
  }
}

}  // namespace

Refusal refusal_of(const std::exception& problem) {
  const std::string text = problem.what();
  if (const auto* error = dynamic_cast<const voy::Error*>(&problem))
    return {code_of(error->result()), tools::without_call(text.substr(text.find(": ") + 2))};
  if (const auto* error = dynamic_cast<const Error*>(&problem)) return {error->code(), text};
  if (dynamic_cast<const std::bad_alloc*>(&problem)) return {ErrorCode::internal, "out of memory"};
  return {ErrorCode::internal, text};
}

}  // namespace voyager::view
