#include "option_checks.h"

#include <CLI/CLI.hpp>
#include <cmath>

namespace host {

std::string not_negative(const std::string& text) {
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value >= 0) return {};
  return "found " + text + ", expected a number, 0 or more";
}

std::string above_zero(const std::string& text) {
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0) return {};
  return "found " + text + ", expected a number above 0";
}

std::string positive(const std::string& text) {
  uint64_t value = 0;
  const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
  if (digits && CLI::detail::lexical_cast(text, value) && value > 0) return {};
  return "found " + text + ", expected a whole number, 1 or more";
}

std::string megabytes(const std::string& text) {
  constexpr double kLeast = 1e-6, kMost = 1e12;
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && (value == 0 || (value >= kLeast && value <= kMost)))
    return {};
  return "found " + text + ", expected 0, or a number from 10^-6 to 10^12";
}

}  // namespace host
