#include "tools/report/compare_images.h"

#include "tools/metrics/flip.h"
#include "tools/metrics/image_error.h"
#include "tools/metrics/popping.h"
#include "tools/metrics/ssim.h"

namespace voyager::tools {
namespace {

// Of one image.
struct Difference {
  Flip flip;
  std::optional<double> ssim;
};

Difference difference(const RgbaImage& image, const RgbaImage& expected, size_t width) {
  Difference found{flip(image, expected, width), std::nullopt};
  if (std::min(width, image.size() / 4 / width) >= kSsimWindow)
    found.ssim = ssim(image, expected, width);
  return found;
}

// No SSIM where one image has none.
ReportError means(const std::vector<Difference>& found) {
  const auto count = static_cast<double>(found.size());
  ReportError error;
  error.ssim = 0.0;
  for (const Difference& of : found) {
    error.flip += of.flip.mean / count;
    error.ssim =
        error.ssim && of.ssim ? std::optional(*error.ssim + *of.ssim / count) : std::nullopt;
  }
  return error;
}

// Cameras of a file may differ in size: there is no change from one to the other then.
std::optional<double> mean_popping(const std::vector<RgbaImage>& images,
                                   const std::vector<RgbaImage>& expected,
                                   const std::vector<ComparedFrame>& frames) {
  double sum = 0;
  size_t changes = 0;
  for (size_t i = 1; i < images.size(); ++i) {
    const bool follows = frames[i - 1].index + 1 == frames[i].index;
    const bool same_size =
        frames[i - 1].width == frames[i].width && images[i - 1].size() == images[i].size();
    if (!follows || !same_size) continue;
    Popping popping;
    popping.add(images[i - 1], expected[i - 1]);
    popping.add(images[i], expected[i]);
    sum += popping.mean();
    ++changes;
  }
  if (changes == 0) return std::nullopt;
  return sum / static_cast<double>(changes);
}

}  // namespace

ReportError compare_images(const std::vector<RgbaImage>& images,
                           const std::vector<RgbaImage>& expected,
                           const std::vector<ComparedFrame>& frames, Workers& workers,
                           std::vector<float>* first_flip) {
  std::vector<Difference> found(images.size());
  workers.for_blocks(images.size(), 1, [&](size_t i, size_t) {
    found[i] = difference(images[i], expected[i], frames[i].width);
    if (first_flip == nullptr || i != 0) found[i].flip.map = {};
  });
  ReportError error = means(found);
  if (first_flip != nullptr) *first_flip = std::move(found[0].flip.map);
  error.popping = mean_popping(images, expected, frames);
  const ImageError pixels = image_error(images, expected);
  error.psnr = pixels.psnr;
  error.largest = pixels.largest;
  error.p999 = pixels.p999;
  error.not_finite = pixels.not_finite;
  return error;
}

}  // namespace voyager::tools
