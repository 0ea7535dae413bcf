// Bytes a leaf of a scene that is streamed and resident as a whole, with what a view of it keeps:
//   leaf_bytes SCENE.voy
// A line of JSON for each backend. CUDA's layout needs no GPU.
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "cuda/search/search.h"
#include "cuda/stream/pool_layout.h"
#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/open_streamed.h"
#include "runtime/stream/scene_stream.h"

namespace {

using namespace voyager;

void print(const char* backend, const RoomBytes& bytes, PoolRoom room, double leaves) {
  const double slots = static_cast<double>(room.slots * bytes.pool.slot) / leaves,
               blocks = static_cast<double>(room.blocks * bytes.pool.block) / leaves,
               pages = static_cast<double>(room.pages * bytes.pool.page) / leaves,
               fixed = static_cast<double>(bytes.pool.fixed) / leaves,
               list = static_cast<double>(bytes.list.bytes(room)) / leaves,
               state = static_cast<double>(bytes.view.of(room)) / leaves;
  std::printf(
      "{\"backend\": \"%s\", \"slots\": %.2f, \"records\": %.2f, \"subtrees\": %.2f, "
      "\"fixed\": %.2f, \"view_list\": %.2f, \"view_state\": %.2f, \"all\": %.2f}\n",
      backend, slots, blocks, pages, fixed, list, state,
      static_cast<double>(bytes.of(room)) / leaves);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "leaf_bytes SCENE.voy\n");
    return 1;
  }
  Workers workers;
  const auto cpu = create_cpu_backend();
  StreamingDesc desc;
  desc.first_bytes = 0;
  desc.readers = 0;
  const auto scene =
      open_streamed(open_source(argv[1]), desc, *cpu, std::pmr::get_default_resource(), workers);
  if (!scene->streamed())
    throw Error(ErrorCode::unsupported,
                std::string(argv[1]) + ": found a flat scene, expected a .voy");

  const SceneFile& file = scene->stream->file();
  const SlotShape shape = SceneStream::slot_shape(file);
  const PoolRoom room = RecordRoom(file).of(static_cast<uint32_t>(file.chunks().size()));
  const auto leaves = static_cast<double>(file.info().leaf_count);
  print("cpu", cpu->room_bytes(*scene, shape), room, leaves);
  const cuda::PoolLayout layout(*scene, shape, {1, record_blocks(shape.records)});
  print("cuda", cuda::with_view(layout.pool_bytes(), *scene, shape), room, leaves);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "leaf_bytes: %s\n", error.what());
  return 1;
}
