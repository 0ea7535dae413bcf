#include "handles.h"

namespace test_runtime {

void Handles::destroy(uint64_t handle) {
  const auto found = objects_.find(handle);
  if (found == objects_.end()) return;
  const Object* object = found->second.get();
  // Children are younger: the youngest goes first.
  for (bool more = true; more;) {
    more = false;
    for (auto child = objects_.rbegin(); child != objects_.rend() && !more; ++child)
      if (child->second->parent == object) {
        more = true;
        destroy(child->first);
        break;
      }
  }
  objects_.erase(handle);
}

size_t Handles::children(const Object& object) const {
  size_t count = 0;
  for (const auto& item : objects_) count += item.second->parent == &object;
  return count;
}

}  // namespace test_runtime
