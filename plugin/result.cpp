#include "plugin/result.h"

#include <cstdio>
#include <cstring>
#include <new>

#include "plugin/text.h"
#include "runtime/base/error.h"

namespace voyager {
namespace {

// Plain memory: a thread_local with a destructor would keep the library mapped
// after dlclose for as long as the thread lives.
thread_local char message[kMessageBytes];

VoyResult result_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::invalid_argument:
      return VOY_ERROR_INVALID_ARGUMENT;
    case ErrorCode::unsupported:
      return VOY_ERROR_UNSUPPORTED;
    case ErrorCode::file_not_found:
      return VOY_ERROR_FILE_NOT_FOUND;
    case ErrorCode::io:
    case ErrorCode::io_transient:
      return VOY_ERROR_IO;
    case ErrorCode::refused_input:
      return VOY_ERROR_REFUSED_INPUT;
    case ErrorCode::damaged_chunk:
      return VOY_ERROR_DAMAGED_CHUNK;
    case ErrorCode::over_budget:
      return VOY_ERROR_OVER_BUDGET;
    case ErrorCode::no_device:
      return VOY_ERROR_NO_DEVICE;
    case ErrorCode::device_lost:
      return VOY_ERROR_DEVICE_LOST;
    case ErrorCode::timeout:
      return VOY_ERROR_TIMEOUT;
    case ErrorCode::scene_closed:
      return VOY_ERROR_SCENE_CLOSED;
    case ErrorCode::internal:
      break;
  }
  return VOY_ERROR_INTERNAL;
}

VoyResult record(const char* function, VoyResult result, const char* what) {
  const int length = std::snprintf(message, sizeof message, "%s: %s", function, what);
  if (length >= static_cast<int>(sizeof message)) message[whole_characters(message)] = '\0';
  return result;
}

}  // namespace

VoyResult translate_exception(const char* function) noexcept {
  try {
    throw;
  } catch (const ApiError& error) {
    return record(function, error.result(), error.what());
  } catch (const Error& error) {
    return record(function, result_of(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    return record(function, VOY_ERROR_OUT_OF_HOST_MEMORY,
                  "the allocator has no more memory; the call was undone");
  } catch (const std::exception& error) {
    return record(function, VOY_ERROR_INTERNAL, error.what());
  } catch (...) {
    return record(function, VOY_ERROR_INTERNAL, "an exception of an unknown type");
  }
}

const char* last_message() noexcept {
  return message;
}

KeptMessage::KeptMessage() noexcept {
  std::memcpy(text_, message, sizeof message);
}

KeptMessage::~KeptMessage() {
  std::memcpy(message, text_, sizeof message);
}

void refuse(const std::string& what) {
  throw ApiError(VOY_ERROR_INVALID_ARGUMENT, what);
}

}  // namespace voyager
