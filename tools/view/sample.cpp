#include "tools/view/sample.h"

#include <algorithm>
#include <cmath>

#include "runtime/scene/append.h"
#include "runtime/scene/export/writer.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/sanitise.h"
#include "tools/view/sparse_ply.h"

namespace voyager::view {
namespace {

constexpr size_t kBlock = 1 << 14;
// The share of a surface that n of N splats cover is kept where each is √(N/n) as wide. Beyond
// this the scene is no longer to be recognised.
constexpr double kMostGrowth = 5;

class MemorySink final : public ByteSink {
 public:
  void write(std::span<const std::byte> bytes) override {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

template <class T>
void keep(std::pmr::vector<T>& values, size_t width, size_t first, size_t step) {
  size_t to = 0;
  for (size_t from = first * width; from < values.size(); from += step * width, to += width)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(from), width,
                values.begin() + static_cast<std::ptrdiff_t>(to));
  values.resize(to);
}

// The Gaussians first, first + step and so on.
void thin(GaussianCloud& cloud, size_t first, size_t step) {
  keep(cloud.position, 3, first, step);
  keep(cloud.log_scale, 3, first, step);
  keep(cloud.rotation, 4, first, step);
  keep(cloud.opacity, 1, first, step);
  keep(cloud.sh, 3 * static_cast<size_t>(cloud.coefficients()), first, step);
}

GaussianCloud read_thinned(BlockReader& reader, uint64_t step,
                           const std::function<void()>& checkpoint) {
  GaussianCloud sample;
  sample.sh_degree = reader.sh_degree();
  sample.native = reader.native();
  sample.origin = reader.origin();
  bool first_block = true;
  for (uint64_t index = 0;;) {
    checkpoint();
    const RawBlock block = reader.next(kBlock);
    if (block.count == 0) return sample;
    const uint64_t first = (step - index % step) % step;
    index += block.count;
    if (first >= block.count) continue;
    GaussianCloud cloud = reader.decode(block);
    thin(cloud, first, step);
    if (std::exchange(first_block, false))
      sample = std::move(cloud);
    else
      append(sample, std::move(cloud), reader.name());
  }
}

}  // namespace

GaussianCloud read_sample(const std::shared_ptr<const ByteSource>& source, uint64_t wanted,
                          const std::function<void()>& checkpoint) {
  auto reader = open_blocks(source);
  const uint64_t step = std::max<uint64_t>(1, reader->count() / wanted);
  const auto sparse = step > 1 ? sparse_ply(source, step) : nullptr;
  if (sparse) reader = open_blocks(sparse);
  GaussianCloud cloud = read_thinned(*reader, sparse ? 1 : step, checkpoint);
  sanitise(cloud);
  const double growth = std::min(std::sqrt(static_cast<double>(step)), kMostGrowth);
  for (float& scale : cloud.log_scale) scale += static_cast<float>(std::log(growth));
  return cloud;
}

std::vector<Vec3d> positions(const GaussianCloud& cloud) {
  std::vector<Vec3d> out;
  out.reserve(cloud.size());
  for (size_t i = 0; i < cloud.size(); ++i)
    out.push_back({cloud.origin[0] + cloud.position[3 * i],
                   cloud.origin[1] + cloud.position[3 * i + 1],
                   cloud.origin[2] + cloud.position[3 * i + 2]});
  return out;
}

std::vector<std::byte> as_ply(const GaussianCloud& cloud) {
  MemorySink sink;
  const bool doubles = cloud.origin != std::array<double, 3>{0, 0, 0};
  const auto writer = write_ply(sink, cloud.size(), cloud.sh_degree, doubles, cloud.native);
  writer->append(cloud);
  writer->finish();
  return sink.take();
}

}  // namespace voyager::view
