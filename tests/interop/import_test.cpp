// Images, memory and semaphores of the host's own, by descriptor.
#include <fcntl.h>

#include <algorithm>
#include <iostream>

#include "frames.h"

namespace import_test {
namespace {

constexpr uint32_t kImages = 2;

ImageDesc plane(VkFormat format, uint32_t width, uint32_t height, bool exported) {
  ImageDesc desc;
  desc.format = format;
  desc.width = width, desc.height = height;
  desc.usage |= VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  desc.exported = exported;
  return desc;
}

VoyVulkanMemory dedicated_memory(const HostImage& image) {
  const bool exported = image.desc.exported;
  return {{exported ? image.export_fd() : -1},
          VOY_VULKAN_MEMORY_HANDLE_TYPE,
          exported ? VK_TRUE : VK_FALSE,
          image.bytes,
          0};
}

// Each in memory of its own.
struct DedicatedImages {
  DedicatedImages(const VulkanHost& host, uint32_t width, uint32_t height, bool exported,
                  bool with_depth) {
    for (uint32_t i = 0; i < kImages; ++i) {
      VoyVulkanImportedImage& out = passed.emplace_back();
      out = VOY_VULKAN_IMPORTED_IMAGE_INIT;
      const auto make = [&](VkFormat format, VkImage& image, VoyVulkanMemory& memory,
                            VkImageUsageFlags& usage) {
        const ImageDesc desc = plane(format, width, height, exported);
        const auto& made = images.emplace_back(std::make_unique<HostImage>(host, desc));
        image = made->image;
        memory = dedicated_memory(*made);
        usage = desc.usage;
      };
      make(VK_FORMAT_R8G8B8A8_UNORM, out.color, out.colorMemory, out.colorUsage);
      if (with_depth) make(VK_FORMAT_R32_SFLOAT, out.depth, out.depthMemory, out.depthUsage);
    }
  }
  std::vector<std::unique_ptr<HostImage>> images;
  std::vector<VoyVulkanImportedImage> passed;
};

// As an engine's allocator has them: all in one memory, none at its start, exported once.
class ImagesInOneMemory {
 public:
  ImagesInOneMemory(const VulkanHost& owner, uint32_t width, uint32_t height, bool exported)
      : host_(owner) {
    passed.assign(kImages, VOY_VULKAN_IMPORTED_IMAGE_INIT);
    for (VoyVulkanImportedImage& out : passed) {
      place(plane(VK_FORMAT_R8G8B8A8_UNORM, width, height, exported), out.color, out.colorMemory,
            out.colorUsage);
      place(plane(VK_FORMAT_R32_SFLOAT, width, height, exported), out.depth, out.depthMemory,
            out.depthUsage);
    }
    const VkExportMemoryAllocateInfo shared{VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO, nullptr,
                                            VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT};
    const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                    exported ? &shared : nullptr, bytes_,
                                    host_.memory_type(types_, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)};
    VK(vkAllocateMemory(host_.device, &info, nullptr, &memory_));
    const int fd = exported ? export_memory_fd(host_, memory_) : -1;
    for (VoyVulkanImportedImage& out : passed) {
      bind(out.color, out.colorMemory, fd);
      bind(out.depth, out.depthMemory, fd);
    }
  }
  ~ImagesInOneMemory() {
    for (const VoyVulkanImportedImage& out : passed) {
      vkDestroyImage(host_.device, out.color, nullptr);
      vkDestroyImage(host_.device, out.depth, nullptr);
    }
    vkFreeMemory(host_.device, memory_, nullptr);
  }
  ImagesInOneMemory(const ImagesInOneMemory&) = delete;
  ImagesInOneMemory& operator=(const ImagesInOneMemory&) = delete;

  // A driver may want memory of its own for each image that is shared.
  static bool can_be(const VulkanHost& host, bool exported) {
    const VkImage image = make_host_image(host, plane(VK_FORMAT_R8G8B8A8_UNORM, 8, 8, exported));
    VkMemoryDedicatedRequirements dedicated{};
    dedicated.sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_REQUIREMENTS;
    VkMemoryRequirements2 needs{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2, &dedicated, {}};
    const VkImageMemoryRequirementsInfo2 info{VK_STRUCTURE_TYPE_IMAGE_MEMORY_REQUIREMENTS_INFO_2,
                                              nullptr, image};
    vkGetImageMemoryRequirements2(host.device, &info, &needs);
    vkDestroyImage(host.device, image, nullptr);
    return dedicated.requiresDedicatedAllocation == VK_FALSE;
  }

  std::vector<VoyVulkanImportedImage> passed;

 private:
  void place(const ImageDesc& desc, VkImage& image, VoyVulkanMemory& memory,
             VkImageUsageFlags& usage) {
    image = make_host_image(host_, desc);
    usage = desc.usage;
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(host_.device, image, &needs);
    types_ &= needs.memoryTypeBits;
    memory.offset = (bytes_ + needs.alignment - 1) / needs.alignment * needs.alignment;
    bytes_ = memory.offset + needs.size;
  }
  void bind(VkImage image, VoyVulkanMemory& memory, int fd) const {
    memory.handle.fd = fd;
    memory.size = bytes_;
    VK(vkBindImageMemory(host_.device, image, memory_, memory.offset));
  }

  const VulkanHost& host_;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  uint32_t types_ = UINT32_MAX;
  VkDeviceSize bytes_ = 1;  // so that the first has an offset
};

class OwnSemaphores {
 public:
  OwnSemaphores(const VulkanHost& owner, VoyVulkanSync sync, bool exported)
      : host_(owner), timeline_(sync == VOY_VULKAN_SYNC_TIMELINE), exported_(exported) {
    if (sync == VOY_VULKAN_SYNC_HOST) return;
    passed.assign(timeline_ ? 1 : kImages, VOY_VULKAN_IMPORTED_SEMAPHORES_INIT);
    for (VoyVulkanImportedSemaphores& pair : passed) {
      make(pair.released, pair.releasedHandle.fd);
      make(pair.rendered, pair.renderedHandle.fd);
    }
  }
  ~OwnSemaphores() {
    for (const VoyVulkanImportedSemaphores& pair : passed) {
      vkDestroySemaphore(host_.device, pair.released, nullptr);
      vkDestroySemaphore(host_.device, pair.rendered, nullptr);
    }
  }
  OwnSemaphores(const OwnSemaphores&) = delete;
  OwnSemaphores& operator=(const OwnSemaphores&) = delete;

  std::vector<VoyVulkanImportedSemaphores> passed;

 private:
  void make(VkSemaphore& semaphore, int& fd) const {
    const VkExportSemaphoreCreateInfo shared{VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO,
                                             nullptr,
                                             VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT};
    const void* next = exported_ ? &shared : nullptr;
    const VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, next,
                                         VK_SEMAPHORE_TYPE_TIMELINE, 0};
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
                                     timeline_ ? &type : next, 0};
    VK(vkCreateSemaphore(host_.device, &info, nullptr, &semaphore));
    if (!exported_) return;
    const auto get = reinterpret_cast<PFN_vkGetSemaphoreFdKHR>(
        vkGetDeviceProcAddr(host_.device, "vkGetSemaphoreFdKHR"));
    const VkSemaphoreGetFdInfoKHR wanted{VK_STRUCTURE_TYPE_SEMAPHORE_GET_FD_INFO_KHR, nullptr,
                                         semaphore,
                                         VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT};
    VK(get(host_.device, &wanted, &fd));
  }

  const VulkanHost& host_;
  bool timeline_, exported_;
};

class Imports : public Interop {
 protected:
  bool shared() const { return found.sharing == VOY_VULKAN_SHARING_DEVICE; }

  // Frames into the host's own, which are the same as in host memory.
  void draw_into(const std::vector<VoyVulkanImportedImage>& own) {
    const OwnSemaphores semaphores(*host, found.sync, shared());
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.hasDepth = own[0].depth != VK_NULL_HANDLE ? VK_TRUE : VK_FALSE;
    images.images = own.data();
    images.semaphoreCount = static_cast<uint32_t>(semaphores.passed.size());
    images.semaphores = semaphores.passed.data();
    const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
    ASSERT_NE(target, nullptr);
    if (shared()) expect_taken(own, semaphores.passed);
    Line line = line_of(target);
    for (uint32_t frame = 0; frame < 4; ++frame) {
      const uint32_t image = frame % kImages;
      EXPECT_EQ(line.images[image].color, own[image].color);
      EXPECT_EQ(line.images[image].depth, own[image].depth);
      if (!semaphores.passed.empty()) {
        EXPECT_EQ(line.images[image].released,
                  semaphores.passed[image % semaphores.passed.size()].released);
      }
      const VoyFrameEye at = eye(target, frame);
      const Shot shot = shoot(line, target, image, at, 4);
      const Shot whole = expected(VOY_COLOR_FORMAT_RGBA8_UNORM, at, 4);
      EXPECT_EQ(shot.color, whole.color) << "frame " << frame;
      if (images.hasDepth != VK_FALSE) {
        EXPECT_EQ(shot.depth, whole.depth) << "frame " << frame;
      }
    }
    EXPECT_EQ(voyDestroyTarget(target), VOY_SUCCESS);
  }

 private:
  static void expect_taken(const std::vector<VoyVulkanImportedImage>& own,
                           const std::vector<VoyVulkanImportedSemaphores>& semaphores) {
    const auto closed = [](int fd) {
      EXPECT_EQ(::fcntl(fd, F_GETFD), -1) << "it is the library's now";
    };
    for (const VoyVulkanImportedImage& image : own) {
      closed(image.colorMemory.handle.fd);
      if (image.depth != VK_NULL_HANDLE) closed(image.depthMemory.handle.fd);
    }
    for (const VoyVulkanImportedSemaphores& pair : semaphores)
      closed(pair.releasedHandle.fd), closed(pair.renderedHandle.fd);
  }
};

TEST_F(Imports, ImagesOfTheHostsAreFilled) {
  FOR_EACH_MODE({
    for (const bool depth : {false, true}) {
      const DedicatedImages own(*host, kWidth, kHeight, shared(), depth);
      draw_into(own.passed);
    }
  });
}

TEST_F(Imports, ImagesInOneMemoryAreFilledWhereTheyLie) {
  FOR_EACH_MODE({
    if (!ImagesInOneMemory::can_be(*host, shared())) {
      std::cout << "this driver wants memory of its own for each image\n";
      continue;
    }
    const ImagesInOneMemory own(*host, kWidth, kHeight, shared());
    EXPECT_GT(own.passed[0].colorMemory.offset, 0u);
    draw_into(own.passed);
  });
}

TEST_F(Imports, ADescriptorThatIsRefusedStaysTheHosts) {
  if (!create(VOY_VULKAN_SHARING_DEVICE)) VOYAGER_SKIP_WITHOUT(CUDA, voyGetLastErrorMessage());
  DedicatedImages own(*host, kWidth, kHeight, true, false);
  const int second =
      std::exchange(own.passed[1].colorMemory.handle.fd, ::open("/dev/null", O_RDONLY));
  VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
  images.images = own.passed.data();
  const VoyTargetDesc desc = target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images);
  VoyTarget target = nullptr;
  EXPECT_NE(voyCreateTarget(device, &desc, &target), VOY_SUCCESS);
  for (const VoyVulkanImportedImage& image : own.passed)
    EXPECT_EQ(::close(image.colorMemory.handle.fd), 0) << voyGetLastErrorMessage();
  EXPECT_EQ(::close(second), 0);
}

}  // namespace
}  // namespace import_test
