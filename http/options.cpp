#include "http/options.h"

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "runtime/base/error.h"

namespace voyager::http {

Options options_of_environment() {
  Options options;
  const char* found = std::getenv(kTimeoutVariable);
  if (found == nullptr || *found == '\0') return options;
  const std::string text = found;
  int seconds = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (problem != std::errc() || end != text.data() + text.size() || seconds < 1 || seconds > 3600)
    throw Error(ErrorCode::invalid_argument, std::string(kTimeoutVariable) + ": found \"" + text +
                                                 "\", expected whole seconds from 1 to 3600");
  options.stall_time = std::chrono::seconds(seconds);
  options.deadline = 3 * options.stall_time;
  return options;
}

std::string time_text(const Options& options) {
  const auto seconds = [](std::chrono::milliseconds time) {
    char text[32];
    std::snprintf(text, sizeof text, "%g s", static_cast<double>(time.count()) / 1000);
    return std::string(text);
  };
  return "a try ends after " + seconds(options.stall_time) + " without a byte, a read after " +
         seconds(options.deadline) + ", which are three tries; " + kTimeoutVariable +
         " sets the seconds of a try";
}

}  // namespace voyager::http
