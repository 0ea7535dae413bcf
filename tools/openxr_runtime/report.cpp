#include "report.h"

#include <cstdio>

#include "files.h"

namespace test_runtime {

namespace {

constexpr size_t kLongest = 1000;  // entries of a list of complaints

}  // namespace

void Report::broken(const char* function, XrResult result, int64_t frame, const std::string& what) {
  std::fprintf(stderr, "voyager_test_runtime: frame %lld: %s: %s: %s\n",
               static_cast<long long>(frame), function, name_of(result).c_str(), what.c_str());
  count("violations");
  if (lists_["violations"].size() < kLongest)
    add_to("violations",
           {{"call", function}, {"result", name_of(result)}, {"frame", frame}, {"what", what}});
  write();
}

void Report::remark(const char* function, int64_t frame, const std::string& what) {
  if (lists_["remarks"].size() < kLongest)
    add_to("remarks", {{"call", function}, {"frame", frame}, {"what", what}});
}

void Report::state(int64_t frame, XrSessionState state) {
  add_to("states", {{"frame", frame}, {"state", name_of(state)}});
}

void Report::write() const {
  if (path_.empty()) return;
  nlohmann::ordered_json json;
  for (const char* list : {"violations", "remarks", "states", "captures"}) {
    const auto found = lists_.find(list);
    json[list] = found == lists_.end() ? nlohmann::ordered_json::array() : found->second;
  }
  json["counts"] = counts_;
  json["calls"] = calls_;
  write_text(path_,
             json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace test_runtime
