#include "tools/output_paths.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/base/name_ending.h"
#include "runtime/base/open_source.h"
#include "runtime/base/output_path.h"
#include "runtime/base/url.h"

namespace voyager::tools {
namespace {

namespace fs = std::filesystem;

// Without links, also where nothing is there yet.
fs::path resolved(const std::string& path) {
  std::error_code problem;
  const fs::path target = fs::absolute(written_path(path), problem);
  const fs::path found = fs::weakly_canonical(target, problem);
  return problem ? target.lexically_normal() : found;  // opening it will say what is wrong
}

bool is_file(const std::string& path) {
  return !path.empty() && path != "-" && !is_url(path);
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored) || resolved(a) == resolved(b);
}

// Or the folder itself.
bool is_within(const std::string& path, const std::string& folder) {
  const fs::path within = resolved(folder);
  std::error_code ignored;
  fs::path at = resolved(path);
  while (at != within && !fs::equivalent(at, within, ignored) && at.has_relative_path())
    at = at.parent_path();
  return at.has_relative_path();
}

void require_different(const std::string& output, const std::string& other, const char* what) {
  if (is_file(output) && is_file(other) && same_file(output, other))
    throw Error(ErrorCode::invalid_argument,
                fmt::format("{}: found it as an output and as {} ({}), expected different files",
                            output, what, other));
}

}  // namespace

void require_distinct(const std::vector<std::string>& outputs,
                      const std::vector<std::string>& inputs) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    for (const std::string& input : inputs)
      require_different(outputs[i], scene_file(input), "an input");
    for (size_t j = 0; j < i; ++j) require_different(outputs[i], outputs[j], "another output");
  }
}

void require_outside(const std::string& folder, const std::vector<std::string>& paths) {
  for (const std::string& path : paths)
    if (is_file(path) && is_within(path, folder))
      throw Error(ErrorCode::invalid_argument,
                  fmt::format("{}: found it in the work folder {}, which is made for the work and "
                              "removed at its end, expected it outside",
                              path, folder));
}

void require_not_below(const std::string& output, const std::string& folder) {
  if (is_within(folder, output))
    throw Error(ErrorCode::invalid_argument,
                fmt::format("{}: found the work folder {} below it, expected a file there: give "
                            "another --work",
                            output, folder));
}

void require_extension(const std::string& option, const std::string& path,
                       const std::vector<std::string>& extensions) {
  const std::string extension = fs::path(path).extension().string();
  const auto is_it = [&](const std::string& known) {
    return extension.size() == known.size() && has_ending(extension, known);
  };
  if (std::any_of(extensions.begin(), extensions.end(), is_it)) return;
  std::string list;
  for (const std::string& known : extensions) list += (list.empty() ? "" : " or ") + known;
  throw Error(ErrorCode::invalid_argument,
              fmt::format("{}: found {}, expected a name that ends in {}", option, path, list));
}

void require_writable(const std::string& path, uint64_t bytes) {
  const AtomicFile nothing(path);
  if (bytes != 0) require_room(path, bytes);
}

}  // namespace voyager::tools
