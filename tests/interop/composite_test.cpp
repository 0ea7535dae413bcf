// A ring's image over the host's, against the same composite made here.
#include <algorithm>

#include "frames.h"

namespace composite_test {
namespace {

constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM, kDepth = VK_FORMAT_D32_SFLOAT;

// The host's picture: colour, and a mesh before, amid and behind the splats, and none.
struct Picture {
  std::vector<uint8_t> color;
  std::vector<float> metres;
};

struct Drawn {
  std::vector<uint8_t> color;
  std::vector<float> depth;
};

// As OpenGL and Vulkan have it with a far plane, and reversed without.
struct Convention {
  VoyDepthEncoding encoding;
  double near_z, far_z;
  float code(float z) const {
    const double t = (1 / static_cast<double>(z) - 1 / far_z) / (1 / near_z - 1 / far_z);
    const double within = std::max(t, 0.0);  // nothing lies at the far plane
    return static_cast<float>(encoding == VOY_DEPTH_ENCODING_REVERSED ? within : 1 - within);
  }
};

class Composites : public Interop {
 protected:
  static constexpr size_t kPixels = size_t{kWidth} * kHeight;

  void TearDown() override {
    if (composite != nullptr) {
      EXPECT_EQ(voyDestroyVulkanComposite(composite), VOY_SUCCESS);
      vkDestroyFramebuffer(host->device, framebuffer, nullptr);
      vkDestroyImageView(host->device, color_view, nullptr);
      vkDestroyImageView(host->device, depth_view, nullptr);
      vkDestroyRenderPass(host->device, pass, nullptr);
      color.reset(), depth.reset();
    }
    Interop::TearDown();
  }

  void make_pass() {
    const auto attachment = [](VkFormat format, VkImageLayout layout) {
      VkAttachmentDescription out{};
      out.format = format;
      out.samples = VK_SAMPLE_COUNT_1_BIT;
      out.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
      out.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
      out.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
      out.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
      out.initialLayout = out.finalLayout = layout;
      return out;
    };
    const VkAttachmentDescription attachments[] = {
        attachment(kColor, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
        attachment(kDepth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL)};
    const VkAttachmentReference to_color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference to_depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &to_color;
    subpass.pDepthStencilAttachment = &to_depth;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = 2;
    info.pAttachments = attachments;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    VK(vkCreateRenderPass(host->device, &info, nullptr, &pass));
  }

  VkImageView make_view_of(const HostImage& image) const {
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = image.image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = image.desc.format;
    info.subresourceRange = {image.desc.aspect, 0, 1, 0, 1};
    VkImageView made = VK_NULL_HANDLE;
    VK(vkCreateImageView(host->device, &info, nullptr, &made));
    return made;
  }

  void make_attachments() {
    make_pass();
    ImageDesc desc;
    desc.width = kWidth, desc.height = kHeight;
    desc.format = kColor;
    desc.usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    color = std::make_unique<HostImage>(*host, desc);
    desc.format = kDepth;
    desc.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    desc.usage ^= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    depth = std::make_unique<HostImage>(*host, desc);
    color_view = make_view_of(*color), depth_view = make_view_of(*depth);
    const VkImageView views[] = {color_view, depth_view};
    const VkFramebufferCreateInfo info{
        VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO, nullptr, 0, pass, 2, views, kWidth, kHeight, 1};
    VK(vkCreateFramebuffer(host->device, &info, nullptr, &framebuffer));
    VoyVulkanCompositeDesc desc_of = VOY_VULKAN_COMPOSITE_DESC_INIT;
    desc_of.renderPass = pass;
    desc_of.colorFormat = kColor;
    desc_of.depthFormat = kDepth;
    ASSERT_EQ(voyCreateVulkanComposite(device, &desc_of, &composite), VOY_SUCCESS)
        << voyGetLastErrorMessage();
  }

  static void fill_image(VkCommandBuffer commands, const HostImage& image, const MappedBuffer& from,
                         VkImageLayout to) {
    image.barrier(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkBufferImageCopy region{
        0, 0, 0, {image.desc.aspect, 0, 0, 1}, {0, 0, 0}, {kWidth, kHeight, 1}};
    vkCmdCopyBufferToImage(commands, from.buffer, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           1, &region);
    image.barrier(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, to);
  }

  VoyTarget make_target_with_depth() {
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.hasDepth = VK_TRUE;
    return make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
  }

  static VoyVulkanCompositeDraw draw_of(VoyTarget target, VoyVulkanDepthUse depth_use,
                                        const Convention& convention) {
    VoyVulkanCompositeDraw draw = VOY_VULKAN_COMPOSITE_DRAW_INIT;
    draw.target = target;
    draw.area = {{0, 0}, {kWidth, kHeight}};
    draw.depthUse = depth_use;
    draw.depthEncoding = convention.encoding;
    draw.nearZ = convention.near_z;
    draw.farZ = convention.far_z;
    return draw;
  }

  // What the host's picture is after a frame of the eye was drawn and composited over it.
  Drawn compose(Line& line, const VoyFrameEye& seen, VoyVulkanCompositeDraw draw,
                const std::vector<uint8_t>& color_before, const std::vector<float>& depth_before) {
    const MappedBuffer from_color(*host, kPixels * 4), from_depth(*host, kPixels * 4),
        into_color(*host, kPixels * 4), into_depth(*host, kPixels * 4);
    std::memcpy(from_color.data, color_before.data(), kPixels * 4);
    std::memcpy(from_depth.data, depth_before.data(), kPixels * 4);
    VkCommandBuffer commands = host->begin();
    release(line, seen.target, 0, commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    host->finish(commands, {}, line.released(0));
    EXPECT_EQ(render(line, 0, seen), VOY_SUCCESS) << voyGetLastErrorMessage();
    commands = host->begin();
    fill_image(commands, *color, from_color, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    fill_image(commands, *depth, from_depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    VoyVulkanUse used = use(commands, 0);
    used.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    used.stages = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    EXPECT_EQ(voyRecordVulkanAcquire(seen.target, &used), VOY_SUCCESS);
    const VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                      nullptr,
                                      pass,
                                      framebuffer,
                                      {{0, 0}, {kWidth, kHeight}},
                                      0,
                                      nullptr};
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    draw.commandBuffer = commands;
    EXPECT_EQ(voyRecordVulkanComposite(composite, &draw), VOY_SUCCESS) << voyGetLastErrorMessage();
    vkCmdEndRenderPass(commands);
    color->barrier(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    depth->barrier(commands, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    copy_to_buffer(commands, color->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   extent(kWidth, kHeight), 0, VK_IMAGE_ASPECT_COLOR_BIT, into_color);
    copy_to_buffer(commands, depth->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   extent(kWidth, kHeight), 0, VK_IMAGE_ASPECT_DEPTH_BIT, into_depth);
    host->finish(commands, line.rendered(0), {});
    return {into_color.read<uint8_t>(kPixels * 4), into_depth.read<float>(kPixels)};
  }

  VkRenderPass pass = VK_NULL_HANDLE;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  VkImageView color_view = VK_NULL_HANDLE, depth_view = VK_NULL_HANDLE;
  std::unique_ptr<HostImage> color, depth;
  VoyVulkanComposite composite = nullptr;
};

Picture host_picture(uint32_t width, uint32_t height) {
  Picture picture;
  for (uint32_t i = 0; i < width * height; ++i) {
    const uint32_t x = i % width;
    for (const uint32_t channel : {x * 2, i % 200, 90u, 255u})
      picture.color.push_back(static_cast<uint8_t>(channel));
    const float metres[] = {3.0f, 12.0f, 30.0f, INFINITY};
    picture.metres.push_back(metres[x * 4 / width]);
  }
  return picture;
}

constexpr Convention kConventions[] = {{VOY_DEPTH_ENCODING_STANDARD, 0.5, 100},
                                       {VOY_DEPTH_ENCODING_REVERSED, 0.2, INFINITY}};
constexpr VoyVulkanDepthUse kUses[] = {VOY_VULKAN_DEPTH_USE_NONE, VOY_VULKAN_DEPTH_USE_TEST,
                                       VOY_VULKAN_DEPTH_USE_WRITE};

TEST_F(Composites, EqualTheOneMadeFromTheSameImages) {
  ASSERT_TRUE(create());
  make_attachments();
  const VoyTarget target = make_target_with_depth();
  Line line = line_of(target);
  const Picture before = host_picture(kWidth, kHeight);
  for (const Convention& convention : kConventions)
    for (const VoyVulkanDepthUse depth_use : kUses) {
      SCOPED_TRACE(std::to_string(convention.encoding) + ", depth use " +
                   std::to_string(depth_use));
      std::vector<float> codes(kPixels);
      for (size_t i = 0; i < kPixels; ++i) codes[i] = convention.code(before.metres[i]);
      const Shot shot = expected(VOY_COLOR_FORMAT_RGBA8_UNORM, eye(target), 4);
      const Drawn got =
          compose(line, eye(target), draw_of(target, depth_use, convention), before.color, codes);
      const bool tested = depth_use == VOY_VULKAN_DEPTH_USE_TEST;
      int wrong = 0, wrong_depth = 0, hidden = 0, drawn = 0;
      for (size_t i = 0; i < kPixels; ++i) {
        const float z = shot.depth[i];  // +inf where it has none
        const bool nearer = z <= before.metres[i];
        const bool shows = !tested || nearer;
        const uint8_t* own = &shot.color[4 * i];
        (shows ? drawn : hidden) += own[3] != 0;
        for (int k = 0; k < 4; ++k) {
          const double over = shows ? own[k] + before.color[4 * i + k] * (255 - own[3]) / 255.0
                                    : before.color[4 * i + k];
          wrong += std::fabs(got.color[4 * i + k] - over) > 1.0;
        }
        const bool writes = depth_use != VOY_VULKAN_DEPTH_USE_NONE && nearer && z < INFINITY;
        wrong_depth += std::fabs(got.depth[i] - (writes ? convention.code(z) : codes[i])) > 2e-6f;
      }
      EXPECT_EQ(wrong, 0);
      EXPECT_EQ(wrong_depth, 0);
      EXPECT_GT(drawn, 500);
      EXPECT_EQ(hidden > 0, tested);
    }
}

// The rows of `area` in the opposite order, the rest as it is.
template <class T>
std::vector<T> turned(std::vector<T> pixels, const VkRect2D& area, size_t width, size_t channels) {
  const auto left = static_cast<size_t>(area.offset.x), top = static_cast<size_t>(area.offset.y);
  const auto place = [&](size_t row) {
    return pixels.begin() + static_cast<std::ptrdiff_t>(((top + row) * width + left) * channels);
  };
  const auto count = static_cast<std::ptrdiff_t>(area.extent.width * channels);
  for (size_t row = 0; row < area.extent.height / 2; ++row)
    std::swap_ranges(place(row), place(row) + count, place(area.extent.height - 1 - row));
  return pixels;
}

VoyVulkanReprojection reprojection(const VoyFrameEye& drawn, const VoyFrameEye& now) {
  VoyVulkanReprojection out = VOY_VULKAN_REPROJECTION_INIT;
  out.drawnPose = drawn.pose;
  out.drawnFrustum = drawn.frustum;
  out.pose = now.pose;
  out.frustum = now.frustum;
  return out;
}

double squared_error(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

TEST_F(Composites, ReprojectedToTheEyeThatDrewThemAreAsDrawn) {
  ASSERT_TRUE(create());
  make_attachments();
  const VoyTarget target = make_target_with_depth();
  Line line = line_of(target);
  const Picture before = host_picture(kWidth, kHeight);
  const VoyVulkanReprojection still = reprojection(eye(target), eye(target));
  for (const Convention& convention : kConventions)
    for (const VoyVulkanDepthUse depth_use : kUses) {
      std::vector<float> codes(kPixels);
      for (size_t i = 0; i < kPixels; ++i) codes[i] = convention.code(before.metres[i]);
      VoyVulkanCompositeDraw draw = draw_of(target, depth_use, convention);
      const Drawn as_drawn = compose(line, eye(target), draw, before.color, codes);
      draw.next = &still;
      const Drawn got = compose(line, eye(target), draw, before.color, codes);
      int wrong = 0;
      for (size_t i = 0; i < kPixels * 4; ++i)
        wrong += std::abs(got.color[i] - as_drawn.color[i]) > 1;
      EXPECT_EQ(wrong, 0) << convention.encoding << ", depth use " << depth_use;
      for (size_t i = 0; i < kPixels; ++i)
        ASSERT_NEAR(got.depth[i], as_drawn.depth[i], 1e-5) << convention.encoding << ", " << i;
    }
}

// Against the frame that the eye would have had: a step aside, a turn, another frustum. A step
// needs a depth for each pixel, and a cloud of Gaussians is no surface.
TEST_F(Composites, ReprojectedShowWhatTheOtherEyeSees) {
  ASSERT_TRUE(create());
  make_attachments();
  const VoyTarget target = make_target_with_depth();
  Line line = line_of(target);
  VoyFrameEye stepped = eye(target, 0.2), turned = eye(target), wider = eye(target);
  turned.pose.orientation[1] = std::sin(0.02);
  turned.pose.orientation[3] = std::cos(0.02);
  wider.frustum = {-0.62, 0.6, 0.41, -0.4};
  const std::vector<uint8_t> black(kPixels * 4);
  const std::vector<float> far(kPixels, 1.0f);
  struct Case {
    const VoyFrameEye& now;
    double share;  // of the error that is left
  };
  for (const auto& [now, share] : {Case{stepped, 0.75}, Case{turned, 0.1}, Case{wider, 0.1}}) {
    const VoyVulkanReprojection moved = reprojection(eye(target), now);
    VoyVulkanCompositeDraw draw = draw_of(target, VOY_VULKAN_DEPTH_USE_WRITE, kConventions[0]);
    const Drawn as_drawn = compose(line, eye(target), draw, black, far);
    draw.next = &moved;
    const Drawn got = compose(line, eye(target), draw, black, far);
    const Shot wanted = expected(VOY_COLOR_FORMAT_RGBA8_UNORM, now, 4);
    const double before = squared_error(as_drawn.color, wanted.color);
    EXPECT_LT(squared_error(got.color, wanted.color), share * before) << before;
    int near = 0, both = 0;
    for (size_t i = 0; i < kPixels; ++i) {
      if (wanted.depth[i] == INFINITY || got.depth[i] == 1.0f) continue;
      ++both;
      near += std::fabs(got.depth[i] - kConventions[0].code(wanted.depth[i])) < 1e-3f;
    }
    EXPECT_GT(both, 500);
    EXPECT_GT(near, both * 8 / 10) << both;
  }
}

TEST_F(Composites, UpsideDownHaveTheSameRowsInTheOppositeOrder) {
  ASSERT_TRUE(create());
  make_attachments();
  const VoyTarget target = make_target_with_depth();
  Line line = line_of(target);
  const Picture before = host_picture(kWidth, kHeight);
  std::vector<float> codes(kPixels);
  for (size_t i = 0; i < kPixels; ++i) codes[i] = kConventions[1].code(before.metres[i]);
  const VoyVulkanReprojection moved = reprojection(eye(target), eye(target, 0.2));
  for (const VoyVulkanDepthUse depth_use : kUses)
    for (const VoyVulkanReprojection* next :
         {static_cast<const VoyVulkanReprojection*>(nullptr), &moved}) {
      SCOPED_TRACE(std::to_string(depth_use) + (next ? ", reprojected" : ""));
      VoyVulkanCompositeDraw draw = draw_of(target, depth_use, kConventions[1]);
      draw.next = next;
      draw.area = {{5, 3}, {kWidth - 9, kHeight - 8}};
      const Drawn upright = compose(line, eye(target), draw, before.color, codes);
      draw.upsideDown = VK_TRUE;
      const Drawn got = compose(line, eye(target), draw, turned(before.color, draw.area, kWidth, 4),
                                turned(codes, draw.area, kWidth, 1));
      EXPECT_NE(got.color, upright.color);
      EXPECT_EQ(turned(got.color, draw.area, kWidth, 4), upright.color);
      EXPECT_EQ(turned(got.depth, draw.area, kWidth, 1), upright.depth);
    }
}

TEST_F(Composites, ReprojectionsAreRefusedByWhatIsWrong) {
  ASSERT_TRUE(create());
  make_attachments();
  const VoyTarget target = make_target_with_depth();
  VoyVulkanReprojection moved = reprojection(eye(target), eye(target));
  VoyVulkanCompositeDraw draw = draw_of(target, VOY_VULKAN_DEPTH_USE_NONE, kConventions[0]);
  draw.commandBuffer = host->begin();
  draw.next = &moved;
  const auto refused = [&](const char* part) {
    EXPECT_EQ(voyRecordVulkanComposite(composite, &draw), VOY_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(voyGetLastErrorMessage()).find(part), std::string::npos)
        << voyGetLastErrorMessage();
    moved = reprojection(eye(target), eye(target));
  };
  moved.pose.position[1] = NAN;
  refused("draw.next.pose.position");
  moved.drawnPose.orientation[3] = 0;
  refused("draw.next.drawnPose.orientation");
  moved.frustum.left = moved.frustum.right;
  refused("draw.next.frustum.left");
  VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
  draw.target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
  refused("without depth");
  host->finish(draw.commandBuffer, {}, {});
}

}  // namespace
}  // namespace composite_test
