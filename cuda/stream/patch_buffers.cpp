#include "cuda/stream/patch_buffers.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "runtime/stream/search_chunks.h"

namespace voyager::cuda {
namespace {

constexpr size_t kLeastBytes = 1 << 16;

// Arrays one behind the other, those of the widest words first.
class Writer {
 public:
  explicit Writer(MappedMemory& memory) : memory_(memory) {}

  // count elements by make(i), as the device addresses them.
  template <class T, class Make>
  const T* put(size_t count, const Make& make) {
    unsigned char* to = memory_.host() + at_;
    for (size_t i = 0; i < count; ++i) {
      const T value = make(i);
      std::memcpy(to + i * sizeof(T), &value, sizeof(T));
    }
    const auto* at = reinterpret_cast<const T*>(memory_.device() + at_);
    at_ += count * sizeof(T);
    return at;
  }
  template <class T>
  const T* put(const std::vector<T>& values) {
    return put<T>(values.size(), [&](size_t i) { return values[i]; });
  }

 private:
  MappedMemory& memory_;
  size_t at_ = 0;
};

size_t bytes_of(const LinkPatch& p) {
  return (p.cut.records.size() + p.tied.records.size()) * sizeof(LinkPatch::Record) +
         p.linked.size() * (sizeof(SearchSubtree) + sizeof(uint32_t)) +
         p.outside.size() * sizeof(LinkPatch::Outside) + p.unlinked.size() * sizeof(uint32_t) +
         p.left.size() * sizeof(uint32_t) +
         p.arrived.size() * (sizeof(SearchChunk) + sizeof(uint32_t)) +
         p.pages.size() * sizeof(PageChange) +
         (p.large ? p.large->size() * sizeof(LargeFamily) : 0);
}

template <class T>
uint32_t count_of(const std::vector<T>& values) {
  return static_cast<uint32_t>(values.size());
}

}  // namespace

// One that the device has read is taken again, and grows where it has to.
MappedMemory& PatchBuffers::free_memory(size_t bytes) {
  const auto free = std::find_if(buffers_.begin(), buffers_.end(),
                                 [](const Buffer& buffer) { return buffer.read.passed(); });
  Buffer& buffer = free == buffers_.end() ? buffers_.emplace_back() : *free;
  if (!buffer.memory || buffer.memory->bytes() < bytes) {
    buffer.memory.reset();
    buffer.memory = std::make_unique<MappedMemory>(std::bit_ceil(std::max(bytes, kLeastBytes)));
  }
  last_ = &buffer;
  return *buffer.memory;
}

PoolPatch PatchBuffers::put(const LinkPatch& patch, const SceneFile& file) {
  Writer writer(free_memory(bytes_of(patch)));
  PoolPatch p{};
  p.cut = writer.put(patch.cut.records);
  p.tied = writer.put(patch.tied.records);
  p.linked = writer.put<SearchSubtree>(patch.linked.size(),
                                       [&](size_t i) { return patch.linked[i].second; });
  p.outside = writer.put(patch.outside);
  p.large_changed = patch.large.has_value();
  if (p.large_changed) {
    p.large = writer.put(*patch.large);
    p.large_count = count_of(*patch.large);
  }
  p.linked_subtrees =
      writer.put<uint32_t>(patch.linked.size(), [&](size_t i) { return patch.linked[i].first; });
  p.unlinked = writer.put(patch.unlinked);
  p.left = writer.put(patch.left);
  p.arrived = writer.put<SearchChunk>(
      patch.arrived.size(), [&](size_t i) { return search_chunk(file, patch.arrived[i].chunk); });
  p.arrived_slots =
      writer.put<uint32_t>(patch.arrived.size(), [&](size_t i) { return patch.arrived[i].slot; });
  p.pages = writer.put(patch.pages);
  p.cut_count = count_of(patch.cut.records);
  p.tied_count = count_of(patch.tied.records);
  p.linked_count = count_of(patch.linked);
  p.outside_count = count_of(patch.outside);
  p.unlinked_count = count_of(patch.unlinked);
  p.left_count = count_of(patch.left);
  p.arrived_count = count_of(patch.arrived);
  p.page_count = count_of(patch.pages);
  return p;
}

}  // namespace voyager::cuda
