#include "tools/report/reference_images.h"

#include "runtime/reference/reference_backend.h"
#include "tools/report/kept_files.h"
#include "tools/report/kept_image.h"

namespace voyager::tools {

ReferenceImages::ReferenceImages(std::shared_ptr<const Scene> scene, std::vector<FrameInput> path,
                                 std::vector<size_t> chosen, std::filesystem::path folder,
                                 Workers& workers)
    : scene_(std::move(scene)),
      path_(std::move(path)),
      chosen_(std::move(chosen)),
      folder_(std::move(folder)),
      workers_(workers),
      backend_(create_reference_backend()) {}

ReferenceImages::~ReferenceImages() = default;

const std::vector<RgbaImage>& ReferenceImages::of(Detail detail) {
  const bool cut = !scene_->flat() && draws_cut(detail.lod);
  if (!cut) detail = {};
  Held& held = cut ? cut_ : all_leaves_;
  if (!held.images.empty() && held.detail == detail) return held.images;
  held = {};  // first, so that there are never those of three
  for (size_t i = 0; i < chosen_.size(); ++i)
    held.images.push_back(image({chosen_[i], detail.lod, cut ? detail.taus[i] : 0}));
  held.detail = std::move(detail);
  return held.images;
}

RgbaImage ReferenceImages::image(const Key& key) {
  return kept_image(folder_ / kept_reference_name(key.frame, key.lod, key.tau),
                    path_[key.frame].eyes[0].camera, [&] { return draw(key); });
}

RgbaImage ReferenceImages::draw(const Key& key) {
  PipelineDesc desc;
  desc.lod = key.lod;
  desc.search = Search::exhaustive;
  FrameInput frame = path_[key.frame];
  frame.tau = key.tau;
  return draw_images({*backend_, scene_, workers_}, desc, {frame}, {0})[0];
}

}  // namespace voyager::tools
