#include "tools/json_file.h"

#include <fmt/core.h>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "tools/byte_size.h"

namespace voyager::tools {

namespace {

using Value = nlohmann::json;

constexpr int kMostLevels = 16;  // cameras take 4, and other programs' fields may be in between

// The limit is there because a level of one byte takes 76 in memory.
Value parse(const std::string& path, const std::string& text, const std::string& expected) {
  return Value::parse(text, [&](int level, Value::parse_event_t, const Value&) {
    if (level > kMostLevels)
      throw Error(ErrorCode::refused_input,
                  fmt::format("{}: found JSON of more than {} levels in one another, expected {}",
                              path, kMostLevels, expected));
    return true;
  });
}

}  // namespace

Value read_json_file(const std::string& path, const std::string& expected) {
  constexpr uint64_t kLargestFile = uint64_t{1} << 30;
  const auto source = open_file_source(path);
  if (source->size() > kLargestFile)
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: found {}, expected {} of at most {}", path,
                            size_text(source->size()), expected, size_text(kLargestFile)));
  std::string text(source->size(), '\0');
  source->read(0, std::as_writable_bytes(std::span(text)));
  try {
    return parse(path, text, expected);
  } catch (const Value::parse_error& error) {
    throw Error(
        ErrorCode::refused_input,
        fmt::format("{}: offset {}: found no JSON there, expected {}", path, error.byte, expected));
  } catch (const Value::exception& error) {
    throw Error(ErrorCode::refused_input,
                fmt::format("{}: found {}, expected {}", path, error.what(), expected));
  }
}

}  // namespace voyager::tools
