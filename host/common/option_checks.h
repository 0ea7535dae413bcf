#pragma once
// What is wrong with the text of a command line's option; nothing where it is right
// (CLI::Validator).
#include <string>

namespace host {

std::string not_negative(const std::string& text);
std::string above_zero(const std::string& text);
std::string positive(const std::string& text);  // a whole number
// From a byte to what 64 bits of them can count; 0 is no limit.
std::string megabytes(const std::string& text);

}  // namespace host
