#pragma once
// One scene twice: loaded whole, and streamed without threads, so that a test says when chunks
// are read.
#include <gtest/gtest.h>

#include "runtime/frame/open_streamed.h"
#include "tests/support/is_cut.h"
#include "tests/support/render_scene.h"
#include "tests/support/scene_files.h"

namespace voyager::test {

class StreamRig {
 public:
  // share: the pool's share of the memory that all chunks take. It always has room for the top.
  StreamRig(const BakedScene& baked, double share, const PipelineDesc& desc = {},
            uint32_t chunk_bytes = kMinChunkBytes, Quality quality = Quality::lossless)
      : StreamRig(scene_bytes(baked, quality, 0, chunk_bytes), share, desc) {}

  StreamRig(Bytes file, double share, const PipelineDesc& desc = {})
      : bytes(std::move(file)),
        backend(create_cpu_backend()),
        resident(load_scene(source_of(bytes), memory(), workers)),
        streamed(open(source_of(bytes), share)),
        whole(resident, *backend, desc, memory(), workers),
        part(streamed, *backend, desc, memory(), workers) {}

  // first_bytes: bytes to read at opening besides the top, around `start` if there is one.
  std::shared_ptr<Scene> open(const std::shared_ptr<const ByteSource>& source, double share,
                              uint64_t first_bytes = 0, std::optional<Vec3d> start = {}) {
    StreamingDesc desc;
    desc.readers = 0;
    desc.first_bytes = first_bytes;
    desc.start = start;
    desc.start_bytes = first_bytes;
    desc.clock = [this] { return time += 1e-5; };  // each look at it takes a moment
    const SceneFile file(source);
    const RoomBytes room = backend->room_bytes(*resident, SceneStream::slot_shape(file));
    const double chunks = static_cast<double>(file.chunks().size());
    const auto least =
        std::max(SceneStream::top_chunks(file), static_cast<uint32_t>(std::ceil(share * chunks)));
    desc.budget = room.of(RecordRoom(file).of(least));
    return open_streamed(source, desc, *backend, memory(), workers);
  }

  // Resizes the pool to `slots` chunks, but at least to the pinned ones.
  void give_room(Scene& scene, uint32_t slots) {
    const SceneFile& file = scene.stream->file();
    const RoomBytes room = backend->room_bytes(scene, SceneStream::slot_shape(file));
    scene.stream->set_budget(room.of(RecordRoom(file).of(slots)), workers);
  }
  void give_room(uint32_t slots) { give_room(*streamed, slots); }

  SceneStream& stream() const { return *streamed->stream; }
  // Steps, as long as there is something to do and fewer than `most`.
  size_t work(size_t most = SIZE_MAX) const {
    size_t steps = 0;
    while (steps < most && stream().step()) ++steps;
    return steps;
  }
  // Frames, with all the work between them, until nothing moves.
  Frame settle(const FrameInput& input) {
    Frame frame = render(part, input);
    uint64_t linked = 0;
    for (int i = 0; i < 100 && (work() != 0 || linked != stream().version()); ++i) {
      linked = stream().version();
      frame = render(part, input);
    }
    return frame;
  }

  static std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

  double time = 0;  // seconds
  const Bytes bytes;
  Workers workers;
  const std::unique_ptr<Backend> backend;
  const std::shared_ptr<const Scene> resident;
  const std::shared_ptr<Scene> streamed;
  View whole, part;
};

}  // namespace voyager::test
