#include "profiles.h"

#include <algorithm>

namespace test_runtime {
namespace {

constexpr XrActionType kBool = XR_ACTION_TYPE_BOOLEAN_INPUT, kFloat = XR_ACTION_TYPE_FLOAT_INPUT,
                       kVector = XR_ACTION_TYPE_VECTOR2F_INPUT, kPose = XR_ACTION_TYPE_POSE_INPUT,
                       kHaptic = XR_ACTION_TYPE_VIBRATION_OUTPUT;

#define TEST_RUNTIME_HAND(hand)                                      \
  {"/user/hand/" hand "/input/thumbstick", kVector, kTouch},         \
      {"/user/hand/" hand "/input/thumbstick/x", kFloat, kTouch},    \
      {"/user/hand/" hand "/input/thumbstick/y", kFloat, kTouch},    \
      {"/user/hand/" hand "/input/thumbstick/click", kBool, kTouch}, \
      {"/user/hand/" hand "/input/thumbstick/touch", kBool, kTouch}, \
      {"/user/hand/" hand "/input/trigger/value", kFloat, kTouch},   \
      {"/user/hand/" hand "/input/trigger/touch", kBool, kTouch},    \
      {"/user/hand/" hand "/input/squeeze/value", kFloat, kTouch},   \
      {"/user/hand/" hand "/input/select/click", kBool, kSimple},    \
      {"/user/hand/" hand "/input/grip/pose", kPose, kBoth},         \
      {"/user/hand/" hand "/input/aim/pose", kPose, kBoth}, {        \
    "/user/hand/" hand "/output/haptic", kHaptic, kBoth              \
  }

constexpr Source kSources[] = {
    TEST_RUNTIME_HAND("left"),
    TEST_RUNTIME_HAND("right"),
    {"/user/hand/left/input/x/click", kBool, kTouch},
    {"/user/hand/left/input/x/touch", kBool, kTouch},
    {"/user/hand/left/input/y/click", kBool, kTouch},
    {"/user/hand/left/input/y/touch", kBool, kTouch},
    {"/user/hand/left/input/menu/click", kBool, kBoth},
    {"/user/hand/right/input/a/click", kBool, kTouch},
    {"/user/hand/right/input/a/touch", kBool, kTouch},
    {"/user/hand/right/input/b/click", kBool, kTouch},
    {"/user/hand/right/input/b/touch", kBool, kTouch},
    {"/user/hand/right/input/menu/click", kBool, kSimple},
    {"/user/hand/right/input/system/click", kBool, kTouch},
};
#undef TEST_RUNTIME_HAND

}  // namespace

std::span<const Source> all_sources() {
  return kSources;
}

const Source* find_source(const std::string& path) {
  const auto found = std::find_if(std::begin(kSources), std::end(kSources),
                                  [&](const Source& source) { return path == source.path; });
  return found == std::end(kSources) ? nullptr : found;
}

}  // namespace test_runtime
