#include "plugin/vulkan_target.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <set>

#include "plugin/call.h"
#include "plugin/structs.h"

using namespace voyager;

namespace {

void check_no_memory(const VoyTargetDesc& desc) {
  if (desc.color != nullptr || desc.depth != nullptr || desc.colorRowPitch != 0 ||
      desc.depthRowPitch != 0)
    refuse(
        "desc: found host memory or a pitch with kind VULKAN, expected color and depth NULL and "
        "pitches 0");
}

// Whether the host passed an image where the target has one, and only there.
void check_image(bool wanted, bool passed, const FieldName& field) {
  if (wanted != passed)
    refuse(field.str() + (wanted ? ": found VK_NULL_HANDLE, expected an image"
                                 : ": found an image, expected VK_NULL_HANDLE"));
}

void check_semaphore(VkSemaphore semaphore, const FieldName& field) {
  if (semaphore == VK_NULL_HANDLE)
    refuse(field.str() + ": found VK_NULL_HANDLE, expected a semaphore");
}

vulkan::ImportedMemory memory_of(const VoyVulkanMemory& memory) {
  return {memory.handle.fd, memory.size, memory.offset, memory.dedicated != VK_FALSE};
}

// What is passed is the library's to close: so it must be a descriptor, wanted or not.
void check_descriptor(int fd, bool wanted, const FieldName& field) {
  const bool is_open = fd >= 0 && ::fcntl(fd, F_GETFD) >= 0;
  if (is_open || (!wanted && fd == -1)) return;
  refuse(field.str() + ": found " + std::to_string(fd) + ", expected an open file descriptor" +
         (wanted ? "" : " or -1"));
}

// Which member of a handle is set. There is one answer so far.
void check_handle_type(uint32_t found, uint32_t expected, const char* name,
                       const FieldName& field) {
  if (found == expected) return;
  refuse(field.str() + ".handleType: found " + std::to_string(found) + ", expected " + name + " (" +
         std::to_string(expected) + ")");
}

void check_memory(const VoyVulkanMemory& memory, bool shared, const FieldName& field) {
  check_handle_type(memory.handleType, VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT,
                    "VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT", field);
  check_descriptor(memory.handle.fd, shared, field + ".handle.fd");
  if (memory.handle.fd == -1) return;
  if (memory.size == 0 || memory.offset >= memory.size)
    refuse(field.str() + ": found offset " + std::to_string(memory.offset) + " in " +
           std::to_string(memory.size) + " bytes, expected an image within the memory" +
           (shared ? "" : ", or handle.fd -1"));
}

void read_images(const VoyVulkanTargetDesc& from, bool shared, vulkan::RingDesc& into) {
  if (from.images == nullptr) return;
  std::set<VkImage> seen;
  for (uint32_t i = 0; i < from.imageCount; ++i) {
    const VoyVulkanImportedImage& image = from.images[i];
    const FieldName field("images", i);
    check_structure(&image, VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_IMAGE, field);
    const bool color = into.format != ColorFormat::none;
    check_image(color, image.color != VK_NULL_HANDLE, field + ".color");
    check_image(into.depth, image.depth != VK_NULL_HANDLE, field + ".depth");
    if (color) check_memory(image.colorMemory, shared, field + ".colorMemory");
    if (into.depth) check_memory(image.depthMemory, shared, field + ".depthMemory");
    for (const VkImage each : {image.color, image.depth})
      if (each != VK_NULL_HANDLE && !seen.insert(each).second)
        refuse(field.str() + ": found an image that was passed before, expected each image once");
    into.imported.push_back({image.color, image.depth, memory_of(image.colorMemory),
                             memory_of(image.depthMemory), image.colorUsage, image.depthUsage});
  }
}

uint32_t pairs_of(vulkan::Sync sync, uint32_t images) {
  if (sync == vulkan::Sync::host) return 0;
  return sync == vulkan::Sync::timeline ? 1 : images;
}

void read_semaphores(const VoyVulkanTargetDesc& from, const vulkan::Device& device,
                     vulkan::RingDesc& into) {
  if (from.semaphoreCount == 0) return;
  const uint32_t expected = pairs_of(device.sync(), from.imageCount);
  check_count(from.semaphoreCount, expected, expected, "semaphoreCount");
  check_pointer(from.semaphores, "semaphores");
  for (uint32_t i = 0; i < from.semaphoreCount; ++i) {
    const VoyVulkanImportedSemaphores& pair = from.semaphores[i];
    const FieldName field("semaphores", i);
    check_structure(&pair, VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_SEMAPHORES, field);
    check_semaphore(pair.released, field + ".released");
    check_semaphore(pair.rendered, field + ".rendered");
    const bool shared = device.sharing() == vulkan::Sharing::device;
    check_handle_type(pair.handleType, VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT,
                      "VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT", field);
    check_count(pair.reserved, 0, 0, field + ".reserved");
    const int released = pair.releasedHandle.fd, rendered = pair.renderedHandle.fd;
    check_descriptor(released, shared, field + ".releasedHandle.fd");
    check_descriptor(rendered, shared, field + ".renderedHandle.fd");
    if (pair.released == pair.rendered || (released == rendered && released != -1))
      refuse(field.str() +
             ": found one semaphore or handle for released and rendered, expected two");
    into.semaphores.push_back({pair.released, pair.rendered, released, rendered});
  }
}

vulkan::RingDesc ring_desc(const VoyTargetDesc& desc, const VoyVulkanTargetDesc& images,
                           const vulkan::Device& device) {
  check_no_memory(desc);
  check_count(images.imageCount, 1, VOY_MAX_VULKAN_IMAGES, "imageCount");
  check_count(images.layerCount, 1, VOY_MAX_VULKAN_LAYERS, "layerCount");
  vulkan::RingDesc out;
  out.format = format_of(desc.colorFormat);
  out.width = desc.width;
  out.height = desc.height;
  out.images = images.imageCount;
  out.layers = images.layerCount;
  out.depth = images.hasDepth != VK_FALSE;
  out.depth_limit = images.hasDepthLimit != VK_FALSE;
  if (out.format == ColorFormat::none && !out.depth)
    refuse("desc: found neither color nor depth, expected at least one");
  read_images(images, device.sharing() == vulkan::Sharing::device, out);
  read_semaphores(images, device, out);
  return out;
}

// The host's, each once: images in the same memory may come with the same one.
std::vector<int> descriptors_of(const vulkan::RingDesc& desc) {
  std::vector<int> found;
  for (const vulkan::ImportedImage& image : desc.imported) {
    if (image.color != VK_NULL_HANDLE) found.push_back(image.color_memory.fd);
    if (image.depth != VK_NULL_HANDLE) found.push_back(image.depth_memory.fd);
  }
  for (const vulkan::ImportedSemaphores& pair : desc.semaphores)
    found.insert(found.end(), {pair.released_fd, pair.rendered_fd});
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace

std::shared_ptr<TargetObject> voyager::create_vulkan_target(
    const std::shared_ptr<DeviceObject>& owner, const VoyTargetDesc& desc,
    const VoyVulkanTargetDesc* images, std::vector<int>& passed) {
  if (images == nullptr)
    refuse("desc.next: found no VoyVulkanTargetDesc, expected one with kind VULKAN");
  if (owner->vulkan == nullptr)
    throw ApiError(VOY_ERROR_UNSUPPORTED,
                   "desc.kind: found VULKAN for a device without a VoyVulkanDeviceDesc, expected "
                   "HOST_MEMORY");
  const vulkan::RingDesc wanted = ring_desc(desc, *images, *owner->vulkan);
  passed = descriptors_of(wanted);
  Image image;
  image.format = wanted.format;
  image.width = wanted.width;
  image.height = wanted.height;
  const Backend& backend = *owner->backend;
  auto object = std::make_shared<TargetObject>(owner, image);
  object->ring = std::make_shared<vulkan::Ring>(
      owner->vulkan, wanted,
      [&](ExternalRingDesc shared) { return backend.import_ring(std::move(shared)); },
      owner->memory);
  return object;
}

void voyager::close_all(const std::vector<int>& descriptors) noexcept {
  for (const int fd : descriptors)
    if (fd >= 0) ::close(fd);
}

VoyResult VOY_CALL voyGetVulkanImages(VoyTarget target, uint32_t capacity, VoyVulkanImage* images,
                                      uint32_t* count) {
  return guarded("voyGetVulkanImages", [&](Call& call) {
    const auto object = call.use<TargetObject>(target);
    check_pointer(count, "count");
    if (capacity > 0) check_pointer(images, "images");
    const vulkan::Ring& ring = vulkan_ring(*object);
    const uint32_t there = ring.desc().images, written = std::min(capacity, there);
    for (uint32_t i = 0; i < written; ++i) {
      const vulkan::RingImage image = ring.image(i);
      images[i] = {VOY_STRUCTURE_TYPE_VULKAN_IMAGE,
                   nullptr,
                   image.color,
                   image.color_view,
                   image.depth,
                   image.depth_view,
                   image.released,
                   image.rendered};
    }
    *count = there;
    return capacity > 0 && written < there ? VOY_INCOMPLETE : VOY_SUCCESS;
  });
}
