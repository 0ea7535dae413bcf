#include "tools/output_paths.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "runtime/base/error.h"
#include "runtime/base/url.h"

namespace voyager::tools {
namespace {

namespace fs = std::filesystem;

bool same_file(const std::string& a, const std::string& b) {
  if (is_url(b)) return false;  // no output is one
  std::error_code ignored;
  return fs::equivalent(a, b, ignored) ||
         fs::absolute(a).lexically_normal() == fs::absolute(b).lexically_normal();
}

void require_different(const std::string& output, const std::string& other, const char* what) {
  if (!output.empty() && !other.empty() && same_file(output, other))
    throw Error(ErrorCode::invalid_argument,
                fmt::format("{}: found it as an output and as {} ({}), expected different files",
                            output, what, other));
}

}  // namespace

void require_distinct(const std::vector<std::string>& outputs,
                      const std::vector<std::string>& inputs) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    for (const std::string& input : inputs) require_different(outputs[i], input, "an input");
    for (size_t j = 0; j < i; ++j) require_different(outputs[i], outputs[j], "another output");
  }
}

void require_extension(const std::string& option, const std::string& path,
                       const std::vector<std::string>& extensions) {
  const std::string extension = fs::path(path).extension().string();
  if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) return;
  std::string list;
  for (const std::string& known : extensions) list += (list.empty() ? "" : " or ") + known;
  throw Error(ErrorCode::invalid_argument,
              fmt::format("{}: found {}, expected a name that ends in {}", option, path, list));
}

}  // namespace voyager::tools
