#include "json_reader.h"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace test_runtime {

Json parse_json(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be opened, expected a JSON file");
  try {
    return Json::parse(file);
  } catch (const Json::exception& error) {
    throw std::runtime_error(path + ": found no JSON, expected some: " + error.what());
  }
}

std::string shown(const Json& json) {
  if (json.is_structured())
    return "an " + std::string(json.type_name()) + " of " + std::to_string(json.size());
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, 60) + "..." : text;
}

Reader::Reader(std::string where, const Json& json) : where_(std::move(where)), json_(json) {
  if (!json.is_object())
    throw std::runtime_error(where_ + ": found " + shown(json) + ", expected an object");
}

void Reader::refuse(const std::string& name, const std::string& expected) const {
  const std::string found = json_.contains(name) ? shown(json_[name]) : "no such field";
  throw std::runtime_error(where_ + ": " + name + ": found " + found + ", expected " + expected);
}

const Json& Reader::field(const std::string& name) const {
  if (!json_.contains(name)) refuse(name, "one");
  return json_[name];
}

double Reader::number(const std::string& name, double low, double high) const {
  const Json& value = field(name);
  if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high))
    refuse(name, "a number from " + Json(low).dump() + " to " + Json(high).dump());
  return value.get<double>();
}

int64_t Reader::whole(const std::string& name, int64_t low, int64_t high) const {
  const double value = number(name, static_cast<double>(low), static_cast<double>(high));
  if (value != std::floor(value))
    refuse(name, "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  return static_cast<int64_t>(value);
}

bool Reader::truth(const std::string& name) const {
  if (!field(name).is_boolean()) refuse(name, "true or false");
  return json_[name].get<bool>();
}

std::string Reader::text(const std::string& name) const {
  if (!field(name).is_string()) refuse(name, "text");
  return json_[name].get<std::string>();
}

std::vector<double> Reader::numbers_of(const Json& json, const std::string& name,
                                       size_t count) const {
  const std::string expected = std::to_string(count) + " finite numbers";
  if (!json.is_array() || json.size() != count) refuse(name, expected);
  std::vector<double> values;
  for (const Json& value : json) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) refuse(name, expected);
    values.push_back(value.get<double>());
  }
  return values;
}

std::vector<double> Reader::numbers(const std::string& name, size_t count) const {
  return numbers_of(field(name), name, count);
}

std::vector<double> Reader::rows(const std::string& name) const {
  const Json& json = field(name);
  if (!json.is_array() || json.size() != 3) refuse(name, "three rows of three numbers");
  std::vector<double> values;
  for (const Json& row : json)
    for (const double value : numbers_of(row, name, 3)) values.push_back(value);
  return values;
}

std::vector<Reader> Reader::objects(const std::string& name) const {
  const Json& json = field(name);
  if (!json.is_array()) refuse(name, "an array of objects");
  std::vector<Reader> readers;
  for (size_t i = 0; i < json.size(); ++i)
    readers.emplace_back(where_ + ": " + name + "[" + std::to_string(i) + "]", json[i]);
  return readers;
}

void Reader::only(const std::vector<std::string>& names) const {
  for (const auto& item : json_.items())
    if (std::find(names.begin(), names.end(), item.key()) == names.end()) {
      std::string expected = "one of";
      for (const std::string& name : names) expected += " " + name;
      throw std::runtime_error(where_ + ": " + item.key() +
                               ": found a field of that name, expected " + expected);
    }
}

}  // namespace test_runtime
