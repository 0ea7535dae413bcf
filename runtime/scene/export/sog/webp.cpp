#include <webp/encode.h>

#include <cmath>
#include <memory>
#include <new>

#include "runtime/scene/export/sog/files.h"

namespace voyager::sog_export {
namespace {

struct FreePicture {
  void operator()(WebPPicture* picture) const { WebPPictureFree(picture); }
};
struct ClearWriter {
  void operator()(WebPMemoryWriter* writer) const { WebPMemoryWriterClear(writer); }
};

}  // namespace

Image blank_image(uint32_t width, uint32_t height) {
  Image image{width, height, std::vector<uint8_t>(size_t{4} * width * height)};
  for (size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

Image image_of(uint64_t pixels) {
  const auto side = static_cast<uint64_t>(std::ceil(std::sqrt(static_cast<double>(pixels))));
  const uint64_t width = (side + 3) / 4 * 4;
  const uint64_t height = ((pixels + width - 1) / width + 3) / 4 * 4;
  return blank_image(static_cast<uint32_t>(width), static_cast<uint32_t>(height));
}

std::vector<std::byte> encode_webp(const Image& image) {
  WebPConfig config;
  WebPPicture picture;
  WebPMemoryWriter writer;
  if (!WebPConfigInit(&config) || !WebPPictureInit(&picture)) throw std::bad_alloc();
  WebPMemoryWriterInit(&writer);
  const std::unique_ptr<WebPPicture, FreePicture> picture_owner(&picture);
  const std::unique_ptr<WebPMemoryWriter, ClearWriter> writer_owner(&writer);
  config.lossless = 1;
  config.exact = 1;
  picture.use_argb = 1;
  picture.width = static_cast<int>(image.width);
  picture.height = static_cast<int>(image.height);
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  if (!WebPPictureImportRGBA(&picture, image.rgba.data(), 4 * picture.width) ||
      !WebPEncode(&config, &picture))
    throw std::bad_alloc();
  const auto bytes = std::as_bytes(std::span(writer.mem, writer.size));
  return {bytes.begin(), bytes.end()};
}

}  // namespace voyager::sog_export
