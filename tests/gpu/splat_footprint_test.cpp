// METHOD §12 where footprints differ between blocks, on the device.
#include "tests/gpu/agreement.h"
#include "tests/gpu/splat_test.h"
#include "tests/support/mixed_footprints.h"

namespace voyager::test {
namespace splat_footprint_test {
namespace {

class SplatFootprint : public SplatTest {};

TEST_F(SplatFootprint, AsTheReferenceDrawsThem) {
  Agreement with_reference("mixed footprints, CUDA against the reference"),
      with_cpu("mixed footprints, CUDA against the CPU");
  for (const TreeRule& rule : kMixedRules) {
    const auto scene = loaded(bake_by_cameras(random_cloud(20000, 4, 2), close_camera(), rule));
    ASSERT_GT(scene->native.levels, 3);
    for (const Lod lod : {Lod::cut, Lod::all_leaves})
      for (const FrameInput& input : varied_frames()) {
        const Frame found = draw(scene, {.lod = lod}, input);
        with_reference.add(found, draw(*reference, scene, {.lod = lod}, input));
        with_cpu.add(found, draw(*cpu, scene, {.lod = lod}, input));
      }
  }
  with_reference.expect();
  with_cpu.expect();
}

}  // namespace
}  // namespace splat_footprint_test
}  // namespace voyager::test
