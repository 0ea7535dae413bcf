// Which way of sharing and of waiting comes out of what a device, its host and a backend have,
// and what `why` says of it.
#include "tests/support/vulkan_rig.h"

namespace voyager::test {
namespace modes_test {
namespace {

using vulkan::Sharing;
using vulkan::Sync;

constexpr const char kMemoryFd[] = VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME;
constexpr const char kSemaphoreFd[] = VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME;

// What is there; a bit each.
struct Having {
  bool memory_fd, semaphore_fd, timelines, exports_timelines, exports_binaries;
  ExternalSupport backend;
  bool exports_images;
};
constexpr uint32_t kHavings = 1u << 9;
Having having_of(uint32_t bits) {
  const auto bit = [&](int i) { return (bits >> i & 1) != 0; };
  return {bit(0), bit(1), bit(2), bit(3), bit(4), {bit(5), bit(6), bit(7)}, bit(8)};
}
MockDevice device_of(const Having& having) {
  MockDevice device;
  if (!having.memory_fd) device.remove(kMemoryFd);
  if (!having.semaphore_fd) device.remove(kSemaphoreFd);
  device.timelines = having.timelines;
  device.exports_timelines = having.exports_timelines;
  device.exports_binaries = having.exports_binaries;
  if (!having.exports_images) device.not_exported = VK_FORMAT_R16G16B16A16_SFLOAT;
  return device;
}

// Why a mode cannot be, "" where it can: the header's words once more, as a table.
std::string why_not(const Having& having, Sharing sharing) {
  if (sharing == Sharing::host) return "";
  if (!having.backend.images) return "the backend does not draw on this device";
  if (!having.memory_fd) return std::string(kMemoryFd) + " is not enabled";
  return having.exports_images ? "" : "the device exports no images of VkFormat 97";
}
std::string why_not(const Having& having, Sharing sharing, Sync sync) {
  const bool shared = sharing == Sharing::device;
  const std::string no_fd = std::string(kSemaphoreFd) + " is not enabled";
  if (sync == Sync::host) return "";
  if (sync == Sync::timeline) {
    if (!having.timelines) return "the feature timelineSemaphore is not enabled";
    if (!shared) return "";
    if (!having.semaphore_fd) return no_fd;
    if (!having.exports_timelines) return "the device exports no timeline semaphores";
    return having.backend.timelines ? "" : "the backend takes no timeline semaphores";
  }
  if (!shared) return "binary semaphores do not work with HOST sharing";
  if (!having.semaphore_fd) return no_fd;
  if (!having.exports_binaries) return "the device exports no semaphores";
  return having.backend.binaries ? "" : "the backend takes no binary semaphores";
}

struct Choice {
  Sharing sharing;
  Sync sync;
  std::string why;      // of the device
  std::string refusal;  // instead of one
};
Choice expected(const Having& having, Sharing sharing, Sync sync) {
  Choice out{sharing, sync, "", why_not(having, Sharing::device)};
  if (sharing == Sharing::device && !out.refusal.empty()) return out;
  if (sharing == Sharing::automatic) {
    out.sharing = out.refusal.empty() ? Sharing::device : Sharing::host;
    out.why = out.refusal;
  }
  out.refusal.clear();
  if (sync != Sync::automatic) {
    out.refusal = why_not(having, out.sharing, sync);
    return out;
  }
  for (const Sync each : {Sync::host, Sync::binary, Sync::timeline})
    if (why_not(having, out.sharing, each).empty()) out.sync = each;
  const std::string no_timelines = why_not(having, out.sharing, Sync::timeline);
  if (!out.why.empty() && !no_timelines.empty()) out.why += "; ";
  out.why += no_timelines;
  return out;
}

TEST(VulkanModes, TheBestThatThereIsIsTakenAndWhatIsForcedIsTakenOrRefused) {
  for (uint32_t bits = 0; bits < kHavings; ++bits) {
    const Having having = having_of(bits);
    const VulkanMock mock(device_of(having));
    for (const Sharing sharing : {Sharing::automatic, Sharing::device, Sharing::host})
      for (const Sync sync : {Sync::automatic, Sync::timeline, Sync::binary, Sync::host}) {
        SCOPED_TRACE(std::to_string(bits) + " " + std::to_string(static_cast<int>(sharing)) + " " +
                     std::to_string(static_cast<int>(sync)));
        const Choice wanted = expected(having, sharing, sync);
        try {
          const vulkan::Device device(device_desc(mock, {sharing, sync, ""}), having.backend);
          EXPECT_EQ(wanted.refusal, "");
          EXPECT_EQ(device.sharing(), wanted.sharing);
          EXPECT_EQ(device.sync(), wanted.sync);
          EXPECT_EQ(device.why(), wanted.why);
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::unsupported);
          ASSERT_NE(wanted.refusal, "") << error.what();
          EXPECT_NE(std::string(error.what()).find(wanted.refusal), std::string::npos)
              << error.what();
        }
      }
  }
}

// A driver may have the extension and share none of the images that a target can have.
TEST(VulkanModes, ADeviceIsAskedForAllThatATargetMayShare) {
  const Mode any{Sharing::automatic, Sync::automatic, ""}, forced{Sharing::device, Sync::host, ""};
  const auto expect_host = [&](const MockDevice& having, const std::string& why) {
    const VulkanMock mock(having);
    const vulkan::Device device(device_desc(mock, any), kAllSupport);
    EXPECT_EQ(device.sharing(), Sharing::host);
    EXPECT_EQ(device.why(), why);
    EXPECT_EQ(thrown_by([&] { make_device(mock, forced); }), error_of(ErrorCode::unsupported));
  };
  for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT,
                                VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32_SFLOAT}) {
    const std::string why = "the device exports no images of VkFormat " + std::to_string(format);
    MockDevice not_shared, not_exported;
    not_shared.not_shared = not_exported.not_exported = format;
    expect_host(not_shared, why);
    expect_host(not_exported, why);
  }
  MockDevice no_buffers;
  no_buffers.exports_buffers = false;
  expect_host(no_buffers, "the device exports no buffers");
}

// What the host did not enable is not used, though the device has it.
TEST(VulkanModes, OnlyWhatTheHostEnabledCounts) {
  const VulkanMock mock;
  const Mode any{Sharing::automatic, Sync::automatic, ""};
  vulkan::DeviceDesc desc = device_desc(mock, any);
  EXPECT_EQ(vulkan::Device(desc, kAllSupport).why(), "");
  desc.timelines = false;
  EXPECT_EQ(vulkan::Device(desc, kAllSupport).sync(), Sync::binary);
  std::erase(desc.extensions, kSemaphoreFd);
  EXPECT_EQ(vulkan::Device(desc, kAllSupport).sync(), Sync::host);
  EXPECT_EQ(vulkan::Device(desc, kAllSupport).sharing(), Sharing::device);
  desc.sharing = Sharing::host;
  EXPECT_TRUE(vulkan::Device(desc, kAllSupport).imports_host_memory());
  desc.sharing = Sharing::automatic;
  EXPECT_FALSE(vulkan::Device(desc, kAllSupport).imports_host_memory());
  desc.extensions.clear();
  EXPECT_EQ(vulkan::Device(desc, kAllSupport).sharing(), Sharing::host);
  EXPECT_FALSE(vulkan::Device(desc, kAllSupport).imports_host_memory());
}

// Vulkan 1.1 has timelines by the extension's names alone.
TEST(VulkanModes, TimelinesComeFromTheExtensionWhereTheVersionHasNone) {
  MockDevice old;
  old.version = VK_API_VERSION_1_1;
  const Mode any{Sharing::automatic, Sync::automatic, ""};
  {
    VulkanMock mock(old);
    vulkan::DeviceDesc desc = device_desc(mock, any);
    desc.version = VK_API_VERSION_1_1;
    EXPECT_EQ(vulkan::Device(desc, kAllSupport).sync(), Sync::timeline);
  }
  old.remove(VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME);
  const VulkanMock mock(old);
  EXPECT_EQ(vulkan::Device(device_desc(mock, any), kAllSupport).sync(), Sync::binary);
}

TEST(VulkanModes, VersionsBelowTheLeastAreRefused) {
  const Mode any{Sharing::automatic, Sync::automatic, ""};
  {
    const VulkanMock mock;
    vulkan::DeviceDesc desc = device_desc(mock, any);
    desc.version = VK_API_VERSION_1_0;
    EXPECT_EQ(thrown_by([&] { vulkan::Device(desc, kAllSupport); }),
              error_of(ErrorCode::unsupported));
  }
  MockDevice old;
  old.version = VK_API_VERSION_1_0;
  const VulkanMock mock(old);
  EXPECT_EQ(thrown_by([&] { make_device(mock, any); }), error_of(ErrorCode::unsupported));
}

}  // namespace
}  // namespace modes_test
}  // namespace voyager::test
