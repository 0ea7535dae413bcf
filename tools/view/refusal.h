#pragma once
#include <exception>
#include <string>

#include "runtime/base/error.h"

namespace voyager::view {

// Why something that was asked for was not done.
struct Refusal {
  ErrorCode code = ErrorCode::internal;
  std::string text;  // for people
};

// Of an exception of the library or the runtime, without the names of results and calls. Any other
// is the machine's.
Refusal refusal_of(const std::exception& problem);

}  // namespace voyager::view
