#include "tools/report/truth_images.h"

#include "tools/report/kept_files.h"
#include "tools/report/kept_image.h"
#include "tools/supersample.h"

namespace voyager::tools {
namespace {

constexpr uint64_t kMostSamples = uint64_t{1} << 25;  // of an image: half a gigabyte

uint32_t samples_along(const voyager::Camera& camera) {
  constexpr uint32_t kMost = 8;
  return uint64_t{kMost} * kMost * camera.width * camera.height <= kMostSamples ? kMost : 4;
}

void make_finer(voyager::Camera& camera, uint32_t side) {
  camera.fx *= side;
  camera.fy *= side;
  camera.cx *= side;
  camera.cy *= side;
  camera.width *= side;
  camera.height *= side;
}

}  // namespace

RgbaImage truth_image(const FrameMaker& maker, FrameInput frame) {
  PipelineDesc desc;
  desc.lod = Lod::all_leaves;
  desc.search = Search::exhaustive;
  if (maker.scene->native.source == NativeSource::unknown)
    return draw_images(maker, desc, {frame}, {0})[0];
  desc.antialias = Antialias::truth;
  voyager::Camera& camera = frame.eyes[0].camera;
  const uint32_t width = camera.width, height = camera.height, side = samples_along(camera);
  make_finer(camera, side);
  return mean_of_samples(draw_images(maker, desc, {frame}, {0})[0], width, height, side);
}

TruthImages::TruthImages(const FrameMaker& maker, std::vector<FrameInput> path,
                         std::vector<size_t> chosen, std::filesystem::path folder,
                         size_t first_number)
    : maker_(maker),
      path_(std::move(path)),
      chosen_(std::move(chosen)),
      folder_(std::move(folder)),
      first_number_(first_number) {}

const std::vector<RgbaImage>& TruthImages::get() {
  if (!images_.empty()) return images_;
  for (const size_t i : chosen_)
    images_.push_back(kept_image(folder_ / kept_truth_name(first_number_ + i),
                                 path_[i].eyes[0].camera,
                                 [&] { return truth_image(maker_, path_[i]); }));
  return images_;
}

}  // namespace voyager::tools
