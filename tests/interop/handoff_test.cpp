// What comes out of a ring is what the same frame gives in host memory, to the bit, in each
// mode of sharing and waiting.
#include "frames.h"

namespace handoff_test {
namespace {

struct Format {
  VoyColorFormat format;
  size_t bytes;
};
constexpr Format kFormats[] = {{VOY_COLOR_FORMAT_NONE, 0},
                               {VOY_COLOR_FORMAT_RGBA8_UNORM, 4},
                               {VOY_COLOR_FORMAT_RGBA16F, 8},
                               {VOY_COLOR_FORMAT_RGBA32F, 16}};

TEST_F(Interop, AFrameIsTheSameInARingAsInHostMemory) {
  FOR_EACH_MODE({
    for (const Format& format : kFormats) {
      SCOPED_TRACE(format.format);
      VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
      images.imageCount = 3;
      images.hasDepth = VK_TRUE;
      const VoyTarget target = make_target(target_desc(format.format, &images));
      Line line = line_of(target);
      for (uint32_t frame = 0; frame < 5; ++frame) {
        const VoyFrameEye at = eye(target, 0.5 * frame);
        const Shot shot = shoot(line, target, frame % 3, at, format.bytes);
        const Shot whole = expected(format.format, at, format.bytes);
        EXPECT_EQ(shot.color, whole.color) << "frame " << frame;
        EXPECT_EQ(shot.depth, whole.depth) << "frame " << frame;
      }
      EXPECT_EQ(voyDestroyTarget(target), VOY_SUCCESS);
    }
  });
}

// Enough of them that what the frame before covered is left out, and where it is uncovered drawn
// once more: as a view draws it that has seen nothing before.
TEST_F(Interop, WhatIsHiddenChangesNoBitOfARing) {
  if (!cuda()) VOYAGER_SKIP_WITHOUT(CUDA, "nothing hidden is left out on the CPU");
  constexpr uint32_t kSide = 512;
  gaussians = 150000;
  FOR_EACH_MODE({
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    const VoyTarget target =
        make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images, kSide, kSide));
    Line line = line_of(target);
    VoyFrameStats stats = VOY_FRAME_STATS_INIT;
    uint64_t pairs = 0;
    for (uint32_t frame = 0; frame < 6; ++frame) {
      const VoyFrameEye at = eye(target, frame < 4 ? 0.01 * frame : 2.0 * frame);
      const Shot shot = shoot(line, target, frame % 2, at, 4, kSide, kSide);
      EXPECT_EQ(shot.color, expected(VOY_COLOR_FORMAT_RGBA8_UNORM, at, 4, kSide, kSide).color)
          << "frame " << frame;
      ASSERT_EQ(voyGetFrameStats(view, &stats), VOY_SUCCESS) << voyGetLastErrorMessage();
      EXPECT_EQ(stats.pairsDropped, 0u);
      if (frame == 0) pairs = stats.pairsAfterFilter;
      if (frame == 3) {
        EXPECT_LT(stats.pairsAfterFilter, pairs);
      }
    }
    EXPECT_EQ(voyDestroyTarget(target), VOY_SUCCESS);
  });
}

TEST_F(Interop, LayersKeepToThemselves) {
  FOR_EACH_MODE({
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.imageCount = 1;
    images.layerCount = 2;
    images.hasDepth = VK_TRUE;
    const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
    Line line = line_of(target);
    for (uint32_t layer = 0; layer < 2; ++layer) {
      VoyFrameEye at = eye(target, layer);
      at.layer = layer;
      const Shot shot = shoot(line, target, 0, at, 4);
      const Shot whole = expected(VOY_COLOR_FORMAT_RGBA8_UNORM, at, 4);
      EXPECT_EQ(shot.color, whole.color) << layer;
      EXPECT_EQ(shot.depth, whole.depth) << layer;
    }
    // The other layer still holds its own frame.
    VkCommandBuffer commands = host->begin();
    const MappedBuffer read(*host, kWidth * kHeight * 4);
    copy_to_buffer(commands, line.images[0].color, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   extent(kWidth, kHeight), 0, VK_IMAGE_ASPECT_COLOR_BIT, read);
    host->finish(commands);
    EXPECT_EQ(read.read<uint8_t>(kWidth * kHeight * 4),
              expected(VOY_COLOR_FORMAT_RGBA8_UNORM, eye(target, 0), 4).color);
  });
}

// Half of the frames are marks, nothing but their own background; half are the splats from
// one of a few places. With two in flight and a host that takes its time at random, each image
// must be all of one frame, and of the right one.
TEST_F(Interop, NoFrameIsTornOrStale) {
  const char* wanted = std::getenv("VOYAGER_INTEROP_FRAMES");
  const int frames = wanted == nullptr ? 60 : std::atoi(wanted);
  constexpr uint32_t kRing = 2;
  FOR_EACH_MODE({
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.imageCount = kRing;
    const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
    Line line = line_of(target);
    std::mt19937 random(5);
    // Drawn before, so that buffers have room for each: a frame in flight cannot be drawn again.
    std::vector<VoyFrameEye> places;
    std::vector<std::vector<uint8_t>> pictures;
    for (int i = 0; i < 5; ++i) {
      places.push_back(eye(target, static_cast<double>(random() % 6000) / 1000 - 3));
      pictures.push_back(expected(VOY_COLOR_FORMAT_RGBA8_UNORM, places.back(), 4).color);
      shoot(line, target, 0, places.back(), 4);
    }
    struct InFlight {
      VkFence fence = VK_NULL_HANDLE;
      VkCommandBuffer before = VK_NULL_HANDLE, after = VK_NULL_HANDLE;
      std::unique_ptr<MappedBuffer> read;
      const std::vector<uint8_t>* picture = nullptr;  // or the mark
      uint32_t mark = 0;
    } flight[kRing];
    for (InFlight& f : flight) f.read = std::make_unique<MappedBuffer>(*host, kWidth * kHeight * 4);
    const auto dawdle = [&] { ::usleep(random() % 4 == 0 ? random() % 3000 : 0); };
    int wrong = 0;
    const auto check = [&](InFlight& f) {
      if (f.fence == VK_NULL_HANDLE) return;
      host->wait_for(f.fence);
      const std::vector<uint32_t> pixels = f.read->read<uint32_t>(kWidth * kHeight);
      for (size_t i = 0; i < pixels.size(); ++i) {
        uint32_t right = f.mark | (pixels[i] & 0xff000000);
        if (f.picture != nullptr) std::memcpy(&right, &(*f.picture)[4 * i], sizeof right);
        wrong += pixels[i] != right;
      }
      vkDestroyFence(host->device, f.fence, nullptr);
      vkFreeCommandBuffers(host->device, host->pool, 1, &f.before);
      vkFreeCommandBuffers(host->device, host->pool, 1, &f.after);
      f.fence = VK_NULL_HANDLE;
    };
    for (int frame = 0; frame < frames; ++frame) {
      const uint32_t image = static_cast<uint32_t>(frame) % kRing;
      InFlight& f = flight[image];
      check(f);
      f.before = host->begin();
      release(line, target, image, f.before);
      if (found.sync == VOY_VULKAN_SYNC_HOST) {
        const VkFence fence = host->make_fence();
        host->submit(f.before, {}, {}, fence);
        host->wait_for(fence);
        vkDestroyFence(host->device, fence, nullptr);
      } else {
        host->submit(f.before, {}, line.released(image));
      }
      dawdle();
      f.mark = static_cast<uint32_t>(random()) & 0xffffff;
      const float background[] = {static_cast<float>(f.mark & 255) / 255.0f,
                                  static_cast<float>(f.mark >> 8 & 255) / 255.0f,
                                  static_cast<float>(f.mark >> 16) / 255.0f};
      const size_t place = random() % (2 * places.size());
      const bool marked = place >= places.size();
      VoyFrameEye at = marked ? eye(target) : places[place];
      if (marked) at.pose.orientation[1] = 1, at.pose.orientation[3] = 0;  // turned round
      f.picture = marked ? nullptr : &pictures[place];
      ASSERT_EQ(render(line, image, at, marked ? background : nullptr), VOY_SUCCESS)
          << voyGetLastErrorMessage();
      dawdle();
      f.after = host->begin();
      const VoyVulkanUse used = use(f.after, image);
      ASSERT_EQ(voyRecordVulkanAcquire(target, &used), VOY_SUCCESS);
      copy_to_buffer(f.after, line.images[image].color, used.layout, extent(kWidth, kHeight), 0,
                     VK_IMAGE_ASPECT_COLOR_BIT, *f.read);
      f.fence = host->make_fence();
      host->submit(f.after, line.rendered(image), {}, f.fence);
    }
    for (InFlight& f : flight) check(f);
    EXPECT_EQ(wrong, 0) << "pixels in " << frames << " frames";
  });
}

TEST_F(Interop, ADepthLimitFromTheHostsDepthBufferIsThatFromItsMemory) {
  FOR_EACH_MODE({
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.imageCount = 1;
    images.layerCount = 2;
    images.hasDepth = VK_TRUE;
    images.hasDepthLimit = VK_TRUE;
    const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA32F, &images));
    // Reversed, infinitely far: 0.1 m / z. A ramp from 8 to 16 m, and nothing in a corner.
    std::vector<float> depth(kWidth * kHeight);
    for (uint32_t i = 0; i < depth.size(); ++i)
      depth[i] =
          i % kWidth < 10 ? 0.0f : 0.1f / (8.0f + 8.0f * static_cast<float>(i % kWidth) / kWidth);
    const MappedBuffer source(*host, depth.size() * sizeof(float));
    std::memcpy(source.data, depth.data(), depth.size() * sizeof(float));
    ImageDesc wanted;
    wanted.format = VK_FORMAT_D32_SFLOAT;
    wanted.width = kWidth, wanted.height = kHeight;
    wanted.usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    wanted.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    const HostImage drawn(*host, wanted);
    Line line = line_of(target);

    VoyFrameEye at = eye(target, 1);
    at.layer = 1;
    VoyEyeDepthLimit limit = VOY_EYE_DEPTH_LIMIT_INIT;
    limit.depthEncoding = VOY_DEPTH_ENCODING_REVERSED;
    limit.nearZ = 0.1;
    limit.farZ = INFINITY;
    at.next = &limit;

    VkCommandBuffer commands = host->begin();
    drawn.barrier(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkBufferImageCopy region{
        0, 0, 0, {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1}, {0, 0, 0}, {kWidth, kHeight, 1}};
    vkCmdCopyBufferToImage(commands, source.buffer, drawn.image,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    drawn.barrier(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VoyVulkanDepthLimit taken = VOY_VULKAN_DEPTH_LIMIT_INIT;
    taken.commandBuffer = commands;
    taken.queueFamily = host->family;
    taken.layer = 1;
    taken.depth = drawn.image;
    ASSERT_EQ(voyRecordVulkanDepthLimit(target, &taken), VOY_SUCCESS) << voyGetLastErrorMessage();
    host->finish(commands);

    const Shot shot = shoot(line, target, 0, at, 16);
    limit.depth = depth.data();
    const Shot whole = expected(VOY_COLOR_FORMAT_RGBA32F, at, 16);
    EXPECT_EQ(shot.color, whole.color);
    EXPECT_EQ(shot.depth, whole.depth);
    at.next = nullptr;
    EXPECT_NE(whole.color, expected(VOY_COLOR_FORMAT_RGBA32F, at, 16).color) << "it hides nothing";
  });
}

TEST_F(Interop, ACopyKeepsCodeValues) {
  ASSERT_TRUE(create());
  VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
  const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
  Line line = line_of(target);
  const Shot shot = shoot(line, target, 0, eye(target), 4);
  for (const VkFormat format :
       {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_UNORM}) {
    SCOPED_TRACE(format);
    ImageDesc wanted;
    wanted.format = format;
    wanted.width = kWidth + 7, wanted.height = kHeight + 3;
    const HostImage into(*host, wanted);
    VkCommandBuffer commands = host->begin();
    into.barrier(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VoyVulkanCopy copy = VOY_VULKAN_COPY_INIT;
    copy.commandBuffer = commands;
    copy.into = into.image;
    copy.intoFormat = format;
    copy.intoOffset = {7, 3};
    ASSERT_EQ(voyRecordVulkanCopy(target, &copy), VOY_SUCCESS) << voyGetLastErrorMessage();
    into.barrier(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    const uint32_t width = wanted.width, height = wanted.height;
    const MappedBuffer read(*host, width * height * 4);
    copy_to_buffer(commands, into.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   extent(width, height), 0, VK_IMAGE_ASPECT_COLOR_BIT, read);
    host->finish(commands);
    const std::vector<uint8_t> got = read.read<uint8_t>(width * height * 4);
    const bool swapped = format == VK_FORMAT_B8G8R8A8_UNORM;
    int wrong = 0;
    for (uint32_t i = 0; i < kWidth * kHeight * 4; ++i) {
      const uint32_t pixel = i / 4, channel = swapped && i % 4 != 3 ? 2 - i % 4 : i % 4;
      wrong +=
          got[((pixel / kWidth + 3) * width + pixel % kWidth + 7) * 4 + channel] != shot.color[i];
    }
    EXPECT_EQ(wrong, 0);
  }
}

}  // namespace
}  // namespace handoff_test
