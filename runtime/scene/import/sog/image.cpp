#include "runtime/scene/import/sog/image.h"

#include <webp/decode.h>

#include "runtime/scene/import/refuse.h"

namespace voyager::sog {

Image decode_webp(const std::string& scene, const std::string& file,
                  std::span<const std::byte> bytes, const PixelRange& pixels, PixelBudget* budget) {
  constexpr int kLossless = 2;
  const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(data, bytes.size(), &features) != VP8_STATUS_OK)
    refuse(scene, 0, file, "no WebP header", "a lossless WebP image");
  if (features.has_animation != 0 || features.format != kLossless)
    refuse(scene, 0, file, features.has_animation != 0 ? "an animation" : "a lossy WebP image",
           "a lossless WebP image");
  Image image{static_cast<uint32_t>(features.width), static_cast<uint32_t>(features.height), {}};
  if (image.pixels() < pixels.least || image.pixels() > pixels.most)
    refuse(scene, 0, file,
           std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels",
           std::to_string(pixels.least) + " to " + std::to_string(pixels.most) + " pixels");
  if (budget && image.pixels() > budget->most - budget->used)
    refuse(scene, 0, file,
           std::to_string(budget->used + image.pixels()) + " pixels of this and earlier images",
           "at most " + std::to_string(budget->most) + " in files of their size");
  if (budget) budget->used += image.pixels();
  image.rgba.resize(static_cast<size_t>(4 * image.pixels()));
  const int stride = static_cast<int>(4 * image.width);
  if (!WebPDecodeRGBAInto(data, bytes.size(), image.rgba.data(), image.rgba.size(), stride))
    refuse(scene, 0, file, "damaged WebP data", "a lossless WebP image");
  return image;
}

}  // namespace voyager::sog
