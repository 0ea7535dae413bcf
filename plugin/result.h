#pragma once
// How failures leave the library: a VoyResult and this thread's message.
#include <cstddef>
#include <stdexcept>
#include <string>

#include "voyager/voyager.h"

namespace voyager {

// A failure that only the ABI knows (handles, structures, versions); what the
// runtime refuses is a voyager::Error.
class ApiError : public std::runtime_error {
 public:
  ApiError(VoyResult result, const std::string& message)
      : std::runtime_error(message), result_(result) {}
  VoyResult result() const { return result_; }

 private:
  VoyResult result_;
};

// Call inside a catch block: the result for the exception in flight, whose
// text, after "function: ", becomes this thread's last message.
VoyResult translate_exception(const char* function) noexcept;

// Never NULL; valid until this thread's next failure.
const char* last_message() noexcept;

inline constexpr size_t kMessageBytes = 2048;

// This thread's message, which is the same again when this goes: a log that is told of it may
// call functions that fail.
class KeptMessage {
 public:
  KeptMessage() noexcept;
  ~KeptMessage();
  KeptMessage(const KeptMessage&) = delete;
  KeptMessage& operator=(const KeptMessage&) = delete;
  const char* text() const { return text_; }

 private:
  char text_[kMessageBytes];
};

[[noreturn]] void refuse(const std::string& message);  // VOY_ERROR_INVALID_ARGUMENT

}  // namespace voyager
