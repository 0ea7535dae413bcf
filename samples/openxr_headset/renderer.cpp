#include "renderer.h"

namespace host {
namespace {

const VoyagerLayer& sized(VoyagerLayer& voyager, const EyeImages& images) {
  voyager.resize(images.extents(), images.depth_format().has_value());
  return voyager;
}

}  // namespace

Renderer::Renderer(const Graphics& graphics, VoyagerLayer& voyager, const EyeImages& images,
                   const DepthConvention& convention, Recorder* recorder)
    : graphics_(graphics),
      voyager_(voyager),
      images_(images),
      convention_(convention),
      recorder_(recorder),
      pass_(graphics, images.colour_format().format, images.depth_format(), sized(voyager, images),
            convention),
      frames_(graphics) {
  for (size_t i = 0; i < images.view_count(); ++i) areas_.emplace_back(graphics);
  if (!recorder) return;
  for (Recorded& recorded : recorded_) recorded.readback.emplace(graphics, images);
}

void Renderer::set_visible_area(size_t view, VisibleArea area) {
  graphics_.wait_idle();
  areas_[view] = std::move(area);
}

void Renderer::draw(const std::vector<Camera>& views, uint64_t frame) {
  const uint32_t slot = frames_.wait_for_slot();
  save(recorded_[slot]);
  voyager_.begin_frame();
  submit_before(slot);
  voyager_.render(views, convention_.near_z, slot);
  submit_after(slot, views);
  if (!recorder_) return;
  recorder_->add(frame, views);
  recorded_[slot].frame = frame;
}

void Renderer::save(Recorded& recorded) {
  if (!recorded.frame) return;
  for (size_t view = 0; view < images_.view_count(); ++view)
    recorder_->write_picture(*recorded.frame, view, recorded.readback->extent(view),
                             recorded.readback->rgba(view));
  recorded.frame.reset();
}

void Renderer::finish() {
  graphics_.wait_idle();
  for (Recorded& recorded : recorded_) save(recorded);
}

void Renderer::submit_before(uint32_t slot) {
  const VkCommandBuffer commands = frames_.begin_before();
  voyager_.record_release(commands, slot);
  Submission submission(commands);
  voyager_.signal_released(submission, slot);
  frames_.submit_before(submission, voyager_.host_waits());
}

void Renderer::submit_after(uint32_t slot, const std::vector<Camera>& views) {
  const VkCommandBuffer commands = frames_.begin_after();
  voyager_.record_acquire(commands, slot);
  for (size_t view = 0; view < views.size(); ++view)
    pass_.record(commands, slot, view, images_.view(view), areas_[view], views[view].frustum);
  if (recorded_[slot].readback) recorded_[slot].readback->record(commands, images_);
  Submission submission(commands);
  voyager_.wait_for_rendered(submission, slot);
  frames_.submit_after(submission);
}

}  // namespace host
