#include "tools/console.h"

#include <unistd.h>

#include <cstdio>
#include <mutex>

#include "runtime/base/printable.h"

namespace voyager::tools {
namespace {

struct Console {
  std::mutex mutex;
  Verbosity verbosity = Verbosity::normal;
  bool line_shown = false;
};

Console& console() {
  static Console it;
  return it;
}

// Under the mutex. A standard error that is closed stops no work.
void remove_line(Console& c) {
  if (c.line_shown) std::fputs("\r\033[K", stderr);
  c.line_shown = false;
}

void print(std::FILE* stream, const std::string& text) {
  Console& c = console();
  const std::lock_guard lock(c.mutex);
  remove_line(c);
  std::fputs(text.c_str(), stream);
}

}  // namespace

void set_verbosity(Verbosity verbosity) {
  console().verbosity = verbosity;
}

Verbosity verbosity() {
  return console().verbosity;
}

void note(const std::string& text) {
  if (verbosity() != Verbosity::quiet) print(stderr, "voyager: " + printable(text) + "\n");
}

void warn(const std::string& text) {
  note("warning: " + text);
}

void detail(const std::string& text) {
  if (verbosity() == Verbosity::verbose) note(text);
}

std::string without_call(const std::string& message) {
  const size_t colon = message.find(": ");
  return message.starts_with("voy") && colon != std::string::npos ? message.substr(colon + 2)
                                                                  : message;
}

void say(const std::string& text) {
  if (verbosity() != Verbosity::quiet) print(stdout, text);
}

void print_error(const std::string& text) noexcept {
  Console& c = console();
  const std::lock_guard lock(c.mutex);
  remove_line(c);
  for (const char* part : {"voyager: ", text.c_str(), "\n"}) std::fputs(part, stderr);
}

void show_line(const std::string& text) {
  Console& c = console();
  const std::lock_guard lock(c.mutex);
  remove_line(c);
  if (text.empty()) return;
  std::fputs(("\r" + text).c_str(), stderr);
  c.line_shown = true;
}

bool on_terminal() {
  return ::isatty(STDERR_FILENO) != 0;
}

}  // namespace voyager::tools
