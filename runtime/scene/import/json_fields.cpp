#include "runtime/scene/import/json_fields.h"

#include "runtime/scene/import/refuse.h"

namespace voyager {
namespace {

using Json = nlohmann::json;

std::string shown(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "an array of " + std::to_string(value.size());
  return value.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 80);
}

}  // namespace

Json parse_json(const std::string& file, std::span<const std::byte> text, int levels) {
  const auto* begin = reinterpret_cast<const char*>(text.data());
  const auto check_level = [&](int level, Json::parse_event_t, const Json&) {
    if (level > levels)
      refuse(file, 0, "JSON", "more than " + std::to_string(levels) + " levels in one another",
             "fewer");
    return true;
  };
  try {
    return Json::parse(begin, begin + text.size(), check_level);
  } catch (const Json::parse_error& error) {
    refuse(file, error.byte, "JSON", "no JSON", "JSON");
  } catch (const Json::exception& error) {
    refuse(file, 0, "JSON", error.what(), "JSON");
  }
}

void JsonField::refuse_value(const std::string& expected) const {
  refuse(file_, 0, path_.empty() ? "JSON" : path_, shown(*value_), expected);
}

JsonField JsonField::at(const char* key) const {
  const std::string path = path_.empty() ? key : path_ + "." + key;
  if (!value_->is_object()) refuse_value("an object with " + std::string(key));
  const auto found = value_->find(key);
  if (found == value_->end()) refuse(file_, 0, path, "nothing", "a value");
  return {file_, *found, path};
}

std::vector<JsonField> JsonField::items() const {
  if (!value_->is_array()) refuse_value("an array");
  std::vector<JsonField> fields;
  for (size_t i = 0; i < value_->size(); ++i)
    fields.emplace_back(file_, (*value_)[i], path_ + "[" + std::to_string(i) + "]");
  return fields;
}

std::vector<JsonField> JsonField::items(size_t count) const {
  if (!value_->is_array() || value_->size() != count)
    refuse_value("an array of " + std::to_string(count));
  return items();
}

std::vector<double> JsonField::numbers(size_t count) const {
  std::vector<double> values;
  for (const JsonField& item : items(count)) values.push_back(item.number());
  return values;
}

std::vector<std::string> JsonField::texts(size_t count) const {
  std::vector<std::string> values;
  for (const JsonField& item : items(count)) values.push_back(item.text());
  return values;
}

uint64_t JsonField::whole(uint64_t least, uint64_t most) const {
  if (value_->is_number_unsigned()) {
    const auto found = value_->get<uint64_t>();
    if (found >= least && found <= most) return found;
  }
  refuse_value("a whole number from " + std::to_string(least) + " to " + std::to_string(most));
}

double JsonField::number() const {
  if (!value_->is_number()) refuse_value("a number");
  return value_->get<double>();
}

bool JsonField::boolean() const {
  if (!value_->is_boolean()) refuse_value("true or false");
  return value_->get<bool>();
}

std::string JsonField::text() const {
  if (!value_->is_string()) refuse_value("a text");
  return value_->get<std::string>();
}

}  // namespace voyager
