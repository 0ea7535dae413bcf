#pragma once
// The fixture of the tests of splatting: one backend of each kind.
#include <array>
#include <span>

#include "tests/gpu/device_test.h"
#include "tests/gpu/test_share.h"
#include "tests/support/render_scene.h"

namespace voyager::test {

class SplatTest : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    if (!IsSkipped()) cuda = create_backend();
  }

  std::unique_ptr<View> view(std::shared_ptr<const Scene> scene, const PipelineDesc& desc = {}) {
    return view(*cuda, std::move(scene), desc);
  }
  std::unique_ptr<View> view(Backend& backend, std::shared_ptr<const Scene> scene,
                             const PipelineDesc& desc = {}) {
    return std::make_unique<View>(std::move(scene), backend, desc, std::pmr::get_default_resource(),
                                  workers);
  }

  // By a view that has drawn nothing before.
  Frame draw(std::shared_ptr<const Scene> scene, const PipelineDesc& desc,
             const FrameInput& input) {
    return render(*view(std::move(scene), desc), input);
  }
  Frame draw(Backend& backend, std::shared_ptr<const Scene> scene, const PipelineDesc& desc,
             const FrameInput& input) {
    return render(*view(backend, std::move(scene), desc), input);
  }

  Workers workers;
  std::unique_ptr<Backend> cuda, cpu = create_cpu_backend(), reference = create_reference_backend();
};

struct NamedDesc {
  std::string name;
  PipelineDesc desc;
};

inline std::vector<NamedDesc> all_exponentials(std::span<const uint32_t> lut_sizes) {
  std::vector<NamedDesc> all;
  all.push_back({"exact", {}});
  all.push_back({"ex2", {.exponential = Exponential::ex2}});
  all.push_back({"half2", {.exponential = Exponential::half2}});
  for (const uint32_t m : lut_sizes)
    all.push_back(
        {"lut of " + std::to_string(m), {.exponential = Exponential::lut, .lut_size = m}});
  return all;
}

// From outside and inside a cloud around the origin, with interpolated nodes and without,
// and with an eye's off-centre frustum.
inline std::vector<FrameInput> varied_frames() {
  std::vector<FrameInput> all;
  for (const double tau : {0.0, 3.0, 12.0, 40.0})
    all.push_back(frame_input(look({3, -6, -24}, {0.1, 0.2, 5}, 240, 150), tau));
  all.push_back(frame_input(look({1, 1, 1}, {5, 2, 9}, 164, 170, 110), 6));
  Camera headset = look({-12, 3, -9}, {0, 0, 0}, 161, 190);
  headset.cx = 32, headset.cy = 151;
  all.push_back(frame_input(headset, 8));
  return all;
}

}  // namespace voyager::test
