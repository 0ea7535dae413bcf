#include "vulkan_interop/resources.h"

#include <new>

#include "runtime/base/error.h"

namespace voyager::vulkan {
namespace {

constexpr VkExternalMemoryHandleTypeFlagBits kOpaque = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
constexpr VkExternalMemoryHandleTypeFlagBits kHostPointer =
    VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
constexpr VkMemoryPropertyFlags kMapped =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr uint32_t kNoType = UINT32_MAX;

// The first of the types with all of the flags.
uint32_t find_type(const Device& device, uint32_t types, VkMemoryPropertyFlags flags) {
  const VkPhysicalDeviceMemoryProperties& memory = device.physical().memory();
  for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
    if ((types >> i & 1) != 0 && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
  return kNoType;
}

uint32_t need_type(const Device& device, uint32_t types, VkMemoryPropertyFlags flags) {
  const uint32_t type = find_type(device, types, flags);
  if (type == kNoType)
    throw Error(ErrorCode::unsupported, "Vulkan: memory: found no type with the flags " +
                                            std::to_string(flags) + " among " +
                                            std::to_string(types));
  return type;
}

Owned<VkDeviceMemory> allocate(const Device& device, uint64_t bytes, uint32_t type,
                               const void* next) {
  const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, next, bytes, type};
  return make<VkDeviceMemory>(device, device.functions().AllocateMemory,
                              device.functions().FreeMemory, info, "vkAllocateMemory");
}

// Each in memory of its own, which some drivers ask for where it is shared.
Owned<VkDeviceMemory> allocate_exported(const Device& device, const VkMemoryRequirements& needs,
                                        VkImage image, VkBuffer buffer) {
  const VkMemoryDedicatedAllocateInfo dedicated{VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO,
                                                nullptr, image, buffer};
  const VkExportMemoryAllocateInfo exported{VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO,
                                            &dedicated, kOpaque};
  return allocate(device, needs.size,
                  need_type(device, needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT),
                  &exported);
}

Owned<VkBuffer> make_buffer(const Device& device, uint64_t bytes, const void* next) {
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.pNext = next;
  info.size = bytes;
  info.usage = kBufferUsage;
  return make<VkBuffer>(device, device.functions().CreateBuffer, device.functions().DestroyBuffer,
                        info, "vkCreateBuffer");
}

VkMemoryRequirements requirements(const Device& device, VkBuffer buffer) {
  VkMemoryRequirements needs;
  device.functions().GetBufferMemoryRequirements(device.handle(), buffer, &needs);
  return needs;
}

void bind(const Device& device, const BufferResource& made) {
  check(
      device.functions().BindBufferMemory(device.handle(), made.buffer.get(), made.memory.get(), 0),
      "vkBindBufferMemory");
}

}  // namespace

ImageResource make_image(const Device& device, VkFormat format, uint32_t width, uint32_t height,
                         uint32_t layers, bool exported) {
  const DeviceFunctions& vk = device.functions();
  const VkExternalMemoryImageCreateInfo external{
      VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO, nullptr, kOpaque};
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.pNext = exported ? &external : nullptr;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {width, height, 1};
  info.mipLevels = 1;
  info.arrayLayers = layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = kImageUsage;
  info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  ImageResource made;
  made.image = make<VkImage>(device, vk.CreateImage, vk.DestroyImage, info, "vkCreateImage");
  VkMemoryRequirements needs;
  vk.GetImageMemoryRequirements(device.handle(), made.image.get(), &needs);
  made.bytes = needs.size;
  made.memory =
      exported
          ? allocate_exported(device, needs, made.image.get(), VK_NULL_HANDLE)
          : allocate(device, needs.size,
                     need_type(device, needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT),
                     nullptr);
  check(vk.BindImageMemory(device.handle(), made.image.get(), made.memory.get(), 0),
        "vkBindImageMemory");
  return made;
}

Owned<VkImageView> make_view(const Device& device, VkImage image, VkFormat format,
                             uint32_t layers) {
  VkImageViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = image;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  info.format = format;
  info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layers};
  return make<VkImageView>(device, device.functions().CreateImageView,
                           device.functions().DestroyImageView, info, "vkCreateImageView");
}

BufferResource make_exported_buffer(const Device& device, uint64_t bytes) {
  const VkExternalMemoryBufferCreateInfo external{
      VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO, nullptr, kOpaque};
  BufferResource made;
  made.buffer = make_buffer(device, bytes, &external);
  const VkMemoryRequirements needs = requirements(device, made.buffer.get());
  made.bytes = needs.size;
  made.memory = allocate_exported(device, needs, VK_NULL_HANDLE, made.buffer.get());
  bind(device, made);
  return made;
}

BufferResource make_mapped_buffer(const Device& device, uint64_t bytes) {
  BufferResource made;
  made.buffer = make_buffer(device, bytes, nullptr);
  const VkMemoryRequirements needs = requirements(device, made.buffer.get());
  made.bytes = needs.size;
  // Cached where there is such a type: the host's depth is read from it.
  uint32_t type =
      find_type(device, needs.memoryTypeBits, kMapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
  if (type == kNoType) type = need_type(device, needs.memoryTypeBits, kMapped);
  made.memory = allocate(device, needs.size, type, nullptr);
  bind(device, made);
  check(device.functions().MapMemory(device.handle(), made.memory.get(), 0, VK_WHOLE_SIZE, 0,
                                     &made.mapped),
        "vkMapMemory");
  return made;
}

BufferResource make_imported_buffer(const Device& device, void* memory, uint64_t bytes) {
  VkMemoryHostPointerPropertiesEXT properties{VK_STRUCTURE_TYPE_MEMORY_HOST_POINTER_PROPERTIES_EXT,
                                              nullptr, 0};
  const VkResult found = device.functions().GetMemoryHostPointerPropertiesEXT(
      device.handle(), kHostPointer, memory, &properties);
  if (found == VK_ERROR_INVALID_EXTERNAL_HANDLE) return {};
  check(found, "vkGetMemoryHostPointerPropertiesEXT");
  const VkExternalMemoryBufferCreateInfo external{
      VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO, nullptr, kHostPointer};
  BufferResource made;
  made.buffer = make_buffer(device, bytes, &external);
  const VkMemoryRequirements needs = requirements(device, made.buffer.get());
  const uint32_t type =
      find_type(device, needs.memoryTypeBits & properties.memoryTypeBits, kMapped);
  if (type == kNoType || needs.size > bytes) return {};
  const VkImportMemoryHostPointerInfoEXT import{
      VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT, nullptr, kHostPointer, memory};
  const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &import, bytes, type};
  VkDeviceMemory taken = VK_NULL_HANDLE;
  const VkResult status =
      device.functions().AllocateMemory(device.handle(), &info, nullptr, &taken);
  if (status == VK_ERROR_INVALID_EXTERNAL_HANDLE) return {};
  check(status, "vkAllocateMemory");
  made.bytes = bytes;
  made.memory = {device.handle(), taken, device.functions().FreeMemory};
  bind(device, made);
  made.mapped = memory;
  return made;
}

bool takes_host_memory(const Device& device) {
  const uint64_t page = device.physical().host_pointer_alignment();
  const auto release = [&](void* memory) { ::operator delete(memory, std::align_val_t(page)); };
  const std::unique_ptr<void, decltype(release)> memory(
      ::operator new(page, std::align_val_t(page)), release);
  return make_imported_buffer(device, memory.get(), page).mapped != nullptr;
}

FileDescriptor export_memory(const Device& device, VkDeviceMemory memory) {
  const VkMemoryGetFdInfoKHR info{VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR, nullptr, memory,
                                  kOpaque};
  int fd = -1;
  check(device.functions().GetMemoryFdKHR(device.handle(), &info, &fd), "vkGetMemoryFdKHR");
  return FileDescriptor(fd);
}

Owned<VkSemaphore> make_semaphore(const Device& device, bool timeline, bool exported) {
  const VkExportSemaphoreCreateInfo exports{VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO, nullptr,
                                            VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT};
  const void* next = exported ? &exports : nullptr;
  const VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, next,
                                       VK_SEMAPHORE_TYPE_TIMELINE, 0};
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, timeline ? &type : next,
                                   0};
  return make<VkSemaphore>(device, device.functions().CreateSemaphore,
                           device.functions().DestroySemaphore, info, "vkCreateSemaphore");
}

FileDescriptor export_semaphore(const Device& device, VkSemaphore semaphore) {
  const VkSemaphoreGetFdInfoKHR info{VK_STRUCTURE_TYPE_SEMAPHORE_GET_FD_INFO_KHR, nullptr,
                                     semaphore, VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT};
  int fd = -1;
  check(device.functions().GetSemaphoreFdKHR(device.handle(), &info, &fd), "vkGetSemaphoreFdKHR");
  return FileDescriptor(fd);
}

}  // namespace voyager::vulkan
