// Memory that is refused at any moment, to a frame or to what reads chunks: it costs that frame, or
// what had been read, and nothing else.
#include <cstdlib>
#include <new>

#include "runtime/frame/whole_tree.h"
#include "tests/support/stream_rig.h"

namespace {

// Allocations of this thread until one is refused; 0: none is.
thread_local long refused_after = 0;

void* allocate(size_t size) {
  if (refused_after > 0 && --refused_after == 0) return nullptr;
  return std::malloc(size == 0 ? 1 : size);
}

}  // namespace

// Not inlined: a compiler would find memory that one function took and another freed.
[[gnu::noinline]] void* operator new(size_t size) {
  if (void* memory = allocate(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(size_t size, const std::nothrow_t&) noexcept {
  return allocate(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}

namespace voyager::streaming_memory_test {
namespace {

TEST(StreamingMemory, RefusedAtAnyMomentIsOvercome) {
  GaussianCloud cloud = test::random_cloud(1500, 3, 1);
  for (float& x : cloud.position) x *= 20;
  test::StreamRig rig(test::bake(cloud), 1.0);
  FrameInput input = test::frame_input(test::look({0, -3, -60}, {0, -3, 0}, 24, 18, 70), 2);
  FrameInput other = test::frame_input(test::look({0, -3, 60}, {0, -3, 200}, 24, 18, 70), 2);
  const test::Frame whole = test::render(rig.whole, input);
  size_t refused = 0;
  bool reached = true;
  for (long at = 1; reached; at += at < 100 ? 1 : 13) {
    test::render(rig.part, other);
    rig.work();
    refused_after = at;
    for (int frame = 0; frame < 4; ++frame) {
      try {
        rig.work(20);
        test::render(rig.part, input);
      } catch (const std::bad_alloc&) {
        ++refused;
      }
    }
    reached = refused_after == 0;
    refused_after = 0;
    const test::Frame next = test::render(rig.part, input);
    ASSERT_TRUE(test::is_cut(*whole_tree(*rig.resident), next.cut)) << at;
    rig.time += 20;
    input.wait_resident = true;
    const test::Frame waited = test::render(rig.part, input);
    input.wait_resident = false;
    test::expect_same_bits(waited, whole);
    ASSERT_FALSE(HasFailure()) << at;
  }
  EXPECT_GE(refused, 10u);
}

// Of a scene that has seen little until then, whose lists still grow.
TEST(StreamingMemory, RefusedWhileAPlanIsMadeIsOvercomeForAllViewers) {
  GaussianCloud cloud = test::random_cloud(1500, 3, 1);
  for (float& x : cloud.position) x *= 20;
  test::StreamRig rig(test::bake(cloud), 1.0);
  const auto from = [](Vec3d eye, Vec3d at) {
    return test::frame_input(test::look(eye, at, 24, 18, 70), 2);
  };
  const FrameInput far = from({0, -3, -3000}, {0, -3, 0});
  const FrameInput inputs[] = {from({0, -3, -60}, {0, -3, 0}), from({0, -3, 60}, {0, -3, 200})};
  long at = 1;
  for (bool reached = true; reached; ++at) {
    const auto scene = rig.open(test::source_of(rig.bytes), 1.0);
    View view(scene, *rig.backend, {}, rig.memory(), rig.workers);
    test::render(view, far);
    while (scene->stream->step()) continue;
    test::render(view, inputs[0]);
    refused_after = at;
    scene->stream->step();
    reached = refused_after == 0;
    refused_after = 0;
    rig.time += 20;
    for (FrameInput input : inputs) {
      const test::Frame whole = test::render(rig.whole, input);
      input.wait_resident = true;
      test::expect_same_bits(test::render(view, input), whole);
    }
    ASSERT_FALSE(HasFailure()) << at;
  }
  EXPECT_GT(at, 20);
}

}  // namespace
}  // namespace voyager::streaming_memory_test
