#include "tools/report/reference_images.h"

#include <fmt/core.h>

#include "runtime/base/file.h"
#include "runtime/reference/reference_backend.h"
#include "tools/lod_options.h"

namespace voyager::tools {

ReferenceImages::ReferenceImages(std::shared_ptr<const Scene> scene, std::vector<FrameInput> frames,
                                 std::filesystem::path folder, Workers& workers)
    : scene_(std::move(scene)),
      frames_(std::move(frames)),
      folder_(std::move(folder)),
      workers_(workers),
      backend_(create_reference_backend()) {}

ReferenceImages::~ReferenceImages() = default;

const RgbaImage& ReferenceImages::of(size_t frame, Detail detail) {
  if (scene_->flat() || !draws_cut(detail.lod)) detail = {};
  const Key key{frame, detail.lod, detail.tau};
  const auto found = images_.find(key);
  if (found != images_.end()) return found->second;
  std::optional<RgbaImage> kept = read(key);
  return images_.emplace(key, kept ? std::move(*kept) : draw(key)).first->second;
}

RgbaImage ReferenceImages::draw(const Key& key) {
  const auto [index, lod, tau] = key;
  PipelineDesc desc;
  desc.lod = lod;
  desc.search = Search::exhaustive;
  FrameInput frame = frames_[index];
  frame.tau = tau;
  RgbaImage image = draw_images({*backend_, scene_, workers_}, desc, {frame}, {0})[0];
  AtomicFile file(path_of(key).string());
  file.write(std::as_bytes(std::span(image)));
  file.commit();
  return image;
}

std::filesystem::path ReferenceImages::path_of(const Key& key) const {
  const auto [index, lod, tau] = key;
  return folder_ / fmt::format("reference-{}-{}-tau{:.17g}.f32", index, select_name(lod), tau);
}

std::optional<RgbaImage> ReferenceImages::read(const Key& key) const {
  const std::filesystem::path path = path_of(key);
  if (!std::filesystem::exists(path)) return std::nullopt;
  const auto source = open_file_source(path.string());
  const auto& camera = frames_[std::get<0>(key)].eyes[0].camera;
  RgbaImage image(size_t{4} * camera.width * camera.height);
  if (source->size() != image.size() * sizeof(float)) return std::nullopt;
  source->read(0, std::as_writable_bytes(std::span(image)));
  return image;
}

}  // namespace voyager::tools
