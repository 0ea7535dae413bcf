#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/frame/backend.h"

namespace voyager::tools {

// A file's name, bytes and XXH3 (of its megabytes' XXH3).
nlohmann::ordered_json file_identity(const ByteSource& source);

// Where figures are from: the scene's identity, the cameras', Voyager's version and the commit that
// it was built from, what drew and by which driver, the processor and system, the arguments.
nlohmann::ordered_json provenance(const std::string& scene, const std::string& cameras,
                                  const Backend& backend,
                                  const std::vector<std::string>& arguments);

}  // namespace voyager::tools
