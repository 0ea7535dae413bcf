#include <algorithm>
#include <cstring>

#include "instance.h"

using namespace test_runtime;

namespace test_runtime {
namespace {

bool well_formed(const std::string& text) {
  if (text.size() < 2 || text.size() >= XR_MAX_PATH_LENGTH || text[0] != '/' || text.back() == '/')
    return false;
  size_t letters = 0, dots = 0;  // of this name
  for (size_t i = 1; i <= text.size(); ++i) {
    if (i < text.size() && text[i] != '/') {
      const char c = text[i];
      if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.'))
        return false;
      ++letters;
      dots += c == '.';
    } else {
      if (letters == dots) return false;  // empty, or of dots only
      letters = dots = 0;
    }
  }
  return true;
}

}  // namespace

XrPath Instance::path(const std::string& text) {
  const auto found = std::find(paths.begin(), paths.end(), text);
  const auto index = found - paths.begin();
  if (found == paths.end()) paths.push_back(text);
  return static_cast<XrPath>(index) + 1;
}

const std::string& Instance::text_of(XrPath path) const {
  if (path == XR_NULL_PATH || path > paths.size())
    violation(XR_ERROR_PATH_INVALID, "found a path that xrStringToPath did not give");
  return paths[path - 1];
}

}  // namespace test_runtime

XrResult xrStringToPath(XrInstance handle, const char* text, XrPath* path) {
  return call(__func__, [&](auto&) {
    Instance& instance = find_instance(handle);
    checked_pointer(text, "pathString");
    checked_pointer(path, "path");
    if (!well_formed(text))
      violation(XR_ERROR_PATH_FORMAT_INVALID,
                std::string("pathString: found ") + text + ", expected a well-formed path");
    *path = instance.path(text);
    return XR_SUCCESS;
  });
}

XrResult xrPathToString(XrInstance handle, XrPath path, uint32_t capacity, uint32_t* count,
                        char* buffer) {
  return call(__func__, [&](auto&) {
    const std::string& text = find_instance(handle).text_of(path);
    return enumerate(text.size() + 1, capacity, count, buffer,
                     [&](size_t i, char& c) { c = text.c_str()[i]; });
  });
}
