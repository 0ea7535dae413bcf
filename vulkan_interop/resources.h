#pragma once
// Vulkan objects with an owner.
#include <cstdint>
#include <memory>
#include <utility>

#include "vulkan_interop/device.h"

namespace voyager::vulkan {

// A handle of the device's, and the function that destroys it.
template <class Handle>
class Owned {
 public:
  using Destroy = void(VKAPI_PTR*)(VkDevice, Handle, const VkAllocationCallbacks*);

  Owned() = default;
  Owned(VkDevice device, Handle handle, Destroy destroy)
      : device_(device), handle_(handle), destroy_(destroy) {}
  Owned(Owned&& other) noexcept { *this = std::move(other); }
  Owned& operator=(Owned&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    std::swap(destroy_, other.destroy_);
    return *this;
  }
  ~Owned() {
    if (handle_ != VK_NULL_HANDLE) destroy_(device_, handle_, nullptr);
  }

  Handle get() const { return handle_; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  Handle handle_ = VK_NULL_HANDLE;
  Destroy destroy_ = nullptr;
};

// Creates through `create(device, &info, nullptr, &handle)`.
template <class Handle, class Create, class Info>
Owned<Handle> make(const Device& device, Create create, typename Owned<Handle>::Destroy destroy,
                   const Info& info, const char* what) {
  Handle handle = VK_NULL_HANDLE;
  check(create(device.handle(), &info, nullptr, &handle), what);
  return {device.handle(), handle, destroy};
}

// An image or a buffer goes before its memory.
struct ImageResource {
  Owned<VkDeviceMemory> memory;
  Owned<VkImage> image;
  uint64_t bytes = 0;  // of the memory
};
struct BufferResource {
  Owned<VkDeviceMemory> memory;
  Owned<VkBuffer> buffer;
  uint64_t bytes = 0;
  void* mapped = nullptr;  // where it is the host's to read and write
};

// 2D, optimal tiling, sampled and copied from. exported: its memory can leave as an opaque
// file descriptor; else it can be copied to.
ImageResource make_image(const Device& device, VkFormat format, uint32_t width, uint32_t height,
                         uint32_t layers, bool exported);
Owned<VkImageView> make_view(const Device& device, VkImage image, VkFormat format, uint32_t layers);

// Copied to and, where the host has it, from. Its memory can leave as a descriptor.
BufferResource make_exported_buffer(const Device& device, uint64_t bytes);
// Host-visible and coherent, mapped.
BufferResource make_mapped_buffer(const Device& device, uint64_t bytes);
// Over memory of the host's, aligned to host_pointer_alignment() in address and size. Its
// `buffer` is none where the device takes no such memory after all.
BufferResource make_imported_buffer(const Device& device, void* memory, uint64_t bytes);
// Tried with the least memory that can be.
bool takes_host_memory(const Device& device);

FileDescriptor export_memory(const Device& device, VkDeviceMemory memory);

Owned<VkSemaphore> make_semaphore(const Device& device, bool timeline, bool exported);
FileDescriptor export_semaphore(const Device& device, VkSemaphore semaphore);

}  // namespace voyager::vulkan
