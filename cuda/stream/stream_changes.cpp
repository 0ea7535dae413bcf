#include "cuda/stream/stream_changes.h"

#include <algorithm>

namespace voyager::cuda {
namespace {

size_t count_of(const std::vector<std::shared_ptr<const StreamChange>>& changes) {
  size_t count = 0;
  for (const auto& change : changes) count += change->unlinked.size() + change->changed.size();
  return count;
}

}  // namespace

StreamChanges::StreamChanges() : memory_(kPieces * kSubtrees * sizeof(uint32_t)) {}

std::optional<Relinked> StreamChanges::follow(const SceneStream& stream, const DevicePool& pool) {
  const bool known =
      stream.changes_since(version_, changes_) && slots_.size() == pool.slot_ids().size();
  if (known)
    for (const auto& change : changes_)
      for (const LinkPatch::Arrived& arrived : change->arrived) slots_[arrived.slot] = arrived.ids;
  else
    slots_ = pool.slot_ids();
  slot_nodes_ = pool.slot_nodes();
  version_ = stream.version();
  std::optional<Relinked> relinked;
  if (known) relinked = changes_.empty() ? Relinked{} : copy();
  changes_.clear();
  return relinked;
}

std::optional<Relinked> StreamChanges::copy() {
  if (count_of(changes_) == 0) return Relinked{};
  const size_t piece = (next_ + 1) % kPieces;
  if (count_of(changes_) > kSubtrees || !read_[piece].passed()) return std::nullopt;
  next_ = piece;
  auto* const first = reinterpret_cast<uint32_t*>(memory_.host()) + piece * kSubtrees;
  uint32_t* to = first;
  for (const auto& change : changes_)
    to = std::copy(change->unlinked.begin(), change->unlinked.end(), to);
  const auto unlinked = static_cast<uint32_t>(to - first);
  for (const auto& change : changes_)
    to = std::copy(change->changed.begin(), change->changed.end(), to);
  const auto* at = reinterpret_cast<const uint32_t*>(memory_.device()) + piece * kSubtrees;
  return Relinked{at, at + unlinked, unlinked, static_cast<uint32_t>(to - first) - unlinked};
}

}  // namespace voyager::cuda
