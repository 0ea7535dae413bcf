#pragma once
// Interaction profiles, and the sources of input that each has.
#include <span>
#include <string>

#include "api.h"

namespace test_runtime {

struct Source {
  const char* path;  // from /user on
  XrActionType type;
  unsigned profiles;  // bits of kProfiles' indices
};

inline constexpr const char* kProfiles[] = {"/interaction_profiles/oculus/touch_controller",
                                            "/interaction_profiles/khr/simple_controller"};
inline constexpr unsigned kTouch = 1, kSimple = 2, kBoth = 3;

std::span<const Source> all_sources();
const Source* find_source(const std::string& path);

}  // namespace test_runtime
