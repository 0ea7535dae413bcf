#pragma once
// The command line's contract (docs/command-line.md): 0 success, 1 bad usage,
// 2 refused input, 3 a damaged chunk that a frame needed, 4 the machine.
#include "runtime/base/error.h"
#include "voyager/voyager.h"

namespace voyager::tools {

enum ExitCode { kSuccess = 0, kBadUsage = 1, kRefusedInput = 2, kDamagedChunk = 3, kMachine = 4 };

inline ExitCode exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::invalid_argument:
    case ErrorCode::unsupported:
      return kBadUsage;
    case ErrorCode::file_not_found:
    case ErrorCode::refused_input:
      return kRefusedInput;
    case ErrorCode::damaged_chunk:
      return kDamagedChunk;
    case ErrorCode::io:
    case ErrorCode::io_transient:
    case ErrorCode::over_budget:
    case ErrorCode::no_device:
    case ErrorCode::device_lost:
    case ErrorCode::timeout:
    case ErrorCode::scene_closed:
    case ErrorCode::internal:
      break;
  }
  return kMachine;
}

inline ExitCode exit_code(VoyResult result) {
  switch (result) {
    case VOY_SUCCESS:
    case VOY_INCOMPLETE:
      return kSuccess;
    case VOY_ERROR_INVALID_ARGUMENT:
    case VOY_ERROR_UNSUPPORTED:
      return kBadUsage;
    case VOY_ERROR_FILE_NOT_FOUND:
    case VOY_ERROR_REFUSED_INPUT:
      return kRefusedInput;
    case VOY_ERROR_DAMAGED_CHUNK:
      return kDamagedChunk;
    default:
      return kMachine;
  }
}

}  // namespace voyager::tools
