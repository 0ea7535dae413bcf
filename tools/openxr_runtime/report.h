#pragma once
// What the application did: calls counted, frames seen, every rule that it broke. Written as
// JSON (README.md has the fields) whenever something of weight ended.
#include <cstdint>
#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "api.h"

namespace test_runtime {

class Report {
 public:
  explicit Report(std::string path) : path_(std::move(path)) {}

  void called(const char* function) { ++calls_[function]; }
  void count(const char* what) { ++counts_[what]; }
  void broken(const char* function, XrResult result, int64_t frame, const std::string& what);
  // Not against a rule, yet seldom meant.
  void remark(const char* function, int64_t frame, const std::string& what);
  void state(int64_t frame, XrSessionState state);
  void add_to(const char* list, nlohmann::ordered_json item) {
    lists_[list].push_back(std::move(item));
  }

  void write() const;

 private:
  std::string path_;
  std::map<std::string, uint64_t> calls_, counts_;
  std::map<std::string, nlohmann::ordered_json> lists_;
};

}  // namespace test_runtime
