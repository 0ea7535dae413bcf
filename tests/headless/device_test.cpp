// Which backend a host gets, on machines with a CUDA device and without, and that
// VoyCapabilities says what it takes.
#include <voyager/voyager_experiment.h>

#include "on_backend.h"

namespace device_test {
namespace {

constexpr VoyBackend kBackends[] = {VOY_BACKEND_AUTO, VOY_BACKEND_CPU, VOY_BACKEND_CUDA,
                                    VOY_BACKEND_REFERENCE};

struct Uuid {
  uint8_t bytes[16] = {};
  bool operator==(const Uuid& other) const {
    return std::memcmp(bytes, other.bytes, sizeof bytes) == 0;
  }
};
constexpr Uuid kCpu = {};
constexpr Uuid kNobodys = {{0x9a, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}};

class Devices : public ::testing::Test {
 protected:
  bool has_cuda() const { return voy.QueryBackend(VOY_BACKEND_CUDA) == VOY_SUCCESS; }
  VoyDevice create(VoyBackend backend, const Uuid* uuid) {
    VoyDeviceDesc desc = device_for(backend);
    desc.deviceUuid = uuid == nullptr ? nullptr : uuid->bytes;
    VoyDevice device = nullptr;
    result = voy.CreateDevice(&desc, &device);
    EXPECT_EQ(result == VOY_SUCCESS, device != nullptr);
    return device;
  }
  VoyCapabilities capabilities(VoyDevice device) {
    VoyCapabilities found = VOY_CAPABILITIES_INIT;
    EXPECT_EQ(voy.GetCapabilities(device, &found), VOY_SUCCESS) << voy.message();
    return found;
  }
  static Uuid uuid_of(const VoyCapabilities& capabilities) {
    Uuid uuid;
    std::memcpy(uuid.bytes, capabilities.deviceUuid, sizeof uuid.bytes);
    return uuid;
  }
  void expect_chosen(VoyBackend asked, const Uuid* uuid, VoyBackend expected) {
    const VoyDevice device = create(asked, uuid);
    ASSERT_EQ(result, VOY_SUCCESS) << voy.message();
    const VoyCapabilities found = capabilities(device);
    EXPECT_EQ(found.backend, expected);
    EXPECT_EQ(uuid_of(found) == kCpu, expected != VOY_BACKEND_CUDA);
    EXPECT_NE(found.deviceName[0], '\0');
    EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS);
  }
  void expect_none(VoyBackend asked, const Uuid* uuid, const char* part) {
    create(asked, uuid);
    EXPECT_EQ(result, VOY_ERROR_NO_DEVICE);
    EXPECT_NE(voy.message().find(part), std::string::npos) << voy.message();
  }

  Library voy;
  VoyResult result = VOY_SUCCESS;
};

TEST_F(Devices, QueryingSaysWhatCreatingDoes) {
  for (const VoyBackend backend : kBackends) {
    const VoyResult asked = voy.QueryBackend(backend);
    const VoyDevice device = create(backend, nullptr);
    EXPECT_EQ(result, asked) << voy.message();
    EXPECT_TRUE(asked == VOY_SUCCESS || backend == VOY_BACKEND_CUDA) << voy.message();
    EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS);
  }
}

TEST_F(Devices, AutoIsCudaWhereThereIsADevice) {
  const VoyBackend fastest = has_cuda() ? VOY_BACKEND_CUDA : VOY_BACKEND_CPU;
  expect_chosen(VOY_BACKEND_AUTO, nullptr, fastest);
  expect_chosen(VOY_BACKEND_CPU, nullptr, VOY_BACKEND_CPU);
  expect_chosen(VOY_BACKEND_REFERENCE, nullptr, VOY_BACKEND_REFERENCE);
}

TEST_F(Devices, AUuidPicksTheDevice) {
  for (const VoyBackend backend : {VOY_BACKEND_AUTO, VOY_BACKEND_CPU})
    expect_chosen(backend, &kCpu, VOY_BACKEND_CPU);
  expect_chosen(VOY_BACKEND_REFERENCE, &kCpu, VOY_BACKEND_REFERENCE);
  expect_chosen(VOY_BACKEND_AUTO, &kNobodys, VOY_BACKEND_CPU);
  for (const VoyBackend backend : {VOY_BACKEND_CPU, VOY_BACKEND_REFERENCE})
    expect_none(backend, &kNobodys, "deviceUuid");
  for (const Uuid* uuid : {&kCpu, &kNobodys}) expect_none(VOY_BACKEND_CUDA, uuid, "");
}

TEST_F(Devices, ACudaDeviceIsFoundByTheUuidItReports) {
  const VoyDevice device = create(VOY_BACKEND_CUDA, nullptr);
  if (result != VOY_SUCCESS) VOYAGER_SKIP_WITHOUT(CUDA, voy.message());
  const Uuid uuid = uuid_of(capabilities(device));
  EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS);
  for (const VoyBackend backend : {VOY_BACKEND_AUTO, VOY_BACKEND_CUDA})
    expect_chosen(backend, &uuid, VOY_BACKEND_CUDA);
}

TEST_F(Devices, WithoutCudaTheRefusalSaysWhatWasFound) {
  if (has_cuda()) GTEST_SKIP() << "this machine has a CUDA device";
  const std::string prefix = "voyQueryBackend: ", why = voy.message().substr(prefix.size());
  EXPECT_TRUE(why.find("CUDA") != std::string::npos || why.find("cuda") != std::string::npos)
      << why;
  expect_none(VOY_BACKEND_CUDA, nullptr, why.c_str());
}

// Warnings of a device that is made and destroyed again, at the level that hosts get by default.
std::string creation_log(const Library& voy, VoyBackend backend, const Uuid* uuid) {
  std::string text;
  VoyDeviceDesc desc = device_for(backend);
  desc.deviceUuid = uuid == nullptr ? nullptr : uuid->bytes;
  desc.logUser = &text;
  desc.log = [](void* user, VoyLogLevel level, const char* message) {
    EXPECT_EQ(level, VOY_LOG_LEVEL_WARNING) << message;
    *static_cast<std::string*>(user) += std::string(message) + "\n";
  };
  VoyDevice device = nullptr;
  EXPECT_EQ(voy.CreateDevice(&desc, &device), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS);
  return text;
}

// With CUDA's own words, which say what to do, and no word where the CPU was asked for.
TEST_F(Devices, AWarningSaysWhyAutoIsNotCuda) {
  const std::string words = "AUTO chose the CPU: ";
  EXPECT_NE(creation_log(voy, VOY_BACKEND_AUTO, &kNobodys).find(words), std::string::npos);
  if (voy.QueryBackend(VOY_BACKEND_CUDA) == VOY_SUCCESS) {
    EXPECT_EQ(creation_log(voy, VOY_BACKEND_AUTO, nullptr), "");
  } else {
    const std::string prefix = "voyQueryBackend: ", why = voy.message().substr(prefix.size());
    EXPECT_EQ(creation_log(voy, VOY_BACKEND_AUTO, nullptr),
              "voyCreateDevice: " + words + why + "\n");
  }
  EXPECT_EQ(creation_log(voy, VOY_BACKEND_AUTO, &kCpu), "");
  EXPECT_EQ(creation_log(voy, VOY_BACKEND_CPU, nullptr), "");
}

TEST_F(Devices, TheListHasEachBackendAndSaysWhatIsMissing) {
  uint32_t count = 0;
  ASSERT_EQ(voy.EnumerateDevices(0, nullptr, &count), VOY_SUCCESS) << voy.message();
  ASSERT_GE(count, 3u);
  std::vector<VoyDeviceInfo> devices(count);
  EXPECT_EQ(voy.EnumerateDevices(1, devices.data(), &count), VOY_INCOMPLETE);
  EXPECT_EQ(count, devices.size());
  ASSERT_EQ(voy.EnumerateDevices(count, devices.data(), &count), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(devices.front().backend, VOY_BACKEND_CUDA);
  EXPECT_EQ(devices[count - 2].backend, VOY_BACKEND_CPU);
  EXPECT_EQ(devices.back().backend, VOY_BACKEND_REFERENCE);
  for (const VoyDeviceInfo& info : devices) {
    EXPECT_EQ(info.type, VOY_STRUCTURE_TYPE_DEVICE_INFO);
    EXPECT_NE(info.needs[0], '\0');
    EXPECT_EQ(info.usable == 1, info.why[0] == '\0') << info.why;
    if (info.usable == 0) continue;
    EXPECT_NE(info.deviceName[0], '\0');
    EXPECT_GT(info.memoryBytes, 0u);
    Uuid uuid;
    std::memcpy(uuid.bytes, info.deviceUuid, sizeof uuid.bytes);
    expect_chosen(info.backend, &uuid, info.backend);
  }
  EXPECT_EQ(voy.EnumerateDevices(0, nullptr, nullptr), VOY_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(voy.EnumerateDevices(1, nullptr, &count), VOY_ERROR_INVALID_ARGUMENT);
}

bool has(uint32_t mask, int enumerant) {
  return (mask >> enumerant & 1) != 0;
}

// Each choice by itself, the others as they are by default.
void expect_views_as_capable(Host& host, const VoyExperimentCapabilities& found) {
  const auto expect_made = [&](bool expected, const VoyExperiment& experiment) {
    VoyViewDesc desc = host.view_desc();
    desc.next = &experiment;
    VoyView view = nullptr;
    const VoyResult result = host.voy.CreateView(host.device, &desc, &view);
    EXPECT_EQ(result, expected ? VOY_SUCCESS : VOY_ERROR_UNSUPPORTED) << host.voy.message();
    EXPECT_EQ(host.voy.DestroyView(view), VOY_SUCCESS);
  };
  VoyExperiment experiment = VOY_EXPERIMENT_INIT;
  for (const VoySearch search :
       {VOY_SEARCH_AUTO, VOY_SEARCH_EXHAUSTIVE, VOY_SEARCH_STREAMING, VOY_SEARCH_TEMPORAL,
        VOY_SEARCH_TEMPORAL_VISIT, VOY_SEARCH_SWEEP}) {
    experiment.search = search;
    expect_made(has(found.searches, search), experiment);
  }
  experiment = VOY_EXPERIMENT_INIT;
  for (const VoyExponential exponential :
       {VOY_EXPONENTIAL_AUTO, VOY_EXPONENTIAL_EXACT, VOY_EXPONENTIAL_EX2, VOY_EXPONENTIAL_LUT,
        VOY_EXPONENTIAL_HALF2}) {
    experiment.exponential = exponential;
    expect_made(has(found.exponentials, exponential), experiment);
  }
  experiment = VOY_EXPERIMENT_INIT;
  for (const VoySplatting splatting : {VOY_SPLATTING_OURS, VOY_SPLATTING_3DGS}) {
    experiment.splatting = splatting;
    expect_made(has(found.splattings, splatting), experiment);
  }
}

class Capabilities : public OnBackend {};
INSTANTIATE_TEST_SUITE_P(Of, Capabilities, ::testing::ValuesIn(kBackends), backend_name);

TEST_P(Capabilities, AreWhatAViewMayChoose) {
  Host host(voy, device_for(GetParam()));
  VoyExperimentCapabilities experiment = VOY_EXPERIMENT_CAPABILITIES_INIT;
  VoyCapabilities found = VOY_CAPABILITIES_INIT;
  found.next = &experiment;
  ASSERT_EQ(voy.GetCapabilities(host.device, &found), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(has(experiment.splattings, VOY_SPLATTING_3DGS), found.backend == VOY_BACKEND_CUDA);
  expect_views_as_capable(host, experiment);
}

TEST_F(Devices, TheCpuNamesTheBaselineItLacks) {
  for (const VoyBackend backend : {VOY_BACKEND_CPU, VOY_BACKEND_REFERENCE}) {
    Host host(voy, device_for(backend));
    VoyViewDesc desc = host.view_desc();
    VoyExperiment experiment = VOY_EXPERIMENT_INIT;
    experiment.splatting = VOY_SPLATTING_3DGS;
    desc.next = &experiment;
    VoyView view = nullptr;
    EXPECT_EQ(voy.CreateView(host.device, &desc, &view), VOY_ERROR_UNSUPPORTED);
    EXPECT_NE(voy.message().find("3dgs"), std::string::npos) << voy.message();
    EXPECT_EQ(view, nullptr);
  }
}

TEST_F(Devices, AWholeImageHasDroppedNoPair) {
  for (const VoyBackend backend : {VOY_BACKEND_CPU, VOY_BACKEND_REFERENCE}) {
    Host host(voy, device_for(backend));
    ASSERT_EQ(host.render(), VOY_SUCCESS) << voy.message();
    VoyFrameStats stats = VOY_FRAME_STATS_INIT;
    std::memset(&stats.pairsDropped, 0xff, sizeof stats.pairsDropped);
    ASSERT_EQ(voy.GetFrameStats(host.view, &stats), VOY_SUCCESS) << voy.message();
    EXPECT_EQ(stats.pairsDropped, 0u);
  }
}

}  // namespace
}  // namespace device_test
