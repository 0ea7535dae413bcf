#pragma once
// Entry points of VulkanMock that make, destroy, wait and signal.
#include "tests/support/descriptor_watch.h"
#include "tests/support/vulkan_mock_physical.h"

namespace voyager::test::mock {

using Object = VulkanMock::Object;

#define VULKAN_MOCK_KIND(name)       \
  inline const char* kind_of(name) { \
    return #name;                    \
  }
VULKAN_MOCK_KIND(VkImage)
VULKAN_MOCK_KIND(VkImageView)
VULKAN_MOCK_KIND(VkBuffer)
VULKAN_MOCK_KIND(VkDeviceMemory)
VULKAN_MOCK_KIND(VkSemaphore)
VULKAN_MOCK_KIND(VkDescriptorSetLayout)
VULKAN_MOCK_KIND(VkDescriptorPool)
VULKAN_MOCK_KIND(VkPipelineLayout)
VULKAN_MOCK_KIND(VkShaderModule)
VULKAN_MOCK_KIND(VkPipeline)
#undef VULKAN_MOCK_KIND

template <class Info>
void describe(Object&, const Info&) {}
inline void describe(Object& made, const VkImageCreateInfo& info) {
  made.layers = info.arrayLayers;
  made.bytes = uint64_t{info.extent.width} * info.extent.height * info.arrayLayers * 16;
}
inline void describe(Object& made, const VkImageViewCreateInfo& info) {
  made.parent = VulkanMock::id_of(info.image);
  made.layers = info.subresourceRange.layerCount;
}
inline void describe(Object& made, const VkBufferCreateInfo& info) {
  made.bytes = (info.size + 255) / 256 * 256;
}
inline void describe(Object& made, const VkMemoryAllocateInfo& info) {
  made.bytes = info.allocationSize;
  made.memory_type = info.memoryTypeIndex;
  made.exported = find_in_chain<VkExportMemoryAllocateInfo>(
                      info.pNext, VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO) != nullptr;
  if (const auto* import = find_in_chain<VkImportMemoryHostPointerInfoEXT>(
          info.pNext, VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT)) {
    const uint64_t alignment = VulkanMock::current->device.host_pointer_alignment;
    EXPECT_EQ(reinterpret_cast<uintptr_t>(import->pHostPointer) % alignment, 0u);
    EXPECT_EQ(info.allocationSize % alignment, 0u);
    made.host_pointer = true;
  }
}
inline void describe(Object& made, const VkSemaphoreCreateInfo& info) {
  const auto* type = find_in_chain<VkSemaphoreTypeCreateInfo>(
      info.pNext, VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
  made.timeline = type != nullptr && type->semaphoreType == VK_SEMAPHORE_TYPE_TIMELINE;
  made.exported = find_in_chain<VkExportSemaphoreCreateInfo>(
                      info.pNext, VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO) != nullptr;
}

template <class Handle, class Info>
VkResult create(VkDevice device, const Info* info, const VkAllocationCallbacks*, Handle* out) {
  VulkanMock& mock = *VulkanMock::current;
  EXPECT_EQ(device, VulkanMock::handle());
  if (const VkResult status = mock.next()) return status;
  Object made;
  made.kind = kind_of(Handle{});
  describe(made, *info);
  *out = mock.add<Handle>(std::move(made));
  return VK_SUCCESS;
}

// What is made from another goes before it; what is bound to memory goes before that.
template <class Handle>
void destroy(VkDevice, Handle handle, const VkAllocationCallbacks*) {
  if (handle == VK_NULL_HANDLE) return;
  VulkanMock& mock = *VulkanMock::current;
  const auto found = mock.objects.find(VulkanMock::id_of(handle));
  ASSERT_NE(found, mock.objects.end()) << kind_of(handle) << " destroyed twice, or never made";
  EXPECT_EQ(found->second.kind, kind_of(handle));
  for (const auto& [id, object] : mock.objects)
    EXPECT_TRUE(object.parent != found->first && object.memory != found->first)
        << kind_of(handle) << " destroyed before a " << object.kind << " that uses it";
  mock.objects.erase(found);
}

inline VkResult allocate_memory(VkDevice device, const VkMemoryAllocateInfo* info,
                                const VkAllocationCallbacks* callbacks, VkDeviceMemory* out) {
  const bool of_host =
      find_in_chain<VkImportMemoryHostPointerInfoEXT>(
          info->pNext, VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT) != nullptr;
  const VkResult taken = VulkanMock::current->device.host_import_status;
  if (of_host && taken != VK_SUCCESS) return taken;
  return create(device, info, callbacks, out);
}

template <class Handle>
void get_requirements(VkDevice, Handle handle, VkMemoryRequirements* out) {
  const uint32_t types = std::string(kind_of(handle)) == "VkImage" ? 1 : 7;
  *out = {VulkanMock::current->object(handle).bytes, 256, types};
}

template <class Handle>
VkResult bind(VkDevice, Handle handle, VkDeviceMemory memory, VkDeviceSize offset) {
  VulkanMock& mock = *VulkanMock::current;
  if (const VkResult status = mock.next()) return status;
  Object& bound = mock.object(handle);
  EXPECT_EQ(bound.memory, 0u) << "bound twice";
  EXPECT_LE(offset + bound.bytes, mock.object(memory).bytes);
  bound.memory = VulkanMock::id_of(memory);
  return VK_SUCCESS;
}

inline VkResult map_memory(VkDevice, VkDeviceMemory memory, VkDeviceSize, VkDeviceSize,
                           VkMemoryMapFlags, void** out) {
  VulkanMock& mock = *VulkanMock::current;
  if (const VkResult status = mock.next()) return status;
  Object& mapped = mock.object(memory);
  EXPECT_NE(mapped.memory_type, 0u) << "not host-visible";
  mapped.mapped = std::shared_ptr<void>(std::malloc(mapped.bytes), std::free);
  std::memset(mapped.mapped.get(), 0xcd, mapped.bytes);
  *out = mapped.mapped.get();
  return VK_SUCCESS;
}

inline VkResult get_host_pointer(VkDevice, VkExternalMemoryHandleTypeFlagBits, const void*,
                                 VkMemoryHostPointerPropertiesEXT* out) {
  VulkanMock& mock = *VulkanMock::current;
  if (const VkResult status = mock.next()) return status;
  out->memoryTypeBits = mock.device.host_pointer_types;
  return mock.device.host_pointer_status;
}

template <class Handle>
VkResult export_descriptor(Handle handle, int* fd) {
  VulkanMock& mock = *VulkanMock::current;
  if (const VkResult status = mock.next()) return status;
  EXPECT_TRUE(mock.object(handle).exported) << kind_of(handle) << " was not made to be exported";
  *fd = new_descriptor();
  return VK_SUCCESS;
}
inline VkResult get_memory_fd(VkDevice, const VkMemoryGetFdInfoKHR* info, int* fd) {
  return export_descriptor(info->memory, fd);
}
inline VkResult get_semaphore_fd(VkDevice, const VkSemaphoreGetFdInfoKHR* info, int* fd) {
  return export_descriptor(info->semaphore, fd);
}

inline VkResult allocate_sets(VkDevice, const VkDescriptorSetAllocateInfo* info,
                              VkDescriptorSet* out) {
  VulkanMock& mock = *VulkanMock::current;
  if (const VkResult status = mock.next()) return status;
  EXPECT_TRUE(mock.has(info->descriptorPool));
  // They live with the pool; numbers of their own will do.
  for (uint32_t i = 0; i < info->descriptorSetCount; ++i) {
    EXPECT_TRUE(mock.has(info->pSetLayouts[i]));
    out[i] = VulkanMock::as<VkDescriptorSet>(VulkanMock::id_of(info->descriptorPool) * 1000 + i);
  }
  return VK_SUCCESS;
}
inline void update_sets(VkDevice, uint32_t count, const VkWriteDescriptorSet* writes, uint32_t,
                        const VkCopyDescriptorSet*) {
  VulkanMock& mock = *VulkanMock::current;
  for (uint32_t i = 0; i < count; ++i) {
    EXPECT_TRUE(mock.has(writes[i].pImageInfo->imageView));
    mock.written[writes[i].dstSet].push_back(writes[i].pImageInfo->imageView);
  }
}

inline VkResult create_pipelines(VkDevice device, VkPipelineCache, uint32_t count,
                                 const VkGraphicsPipelineCreateInfo* infos,
                                 const VkAllocationCallbacks* callbacks, VkPipeline* out) {
  EXPECT_EQ(count, 1u);
  return create<VkPipeline>(device, infos, callbacks, out);
}

// Nobody signals while it waits: what is not there yet never comes.
inline VkResult wait_semaphores(VkDevice, const VkSemaphoreWaitInfo* info, uint64_t) {
  VulkanMock& mock = *VulkanMock::current;
  if (const VkResult status = mock.next()) return status;
  VkResult status = VK_SUCCESS;
  for (uint32_t i = 0; i < info->semaphoreCount; ++i) {
    mock.waits.push_back({info->pSemaphores[i], info->pValues[i]});
    EXPECT_TRUE(mock.object(info->pSemaphores[i]).timeline);
    if (mock.value(info->pSemaphores[i]) < info->pValues[i]) status = VK_TIMEOUT;
  }
  return status;
}
inline VkResult signal_semaphore(VkDevice, const VkSemaphoreSignalInfo* info) {
  VulkanMock& mock = *VulkanMock::current;
  if (const VkResult status = mock.next()) return status;
  Object& semaphore = mock.object(info->semaphore);
  EXPECT_TRUE(semaphore.timeline);
  EXPECT_GT(info->value, semaphore.value) << "a timeline must grow";
  semaphore.value = info->value;
  mock.signals.push_back({info->semaphore, info->value});
  return VK_SUCCESS;
}
inline VkResult get_counter(VkDevice, VkSemaphore semaphore, uint64_t* value) {
  VulkanMock& mock = *VulkanMock::current;
  if (const VkResult status = mock.next()) return status;
  *value = mock.value(semaphore);
  return VK_SUCCESS;
}

}  // namespace voyager::test::mock
