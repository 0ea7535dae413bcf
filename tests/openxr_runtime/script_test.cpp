// The way in: the loader's, and the script's.
#include <dlfcn.h>

#include "tests/openxr_runtime/client.h"

namespace test_runtime::test {
namespace script_test {
namespace {

std::vector<std::string> offered_extensions() {
  uint32_t count = 0;
  xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr);
  std::vector properties(count, typed<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES));
  xrEnumerateInstanceExtensionProperties(nullptr, count, &count, properties.data());
  std::vector<std::string> names;
  for (const auto& property : properties)
    if (std::strstr(property.extensionName, "KHR")) names.push_back(property.extensionName);
  return names;
}

struct BadScript {
  const char* name;
  const char* text;
  const char* message;  // part of what is said
};

std::ostream& operator<<(std::ostream& out, const BadScript& script) {
  return out << script.name;
}

constexpr BadScript kBad[] = {
    {"NoJson", "{", "found no JSON"},
    {"NoObject", "[]", "found an array of 0, expected an object"},
    {"UnknownField", R"({"colour": 1})",
     "colour: found a field of that name, expected one of motion"},
    {"ZeroPeriod", R"({"period_ns": 0})", "period_ns: found 0, expected a number from"},
    {"BothPeriods", R"({"period_ns": 10000000, "hz": 72})", "hz: found 72, expected no period_ns"},
    {"NoSize", R"({"recommended": [0, 5]})", "recommended: found an array of 2, expected [width"},
    {"TooLarge", R"({"recommended": [5000, 5]})",
     "recommended: found an array of 2, expected no more"},
    {"ThreeSizes", R"({"recommended": [[9, 9], [9, 9], [9, 9]]})",
     "recommended: found an array of 3, expected one size, or those of 2 or 4 views"},
    {"Format", R"({"formats": ["RGB"]})",
     "formats: found an array of 1, expected an array of R8G8B8A8"},
    {"Vulkan", R"({"vulkan": [1, 0, 1, 0.5]})", "vulkan: found an array of 4, expected [major"},
    {"Amount", R"({"events": [{"frame": 1, "do": "late", "periods": null}]})",
     "events[0]: periods: found null"},
    {"Extension", R"({"extensions": ["XR_KHR_no"]})", "extensions: found an array of 1"},
    {"Ranges", R"({"hidden_frames": [[1]]})",
     "hidden_frames: found an array of 1, expected an array"},
    {"Event", R"({"events": [{"frame": 1, "do": "dance"}]})", "events[0]: do: found \"dance\""},
    {"EventField", R"({"events": [{"frame": 1, "do": "exit", "frames": 1}]})", "events[0]: frames"},
    {"EventFrame", R"({"events": [{"frame": -1, "do": "exit"}]})", "events[0]: frame: found -1"},
    {"Recentring", R"({"events": [{"frame": 1, "do": "recentre", "position": [0,0,0],
                       "orientation": [0,0,0,2]}]})",
     "events[0]: orientation: found an array of 4, expected a unit quaternion"},
    {"Input", R"({"input": [{"frame": 1, "/user/hand/left/input/nose": true}]})",
     "nose: found true"},
    {"InputType", R"({"input": [{"frame": 1, "/user/hand/left/input/thumbstick": 1}]})",
     "thumbstick: found 1, expected 2 finite numbers"},
    {"Call", R"({"failures": [{"call": "xrDance", "result": "XR_SUCCESS"}]})",
     "failures[0]: call: found \"xrDance\""},
    {"Result", R"({"failures": [{"call": "xrEndFrame", "result": "XR_NO"}]})",
     "failures[0]: result: found \"XR_NO\""},
    {"Motion", R"({"motion": "not_there.json"})", "not_there.json: cannot be opened"},
};

class BadScripts : public ::testing::TestWithParam<BadScript> {};

TEST_P(BadScripts, AreRefusedByName) {
  const Stage stage(Json::object());
  std::ofstream(stage.file("script.json")) << GetParam().text;
  const std::vector<const char*> extensions = {XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME};
  const XrInstanceCreateInfo info = instance_info(extensions);
  XrInstance instance = XR_NULL_HANDLE;
  ::testing::internal::CaptureStderr();
  const XrResult result = xrCreateInstance(&info, &instance);
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_LT(result, 0);
  EXPECT_NE(said.find(GetParam().message), std::string::npos) << said;
  EXPECT_NE(said.find("script.json"), std::string::npos) << said;
  EXPECT_EQ(said.find("voyager_test_runtime: "), said.rfind("voyager_test_runtime: ")) << said;
}

INSTANTIATE_TEST_SUITE_P(All, BadScripts, ::testing::ValuesIn(kBad),
                         [](const auto& script) { return std::string(script.param.name); });

TEST(Loader, EverythingBeyondTheMinimumCanBeSwitchedOff) {
  {
    const Stage stage(Json::object());
    EXPECT_EQ(offered_extensions().size(), 3u);
  }
  const Stage stage(Json{{"extensions", Json::array()}});
  EXPECT_EQ(offered_extensions(), std::vector<std::string>{XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME});
  const XrInstanceCreateInfo info = instance_info(kAllExtensions);
  XrInstance instance = XR_NULL_HANDLE;
  EXPECT_EQ(xrCreateInstance(&info, &instance), XR_ERROR_EXTENSION_NOT_PRESENT);
}

TEST(Loader, FunctionsOfExtensionsThatAreNotEnabledAreAbsent) {
  const Stage stage(Json::object());
  const Client client({XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME});
  PFN_xrVoidFunction function = nullptr;
  EXPECT_EQ(xrGetInstanceProcAddr(client.instance, "xrGetVisibilityMaskKHR", &function),
            XR_ERROR_FUNCTION_UNSUPPORTED);
  EXPECT_EQ(xrGetInstanceProcAddr(client.instance, "xrNoSuchFunction", &function),
            XR_ERROR_FUNCTION_UNSUPPORTED);
}

// The runtime's own negotiation, without the loader: what else it exports would clash with it.
TEST(Loader, NegotiationIsTheOnlyExportAndEveryCoreFunctionIsThere) {
  void* library = ::dlopen(VOYAGER_BIN_DIR "/../lib/libvoyager_test_runtime.so", RTLD_NOW);
  ASSERT_NE(library, nullptr) << ::dlerror();
  EXPECT_NE(::dlsym(library, "xrNegotiateLoaderRuntimeInterface"), nullptr);
  Dl_info found = {};
  for (const char* name : {"xrGetInstanceProcAddr", "xrWaitFrame", "xrCreateInstance"}) {
    void* symbol = ::dlsym(library, name);
    EXPECT_TRUE(!symbol || !::dladdr(symbol, &found) ||
                !std::strstr(found.dli_fname, "voyager_test_runtime"))
        << name;
  }
  const Stage stage(Json::object());
  const Client client;
  for (const char* name :
       {"xrGetInstanceProperties", "xrStructureTypeToString", "xrGetReferenceSpaceBoundsRect",
        "xrCreateActionSpace", "xrEnumerateBoundSourcesForAction", "xrGetInputSourceLocalizedName",
        "xrApplyHapticFeedback", "xrStopHapticFeedback", "xrGetActionStatePose",
        "xrPathToString"}) {
    PFN_xrVoidFunction function = nullptr;
    EXPECT_EQ(xrGetInstanceProcAddr(client.instance, name, &function), XR_SUCCESS) << name;
  }
}

}  // namespace
}  // namespace script_test
}  // namespace test_runtime::test
