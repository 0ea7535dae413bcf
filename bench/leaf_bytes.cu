// Bytes a leaf of a scene, all in, with what a view of it keeps:
//   leaf_bytes SCENE.voy
// A line of JSON for each backend: streamed and resident as a whole, by layout, which needs no GPU.
// Where there is one, a line for the scene resident on it, found from the device's free memory, in
// which each owner's allocation is rounded up to 2 MB; "allocated" is the sum before that.
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cuda/scene/device_parents.h"
#include "cuda/scene/device_scene.h"
#include "cuda/search/search.h"
#include "cuda/stream/pool_layout.h"
#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/load.h"
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

// What the partitioned search keeps, which finds the cuts of large scenes.
void print_resident(const char* path, Workers& workers) {
  int devices = 0;
  if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) return;
  const auto device = std::make_shared<cuda::Device>(0, 0);
  device->use();
  const std::shared_ptr<const Scene> scene =
      load_scene(open_source(path), std::pmr::get_default_resource(), workers);
  const auto leaves = static_cast<double>(scene->leaf_count);
  const auto free_bytes = [] {
    size_t free = 0, all = 0;
    cuda::check(cudaMemGetInfo(&free, &all), "memory");
    return static_cast<double>(free);
  };
  // Not the scene's, so made before it is counted: the device's tables, and what the driver
  // allocates when something is copied for the first time.
  const auto tables = device->code_tables();
  cuda::upload<uint32_t>(std::vector<uint32_t>(1 << 18));
  const double first = free_bytes();
  const size_t allocated = cuda::buffer_bytes;
  double before = first;
  const auto taken = [&] {
    const double was = std::exchange(before, free_bytes());
    return (was - before) / leaves;
  };
  const cuda::DeviceScene gaussians(*device, *scene, workers);
  const double own = taken();
  const cuda::DeviceParents parents(*scene);
  const double of_parents = taken();
  const std::shared_ptr<const cuda::DeviceTree> tree = cuda::upload_tree(*scene);
  const double of_tree = taken();
  const auto search =
      create_partitioned_search(device, tree, scene, Search::temporal, true, workers);
  const double of_view = taken();
  std::printf(
      "{\"backend\": \"cuda, resident\", \"gaussians\": %.2f, \"parents\": %.2f, \"tree\": %.2f, "
      "\"view\": %.2f, \"all\": %.2f, \"allocated\": %.2f}\n",
      own, of_parents, of_tree, of_view, (first - free_bytes()) / leaves,
      static_cast<double>(cuda::buffer_bytes - allocated) / leaves);
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
  print_resident(argv[1], workers);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "leaf_bytes: %s\n", error.what());
  return 1;
}
