#include "runtime/scene/import/json_value.h"

#include <algorithm>
#include <cmath>

#include "runtime/scene/import/refuse.h"

namespace voyager {
namespace {

using Json = nlohmann::json;

std::string found_text(const Json& json) {
  if (json.is_structured())
    return std::string("an ") + json.type_name() + " of " + std::to_string(json.size());
  constexpr size_t kMost = 60;
  if (json.is_string() && json.get_ref<const std::string&>().size() > kMost)
    return "a string of " + std::to_string(json.get_ref<const std::string&>().size()) + " bytes";
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// What a text takes when it is parsed. Exact for JSON; of anything else the parser refuses what
// follows the first error.
struct Extent {
  int levels = 0;  // arrays and objects in one another; counted no further than past the limit
  uint64_t values = 1;
};

Extent extent_of(std::string_view text, int most_levels) {
  Extent extent;
  int level = 0;
  bool in_string = false, begun = false;  // begun: an array or object that nothing is in yet
  for (size_t i = 0; i < text.size() && extent.levels <= most_levels; ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
      continue;
    }
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    const bool ends = c == ']' || c == '}';
    if (c == ',' || (begun && !ends)) ++extent.values;
    begun = c == '[' || c == '{';
    if (begun) extent.levels = std::max(extent.levels, ++level);
    if (ends) --level;
    in_string = c == '"';
  }
  return extent;
}

// As much of a place as a message has room for: a value far down would own as much as all above it.
std::string shortened(std::string place) {
  constexpr size_t kMost = 120;
  if (place.size() <= kMost) return place;
  return "..." + place.substr(place.size() - kMost);
}

}  // namespace

// The parser's own callback would count levels, too, but looks at all siblings of each value.
Json parse_json(const std::string& file, uint64_t offset, std::string_view text, int levels) {
  const Extent extent = extent_of(text, levels);
  if (extent.levels > levels)
    refuse(file, offset, "JSON", "more than " + std::to_string(levels) + " levels",
           "fewer in one another");
  if (extent.values > kMostJsonValues)
    refuse(file, offset, "JSON", std::to_string(extent.values) + " values",
           "at most " + std::to_string(kMostJsonValues));
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    refuse(file, offset + error.byte, "JSON", "none there", "JSON in UTF-8");
  } catch (const Json::exception& error) {
    refuse(file, offset, "JSON", error.what(), "JSON in UTF-8");
  }
}

void JsonValue::refuse(const std::string& expected) const {
  refuse(found_text(*json_), expected);
}

void JsonValue::refuse(const std::string& found, const std::string& expected) const {
  voyager::refuse(*file_, offset_, place_.empty() ? "JSON" : place_, found, expected);
}

JsonValue JsonValue::at(const Json& json, std::string place) const {
  JsonValue value(*file_, offset_, json);
  value.place_ = shortened(std::move(place));
  return value;
}

bool JsonValue::has(const std::string& name) const {
  if (!json_->is_object()) refuse("an object");
  return json_->contains(name);
}

JsonValue JsonValue::operator[](const std::string& name) const {
  if (!has(name)) refuse("no field " + name, "one");
  return at((*json_)[name], place_.empty() ? name : place_ + "." + name);
}

size_t JsonValue::size() const {
  if (!json_->is_array()) refuse("an array");
  return json_->size();
}

JsonValue JsonValue::operator[](size_t index) const {
  if (index >= size())
    refuse("an array of " + std::to_string(size()), "an entry " + std::to_string(index));
  return at((*json_)[index], place_ + "[" + std::to_string(index) + "]");
}

double JsonValue::number() const {
  const double value = json_->is_number() ? json_->get<double>() : NAN;
  if (!std::isfinite(value)) refuse("a finite number");
  return value;
}

uint64_t JsonValue::whole(uint64_t most, uint64_t least) const {
  const std::string expected =
      "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  const auto inside = [&](uint64_t value) { return value >= least && value <= most; };
  if (json_->is_number_unsigned() && inside(json_->get<uint64_t>())) return json_->get<uint64_t>();
  // Writers of numbers with one kind only write 3.0.
  constexpr double kExact = 9007199254740992;  // 2^53
  const double value = json_->is_number_float() ? json_->get<double>() : -1;
  if (!(value >= 0 && value <= kExact && value == std::floor(value)) ||
      !inside(static_cast<uint64_t>(value)))
    refuse(expected);
  return static_cast<uint64_t>(value);
}

const std::string& JsonValue::text() const {
  if (!json_->is_string()) refuse("a string");
  return json_->get_ref<const std::string&>();
}

bool JsonValue::flag() const {
  if (!json_->is_boolean()) refuse("true or false");
  return json_->get<bool>();
}

void JsonValue::numbers(std::span<double> into) const {
  if (size() != into.size()) refuse(std::to_string(into.size()) + " finite numbers");
  for (size_t i = 0; i < into.size(); ++i) into[i] = (*this)[i].number();
}

uint64_t JsonValue::whole_or(const std::string& name, uint64_t missing, uint64_t most) const {
  return has(name) ? (*this)[name].whole(most) : missing;
}

}  // namespace voyager
