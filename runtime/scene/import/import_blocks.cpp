#include "runtime/scene/import/import_blocks.h"

#include "runtime/scene/append.h"
#include "runtime/scene/import/growth.h"

namespace voyager {
namespace {

constexpr size_t kAtOnce = 1 << 14;  // Gaussians

void make_room(GaussianCloud& cloud, uint64_t gaussians, uint64_t announced) {
  reserve_for(cloud.position, gaussians, announced, 3);
  reserve_for(cloud.log_scale, gaussians, announced, 3);
  reserve_for(cloud.rotation, gaussians, announced, 4);
  reserve_for(cloud.opacity, gaussians, announced, 1);
  reserve_for(cloud.sh, gaussians, announced, static_cast<size_t>(cloud.coefficients()) * 3);
}

}  // namespace

GaussianCloud import_blocks(BlockReader& reader, const ImportOptions& options) {
  GaussianCloud cloud(options.memory);
  cloud.sh_degree = reader.sh_degree();
  cloud.native = reader.native();
  for (uint64_t done = 0;;) {
    const RawBlock block = reader.next(kAtOnce);
    if (block.count == 0) return cloud;
    GaussianCloud more = reader.decode(block);
    if (done == 0) cloud.origin = more.origin;
    make_room(cloud, done + block.count, reader.count());
    append(cloud, std::move(more), reader.name());
    done += block.count;
    report(options.progress, "reading", done, reader.count());
  }
}

}  // namespace voyager
