#include "runtime/stream/fit_room.h"

#include <algorithm>

#include "runtime/base/error.h"
#include "runtime/base/megabytes.h"
#include "runtime/format/check_claims.h"
#include "runtime/stream/scene_stream.h"

namespace voyager {
namespace {

// All slots have room for the largest chunk. A file whose other chunks are far smaller would ask
// for memory of which next to nothing is ever used: no bake makes one that takes more than this.
uint64_t most_bytes(const SceneFile& file) {
  constexpr uint64_t kAnyScene = 16 << 20;
  return kAnyScene + 2 * claimed_bytes(file);
}

}  // namespace

PoolRoom fit_room(const SceneFile& file, const RecordRoom& records, const RoomBytes& bytes,
                  uint64_t budget, size_t views) {
  const uint64_t most = most_bytes(file);
  const auto fits = [&](uint32_t slots) {
    const PoolRoom room = records.of(slots);
    return bytes.pool.of(room) <= most && (budget == 0 || bytes.of(room, views) <= budget);
  };
  uint32_t slots = SceneStream::top_chunks(file);
  if (!fits(slots)) {
    const uint64_t allowed = budget == 0 ? most : std::min(budget, most);
    throw Error(ErrorCode::over_budget,
                file.name() + ": the top of the tree takes " +
                    megabytes_text(bytes.of(records.of(slots), views)) + " with what " +
                    std::to_string(std::max<size_t>(views, 1)) +
                    " of its instances keep, the memory budget allows " + megabytes_text(allowed));
  }
  auto last = static_cast<uint32_t>(file.chunks().size());
  while (slots < last) {
    const uint32_t middle = last - (last - slots) / 2;
    if (fits(middle))
      slots = middle;
    else
      last = middle - 1;
  }
  return records.of(slots);
}

}  // namespace voyager
