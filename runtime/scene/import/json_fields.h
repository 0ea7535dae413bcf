#pragma once
// JSON that strangers wrote: a bounded text, and fields that are refused by name where they are
// missing or of another kind.
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace voyager {

// Refuses what is no JSON, and more than `levels` of it in one another: a level of one byte takes
// 76 in memory.
nlohmann::json parse_json(const std::string& file, std::span<const std::byte> text, int levels);

// A value and where it is, for messages.
class JsonField {
 public:
  // `value` must outlive it.
  JsonField(const std::string& file, const nlohmann::json& value, std::string path = "")
      : file_(file), value_(&value), path_(std::move(path)) {}

  // Of an object.
  bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
  JsonField at(const char* key) const;  // refuses where it is missing
  // Of an array.
  std::vector<JsonField> items() const;
  // The numbers of an array, which must be so many.
  std::vector<double> numbers(size_t count) const;
  std::vector<std::string> texts(size_t count) const;

  uint64_t whole(uint64_t least, uint64_t most) const;
  double number() const;
  bool boolean() const;
  std::string text() const;

  const nlohmann::json& value() const { return *value_; }
  const std::string& path() const { return path_; }
  [[noreturn]] void refuse_value(const std::string& expected) const;

 private:
  std::vector<JsonField> items(size_t count) const;

  std::string file_;
  const nlohmann::json* value_;
  std::string path_;
};

}  // namespace voyager
