#pragma once
// What the program says to people. Notes and warnings go to standard error, results to standard
// output. Errors are printed by main() alone, and always.
#include <string>

namespace voyager::tools {

enum class Verbosity { quiet, normal, verbose };

// The process's: --quiet and --verbose set it before any work begins.
void set_verbosity(Verbosity verbosity);
Verbosity verbosity();

// "voyager: TEXT"; not with --quiet.
void note(const std::string& text);
void warn(const std::string& text);
// The same, only with --verbose.
void detail(const std::string& text);
// A message of the library without the name of the call that failed: "voyOpenScene: TEXT" is TEXT.
std::string without_call(const std::string& message);
// Lines for people on standard output; not with --quiet.
void say(const std::string& text);
// An error ends the program, and this line is its last.
void print_error(const std::string& text) noexcept;

// A line on a terminal that whatever is printed next takes the place of; "" removes it.
void show_line(const std::string& text);
bool on_terminal();

}  // namespace voyager::tools
