#include "json_file.h"

#include "failure.h"
#include "files.h"

namespace host {

nlohmann::json read_json(const std::string& path) {
  constexpr int kMostLevels = 16;  // cameras take 4; each takes much memory
  const auto check_level = [&](int level, nlohmann::json::parse_event_t, const nlohmann::json&) {
    if (level > kMostLevels)
      throw Failure(kRefusedInput, path + ": found JSON of more than " +
                                       std::to_string(kMostLevels) +
                                       " levels in one another, expected a cameras.json");
    return true;
  };
  return nlohmann::json::parse(read_file(path, kLargestCameras), check_level,
                               /*allow_exceptions=*/false);
}

}  // namespace host
