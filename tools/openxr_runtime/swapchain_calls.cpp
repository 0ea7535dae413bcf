#include "swapchain.h"

using namespace test_runtime;

namespace {

void expect(bool fine, const char* what) {
  if (!fine) violation(XR_ERROR_VALIDATION_FAILURE, what);
}

const Format& check_create_info(const XrSwapchainCreateInfo& info) {
  const auto& script = run().script;
  if (info.createFlags & XR_SWAPCHAIN_CREATE_PROTECTED_CONTENT_BIT)
    refuse(XR_ERROR_FEATURE_UNSUPPORTED, "createFlags: no protected content");
  bool offered = false;
  for (const int64_t format : script.formats) offered |= format == info.format;
  if (!offered)
    violation(XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED,
              "format: found " + std::to_string(info.format) +
                  ", expected one that xrEnumerateSwapchainFormats gave");
  expect(info.width >= 1 && info.width <= static_cast<uint32_t>(script.maximum.width),
         "width: expected 1 to maxSwapchainImageWidth");
  expect(info.height >= 1 && info.height <= static_cast<uint32_t>(script.maximum.height),
         "height: expected 1 to maxSwapchainImageHeight");
  expect(info.faceCount == 1 || info.faceCount == 6, "faceCount: expected 1 or 6");
  expect(info.sampleCount >= 1, "sampleCount: expected at least 1");
  expect(info.arraySize >= 1, "arraySize: expected at least 1");
  expect(info.mipCount >= 1, "mipCount: expected at least 1");
  if (info.faceCount != 1 || info.sampleCount != 1 || info.arraySize > 2)
    refuse(XR_ERROR_FEATURE_UNSUPPORTED, "one face, one sample, at most two layers are supported");
  const Format& format = *find_format(info.format);
  const XrSwapchainUsageFlags attachment = format.depth
                                               ? XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                               : XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT;
  if (!(info.usageFlags & attachment))
    remark("usageFlags: found no attachment of " + std::string(format.name) +
           ", which an image must be left as");
  return format;
}

}  // namespace

XrResult xrEnumerateSwapchainFormats(XrSession handle, uint32_t capacity, uint32_t* count,
                                     int64_t* formats) {
  return call(__func__, [&](auto&) {
    find_session(handle);
    const auto& offered = run().script.formats;
    return enumerate(offered.size(), capacity, count, formats,
                     [&](size_t i, int64_t& format) { format = offered[i]; });
  });
}

XrResult xrCreateSwapchain(XrSession handle, const XrSwapchainCreateInfo* info,
                           XrSwapchain* created) {
  return call(__func__, [&](auto&) {
    Session& session = find_session(handle);
    checked(info, XR_TYPE_SWAPCHAIN_CREATE_INFO, "createInfo");
    checked_pointer(created, "swapchain");
    const Format& format = check_create_info(*info);
    XrSwapchainCreateInfo kept = *info;
    kept.next = nullptr;
    *created =
        context().handles.add<XrSwapchain>(std::make_unique<Swapchain>(session, kept, format));
    return success(session);
  });
}

XrResult xrDestroySwapchain(XrSwapchain handle) {
  return call(__func__, [&](auto&) {
    context().handles.destroy(context().handles.find<Swapchain>(handle, "swapchain").handle);
    return XR_SUCCESS;
  });
}

XrResult xrEnumerateSwapchainImages(XrSwapchain handle, uint32_t capacity, uint32_t* count,
                                    XrSwapchainImageBaseHeader* images) {
  return call(__func__, [&](auto&) {
    const Swapchain& swapchain = find_swapchain(handle);
    return enumerate(swapchain.images.size(), capacity, count,
                     reinterpret_cast<XrSwapchainImageVulkanKHR*>(images),
                     [&](size_t i, XrSwapchainImageVulkanKHR& image) {
                       checked(&image, XR_TYPE_SWAPCHAIN_IMAGE_VULKAN_KHR, "images");
                       image.image = swapchain.images[i].image;
                     });
  });
}

XrResult xrAcquireSwapchainImage(XrSwapchain handle, const XrSwapchainImageAcquireInfo* info,
                                 uint32_t* index) {
  return call(__func__, [&](auto&) {
    Swapchain& swapchain = find_swapchain(handle);
    if (info) checked(info, XR_TYPE_SWAPCHAIN_IMAGE_ACQUIRE_INFO, "acquireInfo");
    checked_pointer(index, "index");
    const bool fixed = swapchain.info.createFlags & XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT;
    if (fixed && swapchain.acquisitions > 0)
      violation(XR_ERROR_CALL_ORDER_INVALID, "a static image is acquired once");
    const uint32_t next = swapchain.next_image();
    SwapchainImage& image = swapchain.images[next];
    swapchain.initialise(image);
    image.acquired = true;
    swapchain.acquired.push_back(next);
    ++swapchain.acquisitions;
    *index = next;
    return success(swapchain.session);
  });
}

XrResult xrWaitSwapchainImage(XrSwapchain handle, const XrSwapchainImageWaitInfo* info) {
  return call(__func__, [&](auto&) {
    Swapchain& swapchain = find_swapchain(handle);
    checked(info, XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, "waitInfo");
    if (info->timeout < 0) violation(XR_ERROR_VALIDATION_FAILURE, "timeout: expected 0 or more");
    if (swapchain.acquired.empty())
      violation(XR_ERROR_CALL_ORDER_INVALID, "found no acquired image, expected an acquire before");
    if (swapchain.waited)
      violation(XR_ERROR_CALL_ORDER_INVALID,
                "found an image waited for and not released, expected a release before");
    const int64_t frame = run().frame();
    if (contains(run().script.image_timeouts, frame) && swapchain.timed_out_at != frame &&
        info->timeout != XR_INFINITE_DURATION) {
      swapchain.timed_out_at = frame;
      return XR_TIMEOUT_EXPIRED;
    }
    swapchain.waited = true;
    return success(swapchain.session);
  });
}

XrResult xrReleaseSwapchainImage(XrSwapchain handle, const XrSwapchainImageReleaseInfo* info) {
  return call(__func__, [&](auto&) {
    Swapchain& swapchain = find_swapchain(handle);
    if (info) checked(info, XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO, "releaseInfo");
    if (!swapchain.waited)
      violation(XR_ERROR_CALL_ORDER_INVALID,
                "found no image waited for, expected xrWaitSwapchainImage before");
    const uint32_t released = swapchain.acquired.front();
    swapchain.acquired.pop_front();
    swapchain.images[released].acquired = false;
    swapchain.last_released = released;
    swapchain.waited = false;
    ++swapchain.releases;
    return success(swapchain.session);
  });
}
