#pragma once
// The one error type below the C ABI. The plugin's facade translates it to a
// VoyResult; nothing else may cross that boundary.
#include <stdexcept>
#include <string>

#include "runtime/base/printable.h"

namespace voyager {

enum class ErrorCode {
  invalid_argument,  // the caller's mistake
  unsupported,       // a mode or format that this build or backend lacks
  file_not_found,
  io,             // the machine: read, write, disk full; trying again gives the same
  io_transient,   // a read that may go well later: a time-out, a busy server, EIO
  refused_input,  // a malformed file: message names file, place, found, expected
  damaged_chunk,  // a chunk that this frame needs failed its checksum or decoding
  over_budget,
  no_device,
  device_lost,   // a device stopped working for good
  timeout,       // what the host promised did not come
  scene_closed,  // while a frame waited for it
  internal,
};

class Error : public std::runtime_error {
 public:
  // Of the message control characters are escaped: it may name what a stranger's file says.
  Error(ErrorCode code, const std::string& message)
      : std::runtime_error(printable(message)), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace voyager
