// What a ring and a composite record: an image is handed over in the layout and to the queue
// family in which the other side takes it, and copies have their barriers.
#include <algorithm>
#include <random>

#include "tests/support/vulkan_rig.h"
#include "vulkan_interop/composite.h"

namespace voyager::test {
namespace record_test {
namespace {

constexpr uint32_t kFamily = 3;
constexpr VkImageLayout kUsed[] = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL};
const Mode& kShared = kModes[0];
const Mode& kStaged = kModes[3];

struct Rig {
  explicit Rig(const Mode& mode, const vulkan::RingDesc& desc = ring_desc())
      : device(make_device(mock, mode)),
        ring(device, desc, backend.import(), std::pmr::new_delete_resource()) {}

  vulkan::Use use(VkImageLayout layout) const {
    return {VulkanMock::commands_at(0), kFamily, layout, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT};
  }

  VulkanMock mock;
  Backend backend{mock};
  std::shared_ptr<const vulkan::Device> device;
  vulkan::Ring ring;
};

void expect_whole(const VkImageMemoryBarrier& barrier, uint32_t layers) {
  EXPECT_EQ(barrier.subresourceRange.aspectMask, VK_IMAGE_ASPECT_COLOR_BIT);
  EXPECT_EQ(barrier.subresourceRange.baseMipLevel, 0u);
  EXPECT_EQ(barrier.subresourceRange.levelCount, 1u);
  EXPECT_EQ(barrier.subresourceRange.baseArrayLayer, 0u);
  EXPECT_EQ(barrier.subresourceRange.layerCount, layers);
}

// Where an image is, and whose, as the commands so far leave it.
struct State {
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  uint32_t family = kFamily;
};
using States = std::map<VkImage, State>;

void apply(const Command& command, States& states, uint32_t layers) {
  for (const VkImageMemoryBarrier& barrier : command.images) {
    expect_whole(barrier, layers);
    ASSERT_EQ(states.count(barrier.image), 1u);
    State& state = states[barrier.image];
    EXPECT_TRUE(barrier.oldLayout == VK_IMAGE_LAYOUT_UNDEFINED ||
                barrier.oldLayout == state.layout);
    state.layout = barrier.newLayout;
    if (barrier.srcQueueFamilyIndex == barrier.dstQueueFamilyIndex) continue;
    EXPECT_EQ(barrier.srcQueueFamilyIndex, state.family);
    state.family = barrier.dstQueueFamilyIndex;
  }
}

TEST(VulkanRecord, SharedImagesGoBackAndForthBetweenTheHostsFamilyAndOutside) {
  Rig rig(kShared);
  States states;
  for (uint32_t i = 0; i < 2; ++i)
    states[rig.ring.image(i).color] = states[rig.ring.image(i).depth] = {};
  std::mt19937 random(3);
  VkImageLayout last[2] = {VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL};
  for (int frame = 0; frame < 50; ++frame) {
    const uint32_t i = random() % 2;
    const bool first = states[rig.ring.image(i).color].layout == VK_IMAGE_LAYOUT_UNDEFINED;
    rig.mock.commands.clear();
    rig.ring.record_release(i, rig.use(last[i]));
    ASSERT_EQ(rig.mock.commands.size(), 1u);
    const Command release = rig.mock.commands[0];
    ASSERT_EQ(release.images.size(), 2u);
    EXPECT_EQ(release.from_stages, VkPipelineStageFlags{VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT});
    for (const VkImageMemoryBarrier& barrier : release.images)
      EXPECT_EQ(barrier.oldLayout == VK_IMAGE_LAYOUT_UNDEFINED, first);
    apply(release, states, 2);
    for (const VkImage image : {rig.ring.image(i).color, rig.ring.image(i).depth}) {
      EXPECT_EQ(states[image].layout, VK_IMAGE_LAYOUT_GENERAL);  // as the backend writes it
      EXPECT_EQ(states[image].family, VK_QUEUE_FAMILY_EXTERNAL);
    }

    last[i] = kUsed[random() % 3];
    rig.mock.commands.clear();
    rig.ring.record_acquire(i, rig.use(last[i]));
    ASSERT_EQ(rig.mock.commands.size(), 1u);
    const Command& acquire = rig.mock.commands[0];
    ASSERT_EQ(acquire.images.size(), 2u);
    for (const VkImageMemoryBarrier& barrier : acquire.images) {
      EXPECT_EQ(barrier.oldLayout, VK_IMAGE_LAYOUT_GENERAL);  // what was drawn stays
      EXPECT_EQ(barrier.dstAccessMask, VkAccessFlags{VK_ACCESS_SHADER_READ_BIT});
    }
    EXPECT_NE(acquire.to_stages & VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0u);
    apply(acquire, states, 2);
    for (const VkImage image : {rig.ring.image(i).color, rig.ring.image(i).depth}) {
      EXPECT_EQ(states[image].layout, last[i]);
      EXPECT_EQ(states[image].family, kFamily);
    }
  }
}

TEST(VulkanRecord, ARingWithoutColourHandsOverItsDepthAlone) {
  vulkan::RingDesc desc = ring_desc();
  desc.format = ColorFormat::none;
  for (const Mode* mode : {&kShared, &kStaged}) {
    Rig rig(*mode, desc);
    rig.ring.record_release(0, rig.use(VK_IMAGE_LAYOUT_GENERAL));
    rig.ring.record_acquire(0, rig.use(VK_IMAGE_LAYOUT_GENERAL));
    for (const Command& command : rig.mock.commands) {
      for (const VkImageMemoryBarrier& barrier : command.images)
        EXPECT_EQ(barrier.image, rig.ring.image(0).depth);
      EXPECT_TRUE(command.kind != Command::buffer_to_image ||
                  command.to == rig.ring.image(0).depth);
    }
  }
}

// The offsets of copies are where begin_frame has the frame drawn.
TEST(VulkanRecord, StagedImagesAreCopiedFromWhereTheirFramesAreDrawn) {
  for (const ColorFormat format :
       {ColorFormat::rgba8, ColorFormat::rgba16f, ColorFormat::rgba32f}) {
    vulkan::RingDesc desc = ring_desc();
    desc.format = format;
    Rig rig(kStaged, desc);
    for (uint32_t i = 0; i < desc.images; ++i)
      rig.ring.record_release(i, rig.use(VK_IMAGE_LAYOUT_GENERAL));
    EXPECT_TRUE(rig.mock.commands.empty());  // the next copy writes all of it
    const auto* base = static_cast<const uint8_t*>(rig.ring.begin_frame(0, 0, {0, 1}).color);
    for (uint32_t i = 0; i < desc.images; ++i) {
      rig.mock.commands.clear();
      std::vector<Image> frames;
      for (uint32_t layer = 0; layer < desc.layers; ++layer)
        frames.push_back(rig.ring.begin_frame(i, layer, {0, 1}));
      rig.ring.record_acquire(i, rig.use(VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
      const std::vector<Command>& commands = rig.mock.commands;
      ASSERT_EQ(commands.size(), 7u);
      const auto expect_copy = [&](VkImage image, uint32_t layer, const void* drawn, size_t texel) {
        const auto at = static_cast<uint64_t>(static_cast<const uint8_t*>(drawn) - base);
        const auto found = std::find_if(commands.begin(), commands.end(), [&](const Command& c) {
          return c.kind == Command::buffer_to_image && c.to == image &&
                 c.region.imageSubresource.baseArrayLayer == layer;
        });
        ASSERT_NE(found, commands.end());
        EXPECT_EQ(found->region.bufferOffset, at);
        EXPECT_EQ(found->region.bufferOffset % texel, 0u);
        EXPECT_EQ(found->region.bufferRowLength, 0u);
        EXPECT_EQ(found->region.imageSubresource.layerCount, 1u);
        EXPECT_EQ(found->region.imageExtent.width, desc.width);
        EXPECT_EQ(found->region.imageExtent.height, desc.height);
        EXPECT_EQ(found->to_layout, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
      };
      for (uint32_t layer = 0; layer < desc.layers; ++layer) {
        const Image& drawn = frames[layer];
        EXPECT_EQ(drawn.color_pitch, desc.width * pixel_bytes(format));
        EXPECT_EQ(drawn.depth_pitch, desc.width * sizeof(float));
        expect_copy(rig.ring.image(i).color, layer, drawn.color, pixel_bytes(format));
        expect_copy(rig.ring.image(i).depth, layer, drawn.depth, sizeof(float));
      }
    }
  }
}

TEST(VulkanRecord, StagedCopiesStandBetweenTheirBarriers) {
  Rig rig(kStaged);
  States states;
  for (uint32_t i = 0; i < 2; ++i)
    states[rig.ring.image(i).color] = states[rig.ring.image(i).depth] = {};
  VkImageLayout last = VK_IMAGE_LAYOUT_GENERAL;
  for (const VkImageLayout layout : kUsed) {
    rig.mock.commands.clear();
    vulkan::Use use = rig.use(last);
    rig.ring.record_release(0, use);
    last = use.layout = layout;
    use.stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    rig.ring.record_acquire(0, use);
    const std::vector<Command>& commands = rig.mock.commands;
    ASSERT_EQ(commands.size(), 7u);

    const Command& drawn = commands[0];
    EXPECT_EQ(drawn.from_stages, VkPipelineStageFlags{VK_PIPELINE_STAGE_HOST_BIT});
    EXPECT_EQ(drawn.to_stages, VkPipelineStageFlags{VK_PIPELINE_STAGE_TRANSFER_BIT});
    ASSERT_EQ(drawn.buffers.size(), 1u);
    EXPECT_EQ(drawn.buffers[0].srcAccessMask, VkAccessFlags{VK_ACCESS_HOST_WRITE_BIT});
    EXPECT_EQ(drawn.buffers[0].dstAccessMask, VkAccessFlags{VK_ACCESS_TRANSFER_READ_BIT});
    EXPECT_EQ(drawn.buffers[0].buffer, commands[2].buffer);
    EXPECT_EQ(drawn.buffers[0].size, VK_WHOLE_SIZE);

    // After the host's last use, which may have been in other stages.
    const Command& before = commands[1];
    EXPECT_NE(before.from_stages & VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0u);
    EXPECT_NE(before.to_stages & VK_PIPELINE_STAGE_TRANSFER_BIT, 0u);
    for (const VkImageMemoryBarrier& barrier : before.images) {
      EXPECT_EQ(barrier.newLayout, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
      EXPECT_EQ(barrier.dstAccessMask, VkAccessFlags{VK_ACCESS_TRANSFER_WRITE_BIT});
    }
    for (size_t i = 2; i < 6; ++i) EXPECT_EQ(commands[i].kind, Command::buffer_to_image);
    const Command& after = commands[6];
    EXPECT_EQ(after.from_stages, VkPipelineStageFlags{VK_PIPELINE_STAGE_TRANSFER_BIT});
    EXPECT_EQ(after.to_stages, VkPipelineStageFlags{VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT});
    for (const VkImageMemoryBarrier& barrier : after.images) {
      EXPECT_EQ(barrier.oldLayout, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
      EXPECT_EQ(barrier.newLayout, layout);
      EXPECT_EQ(barrier.srcAccessMask, VkAccessFlags{VK_ACCESS_TRANSFER_WRITE_BIT});
    }
    for (const Command& command : commands) {
      apply(command, states, 2);
      EXPECT_EQ(command.commands, use.commands);
      for (const VkImageMemoryBarrier& barrier : command.images)
        EXPECT_EQ(barrier.srcQueueFamilyIndex, barrier.dstQueueFamilyIndex);
    }
    ASSERT_EQ(before.images.size(), 2u);
    ASSERT_EQ(after.images.size(), 2u);
  }
}

vulkan::LimitFrom limit_from(VulkanMock& mock, VkFormat format) {
  vulkan::LimitFrom from;
  from.commands = VulkanMock::commands_at(1);
  from.queue_family = kFamily;
  from.depth = mock.host_image(5);
  from.format = format;
  from.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  from.layer = 4;
  from.offset = {2, 1};
  return from;
}

// With staging memory a driver would see nothing of it: a host that CI runs with HOST sharing
// is told all the same.
TEST(VulkanRecord, AnImageIsTakenOnlyByTurns) {
  for (const Mode* mode : {&kShared, &kStaged}) {
    Rig rig(*mode);
    const auto expect_refused = [&](const auto& call) {
      const size_t recorded = rig.mock.commands.size();
      EXPECT_EQ(thrown_by(call), error_of(ErrorCode::invalid_argument)) << mode->name;
      EXPECT_EQ(rig.mock.commands.size(), recorded);
    };
    const auto frame = [&] { rig.ring.begin_frame(0, 0, {0, 1}); };
    const auto acquire = [&] {
      rig.ring.record_acquire(0, rig.use(VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL));
    };
    const auto release = [&](VkImageLayout layout) { rig.ring.record_release(0, rig.use(layout)); };
    rig.ring.record_release(1, rig.use(VK_IMAGE_LAYOUT_GENERAL));  // another image
    expect_refused(frame);
    expect_refused(acquire);
    release(VK_IMAGE_LAYOUT_GENERAL);
    for (int turn = 0; turn < 2; ++turn) {
      frame();
      acquire();
      expect_refused(frame);
      expect_refused(acquire);
      expect_refused([&] { release(VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL); });
      release(VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
      release(VK_IMAGE_LAYOUT_GENERAL);  // not taken since: whatever is said of it
    }
  }
}

TEST(VulkanRecord, QueueFamiliesAreTheDevices) {
  for (const Mode* mode : {&kShared, &kStaged}) {
    Rig rig(*mode);
    rig.ring.record_release(1, rig.use(VK_IMAGE_LAYOUT_GENERAL));
    rig.mock.commands.clear();
    for (const uint32_t family :
         {rig.mock.device.queue_families, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_EXTERNAL}) {
      vulkan::Use use = rig.use(VK_IMAGE_LAYOUT_GENERAL);
      use.queue_family = family;
      vulkan::LimitFrom limit = limit_from(rig.mock, VK_FORMAT_D32_SFLOAT);
      limit.queue_family = family;
      const std::string refused = error_of(ErrorCode::invalid_argument);
      EXPECT_EQ(thrown_by([&] { rig.ring.record_release(0, use); }), refused);
      EXPECT_EQ(thrown_by([&] { rig.ring.record_acquire(1, use); }), refused);
      EXPECT_EQ(thrown_by([&] { rig.ring.record_depth_limit(0, 0, limit); }), refused);
    }
    EXPECT_TRUE(rig.mock.commands.empty());
  }
}

// An access that a barrier's stages cannot make is invalid.
TEST(VulkanRecord, AnAcquiresReadsAreThoseOfItsStages) {
  struct Case {
    VkPipelineStageFlags stages;
    VkAccessFlags reads;
  };
  constexpr VkPipelineStageFlags kDraws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  for (const Mode* mode : {&kShared, &kStaged}) {
    Rig rig(*mode);
    vulkan::Use use = rig.use(VK_IMAGE_LAYOUT_GENERAL);
    for (const Case& c :
         {Case{VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT},
          Case{VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | kDraws, VK_ACCESS_SHADER_READ_BIT},
          Case{VK_PIPELINE_STAGE_TRANSFER_BIT | kDraws, VK_ACCESS_TRANSFER_READ_BIT},
          Case{VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT,
               VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_SHADER_READ_BIT},
          Case{VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT, VK_ACCESS_SHADER_READ_BIT},
          Case{VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT}}) {
      rig.ring.record_release(0, use);
      use.stages = c.stages;
      rig.ring.record_acquire(0, use);
      const Command& last = rig.mock.commands.back();
      EXPECT_EQ(last.to_stages, c.stages);
      for (const VkImageMemoryBarrier& barrier : last.images)
        EXPECT_EQ(barrier.dstAccessMask, c.reads) << c.stages;
    }
    rig.ring.record_release(0, use);
    rig.mock.commands.clear();
    for (const VkPipelineStageFlagBits stage :
         {VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_PIPELINE_STAGE_VERTEX_INPUT_BIT,
          VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
          VK_PIPELINE_STAGE_HOST_BIT}) {
      use.stages = stage;
      EXPECT_EQ(thrown_by([&] { rig.ring.record_acquire(0, use); }),
                error_of(ErrorCode::invalid_argument))
          << stage;
    }
    EXPECT_TRUE(rig.mock.commands.empty());
  }
}

TEST(VulkanRecord, TheHostsDepthGoesToWhereTheLimitsAreRead) {
  Rig rig(kStaged);
  rig.ring.record_release(0, rig.use(VK_IMAGE_LAYOUT_GENERAL));
  const auto* base = static_cast<const uint8_t*>(rig.ring.begin_frame(0, 0, {0, 1}).color);
  DepthLimits limits;
  rig.ring.set_limits(1, 1, limits);
  rig.ring.record_depth_limit(1, 1, limit_from(rig.mock, VK_FORMAT_D32_SFLOAT_S8_UINT));
  ASSERT_EQ(rig.mock.commands.size(), 2u);
  const Command& copy = rig.mock.commands[0];
  EXPECT_EQ(copy.kind, Command::image_to_buffer);
  EXPECT_EQ(copy.region.bufferOffset,
            static_cast<uint64_t>(reinterpret_cast<const uint8_t*>(limits.values) - base));
  EXPECT_EQ(limits.pitch, 7 * sizeof(float));
  EXPECT_EQ(copy.region.imageSubresource.aspectMask, VK_IMAGE_ASPECT_DEPTH_BIT);
  EXPECT_EQ(copy.region.imageSubresource.baseArrayLayer, 4u);
  EXPECT_EQ(copy.region.imageOffset.x, 2);
  EXPECT_EQ(copy.region.imageOffset.y, 1);
  const Command& written = rig.mock.commands[1];
  EXPECT_EQ(written.from_stages, VkPipelineStageFlags{VK_PIPELINE_STAGE_TRANSFER_BIT});
  EXPECT_EQ(written.to_stages, VkPipelineStageFlags{VK_PIPELINE_STAGE_HOST_BIT});
  ASSERT_EQ(written.buffers.size(), 1u);
  EXPECT_EQ(written.buffers[0].dstAccessMask, VkAccessFlags{VK_ACCESS_HOST_READ_BIT});
  EXPECT_EQ(written.buffers[0].offset, copy.region.bufferOffset);
  EXPECT_EQ(written.buffers[0].size, 7 * 5 * sizeof(float));
}

TEST(VulkanRecord, ASharedDepthLimitIsReleasedToTheOutside) {
  Rig rig(kShared);
  for (uint32_t layer = 0; layer < 2; ++layer) {
    rig.mock.commands.clear();
    rig.ring.record_depth_limit(0, layer, limit_from(rig.mock, VK_FORMAT_R32_SFLOAT));
    ASSERT_EQ(rig.mock.commands.size(), 2u);
    const Command& copy = rig.mock.commands[0];
    EXPECT_EQ(copy.region.imageSubresource.aspectMask, VK_IMAGE_ASPECT_COLOR_BIT);
    EXPECT_EQ(copy.region.bufferOffset, layer * 7 * 5 * sizeof(float));
    const Command& written = rig.mock.commands[1];
    ASSERT_EQ(written.buffers.size(), 1u);
    EXPECT_EQ(written.buffers[0].buffer, copy.buffer);
    EXPECT_EQ(written.buffers[0].srcAccessMask, VkAccessFlags{VK_ACCESS_TRANSFER_WRITE_BIT});
    EXPECT_EQ(written.buffers[0].srcQueueFamilyIndex, kFamily);
    EXPECT_EQ(written.buffers[0].dstQueueFamilyIndex, VK_QUEUE_FAMILY_EXTERNAL);
  }
}

vulkan::CopyTo copy_to(VulkanMock& mock, VkFormat format) {
  vulkan::CopyTo to;
  to.commands = VulkanMock::commands_at(2);
  to.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  to.image = mock.host_image(3);
  to.format = format;
  to.image_layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  to.layer = 2;
  to.offset = {11, 13};
  return to;
}

TEST(VulkanRecord, CopiesKeepTheirPlaceAndSize) {
  Rig rig(kShared);
  for (const VkFormat format :
       {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_UNORM}) {
    rig.mock.commands.clear();
    const vulkan::CopyTo to = copy_to(rig.mock, format);
    rig.ring.record_copy(1, 1, to);
    ASSERT_EQ(rig.mock.commands.size(), 1u);
    const Command& copy = rig.mock.commands[0];
    EXPECT_EQ(copy.from, rig.ring.image(1).color);
    EXPECT_EQ(copy.to, to.image);
    EXPECT_EQ(copy.from_layout, to.layout);
    EXPECT_EQ(copy.to_layout, to.image_layout);
    if (format == VK_FORMAT_B8G8R8A8_UNORM) {
      EXPECT_EQ(copy.kind, Command::blit_image);
      const VkImageBlit& blit = copy.blit_region;
      EXPECT_EQ(blit.srcSubresource.baseArrayLayer, 1u);
      EXPECT_EQ(blit.dstSubresource.baseArrayLayer, 2u);
      EXPECT_EQ(blit.srcOffsets[1].x, 7);
      EXPECT_EQ(blit.srcOffsets[1].y, 5);
      EXPECT_EQ(blit.dstOffsets[0].x, 11);
      EXPECT_EQ(blit.dstOffsets[1].x, 18);
      EXPECT_EQ(blit.dstOffsets[1].y, 18);
      continue;
    }
    EXPECT_EQ(copy.kind, Command::copy_image);
    EXPECT_EQ(copy.image_region.srcSubresource.baseArrayLayer, 1u);
    EXPECT_EQ(copy.image_region.dstSubresource.baseArrayLayer, 2u);
    EXPECT_EQ(copy.image_region.dstOffset.x, 11);
    EXPECT_EQ(copy.image_region.dstOffset.y, 13);
    EXPECT_EQ(copy.image_region.extent.width, 7u);
    EXPECT_EQ(copy.image_region.extent.height, 5u);
  }
}

TEST(VulkanRecord, RefusalsRecordNothing) {
  for (const ColorFormat format : {ColorFormat::none, ColorFormat::rgba8, ColorFormat::rgba16f}) {
    vulkan::RingDesc desc = ring_desc();
    desc.format = format;
    Rig rig(kShared, desc);
    for (const VkFormat into :
         {VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R5G6B5_UNORM_PACK16, VK_FORMAT_UNDEFINED,
          format == ColorFormat::rgba8 ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_B8G8R8A8_UNORM})
      EXPECT_EQ(thrown_by([&] { rig.ring.record_copy(0, 0, copy_to(rig.mock, into)); }),
                error_of(ErrorCode::unsupported))
          << into;
    for (const VkFormat from : {VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32})
      EXPECT_EQ(thrown_by([&] { rig.ring.record_depth_limit(0, 0, limit_from(rig.mock, from)); }),
                error_of(ErrorCode::unsupported))
          << from;
    EXPECT_TRUE(rig.mock.commands.empty());
  }
}

vulkan::CompositeDraw draw_of(vulkan::DepthUse use, DepthForm form) {
  vulkan::CompositeDraw draw;
  draw.commands = VulkanMock::commands_at(3);
  draw.area = {{1, 2}, {7, 5}};
  draw.depth_use = use;
  draw.encoding = depth_encoding(form, 0.1, 100.0);
  return draw;
}

TEST(VulkanRecord, ACompositeBindsItsImageAndAPipelineForEachUseOfDepth) {
  Rig rig(kShared);
  vulkan::CompositeDesc desc;
  desc.color = VK_FORMAT_B8G8R8A8_UNORM;
  desc.depth = VK_FORMAT_D32_SFLOAT;
  const vulkan::Composite composite(rig.device, desc);
  std::set<VkPipeline> seen;
  for (const vulkan::DepthUse use :
       {vulkan::DepthUse::none, vulkan::DepthUse::test, vulkan::DepthUse::write})
    for (const DepthForm form : {DepthForm::standard, DepthForm::reversed}) {
      rig.mock.commands.clear();
      composite.record(rig.ring, 1, 1, draw_of(use, form));
      uint32_t draws = 0;
      bool bound = false, pushed = false, area = false, clip = false;
      for (const Command& command : rig.mock.commands) {
        EXPECT_EQ(command.commands, VulkanMock::commands_at(3));
        if (command.kind == Command::bind_pipeline) seen.insert(command.pipeline), bound = true;
        if (command.kind == Command::bind_sets) {
          const std::vector<VkImageView>& views = rig.mock.written[command.set];
          EXPECT_EQ(views, (std::vector<VkImageView>{rig.ring.image(1).color_view,
                                                     rig.ring.image(1).depth_view}));
        }
        pushed |= command.kind == Command::push_constants;
        area |= command.kind == Command::viewport;
        clip |= command.kind == Command::scissor;
        if (command.kind != Command::draw) continue;
        EXPECT_TRUE(bound && pushed && area && clip);
        ++draws;
      }
      EXPECT_EQ(draws, use == vulkan::DepthUse::write ? 2u : 1u);
    }
  EXPECT_EQ(seen.size(), 5u);  // colour; tested and depth alone, either way round
}

TEST(VulkanRecord, ACompositeThatLacksWhatIsAskedForRecordsNothing) {
  vulkan::RingDesc no_color = ring_desc(), no_depth = ring_desc();
  no_color.format = ColorFormat::none;
  no_depth.depth = false;
  struct Case {
    vulkan::RingDesc ring;
    VkFormat depth;
    vulkan::DepthUse use;
  };
  for (const Case& c : {Case{no_color, VK_FORMAT_D32_SFLOAT, vulkan::DepthUse::none},
                        Case{no_depth, VK_FORMAT_D32_SFLOAT, vulkan::DepthUse::test},
                        Case{ring_desc(), VK_FORMAT_UNDEFINED, vulkan::DepthUse::write}}) {
    Rig rig(kShared, c.ring);
    vulkan::CompositeDesc desc;
    desc.color = VK_FORMAT_B8G8R8A8_UNORM;
    desc.depth = c.depth;
    const vulkan::Composite composite(rig.device, desc);
    EXPECT_EQ(
        thrown_by([&] { composite.record(rig.ring, 0, 0, draw_of(c.use, DepthForm::standard)); }),
        error_of(ErrorCode::invalid_argument));
    EXPECT_TRUE(rig.mock.commands.empty());
  }
}

}  // namespace
}  // namespace record_test
}  // namespace voyager::test
