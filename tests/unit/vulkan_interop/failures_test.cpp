// Whatever call fails while a device, a ring or a composite is made: the right error, nothing
// remains, and what the host passed is still the host's.
#include "tests/support/vulkan_rig.h"
#include "vulkan_interop/composite.h"

namespace voyager::test {
namespace failures_test {
namespace {

struct Failure {
  VkResult status;
  std::string thrown;
};
const Failure kFailures[] = {
    {VK_ERROR_OUT_OF_HOST_MEMORY, "bad_alloc"},
    {VK_ERROR_OUT_OF_DEVICE_MEMORY, error_of(ErrorCode::over_budget)},
    {VK_ERROR_TOO_MANY_OBJECTS, error_of(ErrorCode::over_budget)},
    {VK_ERROR_DEVICE_LOST, error_of(ErrorCode::device_lost)},
    {VK_ERROR_INITIALIZATION_FAILED, error_of(ErrorCode::internal)},
};

// `make` makes and destroys. The number of calls that can fail.
template <class Make>
uint32_t fail_each_call(VulkanMock& mock, const Make& make) {
  const size_t live = mock.live();
  const std::set<int> open = open_descriptors();
  const int bad = bad_closes;
  uint32_t calls = 0;
  for (const Failure& failure : kFailures) {
    for (uint32_t call = 0;; ++call) {
      mock.fail_at(call, failure.status);
      const std::string thrown = thrown_by(make);
      const bool failed = mock.failed();
      mock.fail_at(VulkanMock::kNever, VK_SUCCESS);
      EXPECT_EQ(thrown, failed ? failure.thrown : "") << "call " << call;
      EXPECT_EQ(mock.live(), live) << "call " << call << ": " << mock.live_kinds();
      EXPECT_EQ(open_descriptors(), open) << "call " << call;
      EXPECT_EQ(bad_closes, bad) << "call " << call;
      if (!failed) {
        calls = call;
        break;
      }
    }
  }
  return calls;
}

TEST(VulkanFailures, TheWatchSeesADescriptorThatIsClosedTwice) {
  const int bad = bad_closes;
  const int fd = new_descriptor();
  EXPECT_EQ(open_descriptors().count(fd), 1u);
  ::close(fd);
  EXPECT_EQ(bad_closes, bad);
  ::close(fd);
  EXPECT_EQ(bad_closes, bad + 1);
  EXPECT_EQ(open_descriptors().count(fd), 0u);
}

TEST(VulkanFailures, ADeviceWhoseCallFailsLeaksNothing) {
  VulkanMock mock;
  for (const Mode& mode : kModes) {
    SCOPED_TRACE(mode.name);
    EXPECT_GE(fail_each_call(mock, [&] { make_device(mock, mode); }), 2u);
  }
}

// A device is refused where an entry point that is a must is missing, and the error names it.
TEST(VulkanFailures, ADeviceWithoutARequiredEntryPointIsRefusedByItsName) {
  for (const auto& [name, function] : mock::table()) {
    MockDevice lacking;
    lacking.missing = name;
    VulkanMock mock(lacking);
    std::string found;
    try {
      make_device(mock, {vulkan::Sharing::automatic, vulkan::Sync::automatic, ""});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
      found = error.what();
    }
    const bool optional = name.ends_with("KHR") || name.ends_with("EXT") ||
                          name.find("Semaphores") == 6 || name == "vkSignalSemaphore" ||
                          name == "vkGetSemaphoreCounterValue";
    EXPECT_EQ(found.find(std::string("no ") + std::string(name) + ",") != std::string::npos,
              !optional)
        << name << ": " << found;
  }
}

struct Shape {
  ColorFormat format;
  bool depth, depth_limit, imported, host_pointers;
};

uint32_t fail_each_call_of_a_ring(const Mode& mode, const Shape& shape) {
  MockDevice having;
  if (!shape.host_pointers) having.remove(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);
  VulkanMock mock(having);
  Backend backend(mock);
  const auto device = make_device(mock, mode);
  vulkan::RingDesc desc = ring_desc();
  desc.format = shape.format;
  desc.depth = shape.depth;
  desc.depth_limit = shape.depth_limit;
  std::unique_ptr<Passed> passed;
  if (shape.imported) passed = std::make_unique<Passed>(mock, mode, desc);
  for (vulkan::ImportedImage& image : desc.imported) {
    if (shape.format == ColorFormat::none) image.color = VK_NULL_HANDLE;
    if (!shape.depth) image.depth = VK_NULL_HANDLE;
  }
  const uint32_t calls = fail_each_call(mock, [&] {
    {
      const vulkan::Ring ring(device, desc, backend.import(), std::pmr::new_delete_resource());
      EXPECT_EQ(backend.rings, mode.sharing == vulkan::Sharing::device ? 1 : 0);
    }
    EXPECT_EQ(backend.rings, 0);
  });
  if (passed) passed->expect_untouched();
  return calls;
}

TEST(VulkanFailures, ARingWhoseCallFailsLeaksNothing) {
  for (const Mode& mode : kModes)
    for (const bool imported : {false, true})
      for (const bool host_pointers : {false, true})
        for (const Shape& shape :
             {Shape{ColorFormat::rgba8, true, true, imported, host_pointers},
              Shape{ColorFormat::rgba32f, false, false, imported, host_pointers},
              Shape{ColorFormat::none, true, true, imported, host_pointers}}) {
          SCOPED_TRACE(std::string(mode.name) + (imported ? " imported" : "") +
                       (host_pointers ? " host pointers" : ""));
          EXPECT_GT(fail_each_call_of_a_ring(mode, shape), 6u);
        }
}

// Copies go to the backend; the numbers that the host passed stay the host's.
TEST(VulkanFailures, ImportedDescriptorsAreCopied) {
  for (const Mode& mode : kModes) {
    if (mode.sharing != vulkan::Sharing::device) continue;
    SCOPED_TRACE(mode.name);
    VulkanMock mock;
    Backend backend(mock);
    const auto device = make_device(mock, mode);
    vulkan::RingDesc desc = ring_desc();
    desc.depth_limit = false;
    const Passed passed(mock, mode, desc);
    const int bad = bad_closes;
    {
      const vulkan::Ring ring(device, desc, backend.import(), std::pmr::new_delete_resource());
      EXPECT_EQ(std::set<FileIdentity>(backend.identities.begin(), backend.identities.end()),
                std::set<FileIdentity>(passed.identities.begin(), passed.identities.end()));
      EXPECT_EQ(backend.identities.size(), passed.identities.size());
      passed.expect_untouched();
    }
    passed.expect_untouched();
    EXPECT_EQ(bad_closes, bad);
    for (const ExternalSlot& slot : backend.got.slots) {
      EXPECT_EQ(slot.color.memory.size, 4096u);
      EXPECT_EQ(slot.color.memory.offset, 256u);
      EXPECT_TRUE(slot.color.memory.dedicated);
      EXPECT_FALSE(slot.color.color_attachment);
      EXPECT_TRUE(slot.depth.color_attachment);
    }
  }
}

TEST(VulkanFailures, AnImportedDescriptorThatIsNotOpenIsRefused) {
  const Mode& mode = kModes[0];
  VulkanMock mock;
  Backend backend(mock);
  const auto device = make_device(mock, mode);
  vulkan::RingDesc desc = ring_desc();
  const Passed passed(mock, mode, desc);
  for (int* fd : {&desc.imported[0].color_memory.fd, &desc.imported[1].depth_memory.fd,
                  &desc.semaphores[0].released_fd, &desc.semaphores[0].rendered_fd}) {
    const int kept = *fd;
    const size_t live = mock.live();
    const std::set<int> open = open_descriptors();
    *fd = -1;
    EXPECT_EQ(thrown_by([&] {
                vulkan::Ring(device, desc, backend.import(), std::pmr::new_delete_resource());
              }),
              error_of(ErrorCode::invalid_argument));
    EXPECT_EQ(mock.live(), live);
    EXPECT_EQ(open_descriptors(), open);
    *fd = kept;
  }
}

// HOST sharing copies to them.
TEST(VulkanFailures, ImportedImagesThatCannotBeCopiedToAreRefused) {
  const Mode& mode = kModes[3];
  VulkanMock mock;
  Backend backend(mock);
  const auto device = make_device(mock, mode);
  vulkan::RingDesc desc = ring_desc();
  const Passed passed(mock, mode, desc);
  const size_t live = mock.live();
  desc.imported[1].depth_usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  EXPECT_EQ(thrown_by([&] {
              vulkan::Ring(device, desc, backend.import(), std::pmr::new_delete_resource());
            }),
            error_of(ErrorCode::invalid_argument));
  EXPECT_EQ(mock.live(), live);
}

// Memory of the host's allocator comes back, and its refusal is a bad_alloc.
class Counted final : public std::pmr::memory_resource {
 public:
  size_t live = 0, calls = 0;
  bool fails = false;

 private:
  void* do_allocate(size_t bytes, size_t alignment) override {
    ++calls;
    if (fails) throw std::bad_alloc();
    live += bytes;
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* data, size_t bytes, size_t alignment) override {
    live -= bytes;
    std::pmr::new_delete_resource()->deallocate(data, bytes, alignment);
  }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
};

TEST(VulkanFailures, StagingMemoryComesBackToItsAllocator) {
  VulkanMock mock;
  Backend backend(mock);
  const auto device = make_device(mock, kModes[3]);
  Counted memory;
  const auto make = [&] {
    const vulkan::Ring ring(device, ring_desc(), backend.import(), &memory);
    EXPECT_GT(memory.live, 0u);
  };
  fail_each_call(mock, make);
  EXPECT_EQ(memory.live, 0u);
  const size_t live = mock.live();
  memory.fails = true;
  EXPECT_EQ(thrown_by(make), "bad_alloc");
  EXPECT_EQ(mock.live(), live);
}

// A device that has the extension may take no memory of this host's, which it says, or take
// none of a ring's size: then it maps its own.
TEST(VulkanFailures, HostPointersThatAreNotTakenAreMappedMemory) {
  MockDevice no_type, no_pointer, no_import;
  no_type.host_pointer_types = 1;
  no_pointer.host_pointer_status = VK_ERROR_INVALID_EXTERNAL_HANDLE;
  no_import.host_import_status = VK_ERROR_INVALID_EXTERNAL_HANDLE;
  for (const MockDevice& having : {no_type, no_pointer, no_import})
    for (const bool found_late : {false, true}) {
      VulkanMock mock(found_late ? MockDevice() : having);
      Backend backend(mock);
      Counted memory;
      const auto device = make_device(mock, kModes[3]);
      EXPECT_EQ(device->imports_host_memory(), found_late);
      EXPECT_EQ(mock.live(), 0u) << mock.live_kinds();
      mock.device = having;
      {
        const vulkan::Ring ring(device, ring_desc(), backend.import(), &memory);
        EXPECT_EQ(memory.calls, found_late ? 1u : 0u);
        EXPECT_EQ(memory.live, 0u);
      }
      EXPECT_EQ(mock.live(), 0u) << mock.live_kinds();
    }
}

// The backend would write past the memory's end.
TEST(VulkanFailures, ImportedMemoryThatHasNoRoomForItsImageIsRefused) {
  const Mode& mode = kModes[0];
  VulkanMock mock;
  Backend backend(mock);
  const auto device = make_device(mock, mode);
  vulkan::RingDesc desc = ring_desc();
  const Passed passed(mock, mode, desc);
  for (const vulkan::ImportedImage& image : desc.imported)
    mock.object(image.color).bytes = mock.object(image.depth).bytes = 1024;
  const auto thrown = [&] {
    return thrown_by(
        [&] { vulkan::Ring(device, desc, backend.import(), std::pmr::new_delete_resource()); });
  };
  const size_t live = mock.live();
  for (vulkan::ImportedMemory* memory :
       {&desc.imported[0].color_memory, &desc.imported[1].depth_memory}) {
    const vulkan::ImportedMemory kept = *memory;
    struct Case {
      uint64_t size, offset;
      bool fits;
    };
    for (const Case& c : {Case{1024, 0, true}, Case{1280, 256, true}, Case{1279, 256, false},
                          Case{1023, 0, false}, Case{4096, 100, false}, Case{4096, 3328, false},
                          Case{1024, 2048, false}, Case{UINT64_MAX, UINT64_MAX - 255, false}}) {
      memory->size = c.size;
      memory->offset = c.offset;
      EXPECT_EQ(thrown(), c.fits ? "" : error_of(ErrorCode::invalid_argument))
          << c.size << " bytes, " << c.offset;
      EXPECT_EQ(mock.live(), live);
    }
    *memory = kept;
  }
}

TEST(VulkanFailures, ACompositeWhoseCallFailsLeaksNothing) {
  VulkanMock mock;
  const auto device = make_device(mock, kModes[0]);
  for (const VkFormat depth : {VK_FORMAT_UNDEFINED, VK_FORMAT_D32_SFLOAT}) {
    vulkan::CompositeDesc desc;
    desc.color = VK_FORMAT_R8G8B8A8_SRGB;
    desc.depth = depth;
    const uint32_t calls =
        fail_each_call(mock, [&] { const vulkan::Composite composite(device, desc); });
    EXPECT_EQ(calls, depth == VK_FORMAT_UNDEFINED ? 7u : 15u);
  }
}

TEST(VulkanFailures, ACompositesAttachmentsMustBeDrawableAndBlend) {
  VulkanMock mock;
  const auto device = make_device(mock, kModes[0]);
  const auto thrown = [&](VkFormat color, VkFormat depth) {
    vulkan::CompositeDesc desc;
    desc.color = color;
    desc.depth = depth;
    return thrown_by([&] { const vulkan::Composite composite(device, desc); });
  };
  const auto made_up = static_cast<VkFormat>(123456);
  for (const VkFormat color : {VK_FORMAT_R8G8B8A8_UINT, VK_FORMAT_D32_SFLOAT,
                               VK_FORMAT_BC7_UNORM_BLOCK, VK_FORMAT_UNDEFINED, made_up})
    EXPECT_EQ(thrown(color, VK_FORMAT_UNDEFINED), error_of(ErrorCode::unsupported)) << color;
  for (const VkFormat depth :
       {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_S8_UINT, VK_FORMAT_X8_D24_UNORM_PACK32, made_up})
    EXPECT_EQ(thrown(VK_FORMAT_B8G8R8A8_UNORM, depth), error_of(ErrorCode::unsupported)) << depth;
  for (const VkFormat depth : {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D24_UNORM_S8_UINT})
    EXPECT_EQ(thrown(VK_FORMAT_R16G16B16A16_SFLOAT, depth), "") << depth;
  EXPECT_EQ(mock.live(), 0u) << mock.live_kinds();
}

TEST(VulkanFailures, ACompositeWithoutARenderPassNeedsDynamicRendering) {
  VulkanMock mock;
  mock.device.remove(VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME);
  const auto device = make_device(mock, kModes[0]);
  vulkan::CompositeDesc desc;
  desc.color = VK_FORMAT_R8G8B8A8_SRGB;
  EXPECT_THROW(vulkan::Composite(device, desc), Error);
}

}  // namespace
}  // namespace failures_test
}  // namespace voyager::test
