#pragma once
// Fields of a JSON object, refused by name: "WHERE: FIELD: found X, expected Y".
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace test_runtime {

using Json = nlohmann::json;

Json parse_json(const std::string& path);  // throws std::runtime_error
std::string shown(const Json& json);       // short, for messages

class Reader {
 public:
  // Keeps a reference to json. Throws where it is no object.
  Reader(std::string where, const Json& json);

  bool has(const std::string& name) const { return json_.contains(name); }
  const Json& field(const std::string& name) const;
  double number(const std::string& name, double low, double high) const;
  int64_t whole(const std::string& name, int64_t low, int64_t high) const;
  bool truth(const std::string& name) const;
  std::string text(const std::string& name) const;
  std::vector<double> numbers(const std::string& name, size_t count) const;
  std::vector<double> rows(const std::string& name) const;  // 3x3, row by row
  // The same field's objects, each with its own place in messages.
  std::vector<Reader> objects(const std::string& name) const;

  // Refuses the first field that is none of these.
  void only(const std::vector<std::string>& names) const;
  [[noreturn]] void refuse(const std::string& name, const std::string& expected) const;

  const std::string& where() const { return where_; }
  const Json& json() const { return json_; }

 private:
  std::vector<double> numbers_of(const Json& json, const std::string& name, size_t count) const;

  std::string where_;
  const Json& json_;
};

}  // namespace test_runtime
