#include "tools/view/loaded_scene.h"

#include <cstring>

namespace voyager::view {

VoyByteSource MemoryFile::source() const {
  VoyByteSource source = VOY_BYTE_SOURCE_INIT;
  source.name = name_.c_str();
  source.size = bytes_.size();
  source.user = const_cast<std::byte*>(bytes_.data());  // which is only read
  source.read = [](void* user, uint64_t offset, uint64_t size, void* into) VOY_CALL {
    std::memcpy(into, static_cast<const std::byte*>(user) + offset, size);
    return VOY_SUCCESS;
  };
  return source;
}

}  // namespace voyager::view
