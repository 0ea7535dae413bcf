#include "plugin/streaming.h"

#include <algorithm>
#include <thread>

#include "plugin/call.h"
#include "plugin/structs.h"
#include "runtime/frame/open_streamed.h"

namespace voyager {
namespace {

constexpr uint32_t kMostReaders = 64;

// Three quarters of the machine's threads: they work while much comes, and sleep otherwise. At
// least as many as are worth having: those wait for answers most of the time. bench/NOTES.md has
// what four, eight and twelve do.
uint32_t default_readers(const ByteSource& source) {
  const uint32_t of_machine = std::clamp(3 * std::thread::hardware_concurrency() / 4, 4u, 12u);
  return std::clamp(source.reads_at_once(), of_machine, kMostReaders);
}

// Of a budget of its own, and of what the device has left for it; 0: no limit.
uint64_t allowed(uint64_t wanted, uint64_t left) {
  const uint64_t least = std::min(wanted == 0 ? UINT64_MAX : wanted, left);
  return least == UINT64_MAX ? 0 : std::max<uint64_t>(least, 1);
}

bool is_on_device(const SceneObject& object) {
  return object.device().backend_kind == VOY_BACKEND_CUDA;
}

}  // namespace

void check_streaming(const VoySceneStreaming& streaming) {
  check_count(streaming.readerThreadCount, 0, kMostReaders, "desc.next.readerThreadCount");
  check_count(streaming.reserved, 0, 0, "desc.next.reserved");
  for (int axis = 0; streaming.startPosition != nullptr && axis < 3; ++axis)
    check_coordinate(streaming.startPosition[axis], "desc.next.startPosition");
}

Budget& SceneObject::pool_budget() const {
  return is_on_device(*this) ? device().device_budget : device().budget;
}

void SceneObject::count(uint64_t bytes) {
  if (!is_on_device(*this)) return memory.reserve(bytes);
  if (bytes > device_bytes_) device().device_budget.take(bytes - device_bytes_);
  if (bytes < device_bytes_) device().device_budget.give_back(device_bytes_ - bytes);
  device_bytes_ = bytes;
}

void open_streamed(SceneObject& object, const std::shared_ptr<const ByteSource>& source,
                   const VoySceneStreaming& streaming) {
  StreamingDesc desc;
  desc.budget = allowed(streaming.memoryBudget, object.pool_budget().left());
  if (streaming.startPosition != nullptr)
    desc.start = {streaming.startPosition[0], streaming.startPosition[1],
                  streaming.startPosition[2]};
  desc.readers =
      streaming.readerThreadCount == 0 ? default_readers(*source) : streaming.readerThreadCount;
  desc.count = [&object](uint64_t bytes) { object.count(bytes); };
  object.scene = open_streamed(source, desc, *object.device().backend, &object.memory,
                               object.device().workers);
}

void log_streaming(const DeviceObject& device, const Scene& scene) {
  if (!scene.streamed()) return;
  for (const std::string& line : scene.stream->take_messages())
    device.log.write(VOY_LOG_LEVEL_WARNING, ("streaming: " + line).c_str());
}

}  // namespace voyager

using namespace voyager;

namespace {

void check_streamed(const SceneObject& object) {
  if (!object.scene->streamed())
    throw ApiError(VOY_ERROR_UNSUPPORTED,
                   "scene: found a scene that is loaded whole, expected a streamed scene");
}

}  // namespace

VoyResult VOY_CALL voySetSceneMemoryBudget(VoyScene scene, uint64_t bytes) {
  return guarded("voySetSceneMemoryBudget", [&](Call& call) {
    const auto object = call.use<SceneObject>(scene);
    check_streamed(*object);
    const std::lock_guard resizing(object->device().resizing);
    SceneStream& stream = *object->scene->stream;
    const uint64_t own = stream.bytes(), left = object->pool_budget().left();
    stream.set_budget(allowed(bytes, left > UINT64_MAX - own ? UINT64_MAX : left + own),
                      object->device().workers);
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyGetStreamingStats(VoyScene scene, VoyStreamingStats* stats) {
  return guarded("voyGetStreamingStats", [&](Call& call) {
    const auto object = call.use<SceneObject>(scene);
    check_structure(stats, VOY_STRUCTURE_TYPE_STREAMING_STATS, "VoyStreamingStats");
    check_streamed(*object);
    const StreamCounters found = object->scene->stream->counters();
    VoyStreamingStats out = VOY_STREAMING_STATS_INIT;
    out.next = stats->next;
    out.budgetBytes = object->scene->stream->bytes();
    out.chunkSlots = found.slots;
    out.residentChunks = found.resident;
    out.neededChunks = found.need.chunks;
    out.missingChunks = found.need.missing;
    out.missingBytes = found.need.missing_bytes;
    out.seenChunks = found.need.seen;
    out.seenMissingChunks = found.need.seen_missing;
    out.requestedChunks = found.chunks.requested;
    out.arrivedChunks = found.chunks.arrived;
    out.lateChunks = found.chunks.late;
    out.evictedChunks = found.chunks.evicted;
    out.flushedChunks = found.chunks.flushed;
    out.reads = found.reads;
    out.bytesRead = found.bytes_read;
    out.failures = found.failures;
    *stats = out;
    return VOY_SUCCESS;
  });
}
