#pragma once
// Frames that a pipeline leaves in flight without another API: into rings that hold no image.
#include "cuda/device/head_start.h"
#include "cuda/device/stream.h"
#include "cuda/interop/external_ring.h"
#include "tests/gpu/splat_test.h"

namespace voyager::test {

class FramesInFlight : public SplatTest {
 protected:
  static constexpr double kHeld = 300;  // milliseconds

  void SetUp() override {
    SplatTest::SetUp();
    if (!IsSkipped()) held_ = std::make_unique<cuda::Stream>();
  }

  std::unique_ptr<Pipeline> pipeline(const std::shared_ptr<const Scene>& scene,
                                     const PipelineDesc& desc = {}) {
    return cuda->create_pipeline({scene}, desc, std::pmr::get_default_resource(), workers);
  }
  std::unique_ptr<ExternalRing> make_ring(uint32_t width, uint32_t height) const {
    ExternalRingDesc desc{};
    desc.format = ColorFormat::none;
    desc.width = width, desc.height = height;
    desc.slots.resize(1);
    return cuda->import_ring(std::move(desc));
  }
  static FrameInput into(ExternalRing& ring, const Camera& camera) {
    FrameInput input = frame_input(camera, 3, false);
    Image& image = input.eyes[0].image;
    image.width = camera.width, image.height = camera.height;
    image.external.ring = &ring;
    return input;
  }
  // The device comes to frames into the ring that are submitted from now on only after that time.
  void hold_back(ExternalRing& ring, double milliseconds = kHeld) const {
    cuda::give_head_start(held_->get(), static_cast<unsigned long long>(milliseconds * 1e6));
    ExternalTarget target;
    target.ring = &ring;
    cuda::mark_end(target, held_->get());
  }

 private:
  std::unique_ptr<cuda::Stream> held_;
};

}  // namespace voyager::test
