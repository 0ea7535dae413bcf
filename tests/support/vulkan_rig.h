#pragma once
// Devices and rings on VulkanMock, a backend's side that holds what it is handed, and what a
// host passes of its own.
#include <functional>
#include <memory>
#include <memory_resource>
#include <new>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "tests/support/vulkan_mock.h"
#include "vulkan_interop/ring.h"

namespace voyager::test {

inline constexpr ExternalSupport kAllSupport{true, true, true};

struct Mode {
  vulkan::Sharing sharing;
  vulkan::Sync sync;
  const char* name;
};
inline constexpr Mode kModes[] = {
    {vulkan::Sharing::device, vulkan::Sync::timeline, "DEVICE TIMELINE"},
    {vulkan::Sharing::device, vulkan::Sync::binary, "DEVICE BINARY"},
    {vulkan::Sharing::device, vulkan::Sync::host, "DEVICE HOST"},
    {vulkan::Sharing::host, vulkan::Sync::timeline, "HOST TIMELINE"},
    {vulkan::Sharing::host, vulkan::Sync::host, "HOST HOST"},
};

inline vulkan::DeviceDesc device_desc(const VulkanMock& mock, const Mode& mode) {
  vulkan::DeviceDesc desc;
  desc.get = &VulkanMock::get_instance;
  desc.instance = VulkanMock::instance();
  desc.physical_device = VulkanMock::physical();
  desc.device = VulkanMock::handle();
  desc.version = VK_API_VERSION_1_2;
  desc.extensions = mock.device.extensions;
  desc.timelines = mock.device.timelines;
  desc.sharing = mode.sharing;
  desc.sync = mode.sync;
  return desc;
}

inline std::shared_ptr<const vulkan::Device> make_device(const VulkanMock& mock, const Mode& mode) {
  return std::make_shared<vulkan::Device>(device_desc(mock, mode), kAllSupport);
}

// Two images of two layers with everything.
inline vulkan::RingDesc ring_desc() {
  vulkan::RingDesc desc;
  desc.format = ColorFormat::rgba8;
  desc.width = 7;
  desc.height = 5;
  desc.images = 2;
  desc.layers = 2;
  desc.depth = desc.depth_limit = true;
  return desc;
}

// The backend's side: it owns what it was handed, and is idle when told so.
class Backend final {
 public:
  explicit Backend(VulkanMock& mock) : mock_(mock) {}

  // It can fail before it takes the first descriptor, and after each.
  std::unique_ptr<ExternalRing> operator()(ExternalRingDesc desc) {
    std::vector<FileDescriptor> taken;
    vulkan::check(mock_.next(), "import");
    const auto take = [&](FileDescriptor& fd) {
      if (fd.get() < 0) return;
      EXPECT_TRUE(is_open(fd.get()));
      identities.push_back(identity_of(fd.get()));
      taken.push_back(std::move(fd));
      vulkan::check(mock_.next(), "import");
    };
    for (ExternalSlot& slot : desc.slots) {
      take(slot.color.memory.fd), take(slot.depth.memory.fd), take(slot.depth_limit.fd);
      take(slot.released), take(slot.rendered);
    }
    got = std::move(desc);
    ++rings;
    return std::make_unique<Held>(*this, std::move(taken));
  }
  vulkan::Ring::ImportRing import() {
    return [this](ExternalRingDesc desc) { return (*this)(std::move(desc)); };
  }

  ExternalRingDesc got;                  // without its descriptors
  std::vector<FileIdentity> identities;  // of those
  std::function<bool()> idle = [] { return true; };
  std::chrono::milliseconds patience{2000};  // with a host that left frames, at the end
  int waits = 0;                             // for frames in flight
  int rings = 0;                             // that live

 private:
  struct Held final : ExternalRing {
    Held(Backend& from, std::vector<FileDescriptor> taken)
        : backend(from), descriptors(std::move(taken)) {}
    ~Held() override {
      EXPECT_TRUE(backend.idle()) << "destroyed with frames in flight";
      --backend.rings;
    }
    bool idle() const override { return backend.idle(); }
    void wait() const override { ++backend.waits; }
    std::chrono::milliseconds patience_at_end() const override { return backend.patience; }
    Backend& backend;
    std::vector<FileDescriptor> descriptors;
  };

  VulkanMock& mock_;
};

// Images, semaphores and their descriptors that are the host's, whatever becomes of a ring.
class Passed {
 public:
  Passed(VulkanMock& mock, const Mode& mode, vulkan::RingDesc& desc) : mock_(mock) {
    const bool shared = mode.sharing == vulkan::Sharing::device;
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const auto memory = [&] {
      return vulkan::ImportedMemory{shared ? descriptor() : -1, 4096, 256, true};
    };
    for (uint32_t i = 0; i < desc.images; ++i)
      desc.imported.push_back({image(desc.layers), image(desc.layers), memory(), memory(), usage,
                               usage | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
    if (mode.sync == vulkan::Sync::host) return;
    const bool timeline = mode.sync == vulkan::Sync::timeline;
    for (uint32_t i = 0; i < (timeline ? 1 : desc.images); ++i)
      desc.semaphores.push_back({semaphore(timeline), semaphore(timeline),
                                 shared ? descriptor() : -1, shared ? descriptor() : -1});
  }
  ~Passed() {
    expect_untouched();
    for (const int fd : descriptors) ::close(fd);
    for (const uint64_t id : objects_) mock_.objects.erase(id);
  }
  Passed(const Passed&) = delete;
  Passed& operator=(const Passed&) = delete;

  void expect_untouched() const {
    for (size_t i = 0; i < descriptors.size(); ++i)
      EXPECT_EQ(identity_of(descriptors[i]), identities[i]);
    for (const uint64_t id : objects_) EXPECT_EQ(mock_.objects.count(id), 1u);
  }

  std::vector<int> descriptors;
  std::vector<FileIdentity> identities;

 private:
  int descriptor() {
    descriptors.push_back(new_descriptor());
    identities.push_back(identity_of(descriptors.back()));
    return descriptors.back();
  }
  VkImage image(uint32_t layers) { return own(mock_.host_image(layers)); }
  VkSemaphore semaphore(bool timeline) { return own(mock_.host_semaphore(timeline)); }
  template <class Handle>
  Handle own(Handle handle) {
    objects_.push_back(VulkanMock::id_of(handle));
    return handle;
  }

  VulkanMock& mock_;
  std::vector<uint64_t> objects_;
};

// What a call throws; "" for nothing.
template <class Function>
std::string thrown_by(const Function& call) {
  try {
    call();
  } catch (const std::bad_alloc&) {
    return "bad_alloc";
  } catch (const Error& error) {
    return "Error " + std::to_string(static_cast<int>(error.code()));
  }
  return "";
}
inline std::string error_of(ErrorCode code) {
  return "Error " + std::to_string(static_cast<int>(code));
}

}  // namespace voyager::test
