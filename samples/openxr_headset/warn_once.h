#pragma once
// What the player should know of, and the program goes on without.
#include <string>

namespace host {

// A line on standard error; each text once in the program's life. From one thread.
void warn_once(const std::string& text);

}  // namespace host
