#pragma once
#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <string>
#include <type_traits>

namespace voyager::tools {

// A line of a table, field after field; those that need it are quoted.
class CsvLine {
 public:
  CsvLine& text(const std::string& value) {
    if (!line_.empty() || began_) line_ += ',';
    began_ = true;
    line_ += quoted(value);
    return *this;
  }
  CsvLine& number(double value) { return text(fmt::format("{:.10g}", value)); }
  // "inf" where nothing differs.
  CsvLine& decibels(double psnr) { return std::isfinite(psnr) ? number(psnr) : text("inf"); }
  CsvLine& empty() { return text(""); }
  CsvLine& number(const std::optional<double>& value) { return value ? number(*value) : empty(); }
  template <class Value>
  CsvLine& where(bool known, const Value& value) {
    if (!known) return empty();
    if constexpr (std::is_arithmetic_v<Value>)
      return number(static_cast<double>(value));
    else
      return text(value);
  }
  std::string take() { return line_ + "\n"; }

 private:
  static std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
  }

  std::string line_;
  bool began_ = false;
};

}  // namespace voyager::tools
