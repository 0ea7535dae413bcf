#pragma once
// Host-visible memory in which a host draws a ring's frames: for each image and layer its
// colour, its depth, and the depth that limits it.
#include <memory_resource>

#include "vulkan_interop/resources.h"
#include "vulkan_interop/ring_desc.h"

namespace voyager::vulkan {

class Staging {
 public:
  Staging(const Device& device, const RingDesc& desc, std::pmr::memory_resource* memory);

  VkBuffer buffer() const { return buffer_.buffer.get(); }
  // Where in the buffer, bytes.
  uint64_t color_at(uint32_t image, uint32_t layer) const { return at(image, layer); }
  uint64_t depth_at(uint32_t image, uint32_t layer) const {
    return at(image, layer) + color_bytes_;
  }
  uint64_t limit_at(uint32_t image, uint32_t layer) const {
    return at(image, layer) + color_bytes_ + depth_bytes_;
  }
  uint8_t* mapped() const { return static_cast<uint8_t*>(buffer_.mapped); }

 private:
  // Memory of the host's allocator.
  struct Block {
    Block() = default;
    Block(std::pmr::memory_resource* from, size_t bytes, size_t align)
        : memory(from), size(bytes), alignment(align), data(from->allocate(bytes, align)) {}
    Block(const Block&) = delete;
    Block& operator=(Block&& other) noexcept {
      std::swap(memory, other.memory), std::swap(size, other.size);
      std::swap(alignment, other.alignment), std::swap(data, other.data);
      return *this;
    }
    ~Block() {
      if (size != 0) memory->deallocate(data, size, alignment);
    }
    std::pmr::memory_resource* memory = nullptr;
    size_t size = 0, alignment = 0;
    void* data = nullptr;
  };

  uint64_t at(uint32_t image, uint32_t layer) const {
    return (uint64_t{image} * layers_ + layer) * layer_bytes_;
  }
  void import_block(const Device& device, uint64_t bytes, std::pmr::memory_resource* memory);

  uint32_t layers_;
  uint64_t color_bytes_, depth_bytes_, layer_bytes_;
  Block block_;
  BufferResource buffer_;
};

}  // namespace voyager::vulkan
