#include "vulkan_interop/staging.h"

#include <algorithm>
#include <cstring>

namespace voyager::vulkan {
namespace {

// Planes begin on cache lines.
constexpr uint64_t kLine = 64;

uint64_t round_up(uint64_t bytes, uint64_t to) {
  return (bytes + to - 1) / to * to;
}

}  // namespace

Staging::Staging(const Device& device, const RingDesc& desc, std::pmr::memory_resource* memory)
    : layers_(desc.layers) {
  const uint64_t pixels = uint64_t{desc.width} * desc.height;
  const uint64_t plane = round_up(pixels * sizeof(float), kLine);
  color_bytes_ = round_up(pixels * pixel_bytes(desc.format), kLine);
  depth_bytes_ = desc.depth ? plane : 0;
  layer_bytes_ = color_bytes_ + depth_bytes_ + (desc.depth_limit ? plane : 0);
  const uint64_t bytes = layer_bytes_ * desc.layers * desc.images;
  if (device.imports_host_memory()) import_block(device, bytes, memory);
  if (buffer_.mapped == nullptr) buffer_ = make_mapped_buffer(device, bytes);
  // An image that is shown before its first frame is empty.
  std::memset(buffer_.mapped, 0, bytes);
}

void Staging::import_block(const Device& device, uint64_t bytes,
                           std::pmr::memory_resource* memory) {
  const uint64_t alignment = device.physical().host_pointer_alignment();
  Block block(memory, round_up(bytes, alignment), alignment);
  buffer_ = make_imported_buffer(device, block.data, block.size);
  if (buffer_.mapped != nullptr) block_ = std::move(block);
}

}  // namespace voyager::vulkan
