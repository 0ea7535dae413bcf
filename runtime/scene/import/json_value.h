#pragma once
// JSON that came from outside: each value is there and of its kind, or the file is refused with
// the value's place ("nodes[3].scale"), what was found and what was expected.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace voyager {

// Of a file's JSON. The scenes that are listed in so much text are of more Gaussians than any
// machine holds.
inline constexpr uint64_t kMostJsonBytes = uint64_t{64} << 20;
// Numbers, strings, arrays, objects and so on: one takes up to 200 bytes in memory beside its text.
// A tileset of 100,000 tiles has some 2,000,000.
inline constexpr uint64_t kMostJsonValues = uint64_t{1} << 21;
// Levels in one another, of which a level of one byte takes 80 in memory.
inline constexpr int kMostJsonLevels = 256;

// Throws Error(refused_input) naming `file` and the byte, which counts from `offset`.
nlohmann::json parse_json(const std::string& file, uint64_t offset, std::string_view text,
                          int levels = kMostJsonLevels);

class JsonValue {
 public:
  // `json` must outlive this and what is taken from it. `offset`: where in the file the JSON
  // begins.
  JsonValue(const std::string& file, uint64_t offset, const nlohmann::json& json)
      : file_(&file), offset_(offset), json_(&json) {}

  // Of an object. Throws Error(refused_input), as all below, where this is none.
  bool has(const std::string& name) const;
  JsonValue operator[](const std::string& name) const;
  // Of an array.
  size_t size() const;
  JsonValue operator[](size_t index) const;

  double number() const;  // finite
  uint64_t whole(uint64_t most, uint64_t least = 0) const;
  const std::string& text() const;
  bool flag() const;
  void numbers(std::span<double> into) const;  // an array of as many

  // The value of a field that may be missing.
  uint64_t whole_or(const std::string& name, uint64_t missing, uint64_t most) const;

  const std::string& place() const { return place_; }
  const nlohmann::json& json() const { return *json_; }
  [[noreturn]] void refuse(const std::string& expected) const;
  // What was found instead of a field, or beside the right ones.
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const;

 private:
  JsonValue at(const nlohmann::json& json, std::string place) const;

  const std::string* file_;
  uint64_t offset_;
  std::string place_;
  const nlohmann::json* json_;
};

}  // namespace voyager
