#include "tools/report/kept_image.h"

#include "runtime/base/file.h"

namespace voyager::tools {

RgbaImage kept_image(const std::filesystem::path& path, const voyager::Camera& camera,
                     const std::function<RgbaImage()>& draw) {
  RgbaImage image(size_t{4} * camera.width * camera.height);
  if (std::filesystem::exists(path)) {
    const auto source = open_file_source(path.string());
    if (source->size() == image.size() * sizeof(float)) {
      source->read(0, std::as_writable_bytes(std::span(image)));
      return image;
    }
  }
  image = draw();
  AtomicFile file(path.string());
  file.write(std::as_bytes(std::span(image)));
  file.commit();
  return image;
}

}  // namespace voyager::tools
