#include "tools/view/truth.h"

#include <algorithm>
#include <cmath>

#include "tools/metrics/image_error.h"
#include "tools/renderer.h"

namespace voyager::view {
namespace {

constexpr uint32_t kSamples = 4;  // along each side of a pixel
constexpr int kGain = 8;          // of the difference that is shown

struct TruthStopped {};

void checkpoint(const std::atomic<bool>& stopped) {
  if (stopped) throw TruthStopped();
}

std::vector<uint8_t> truth_of(const TruthRequest& request, const std::atomic<bool>& stopped) {
  tools::RenderChoices choices;
  choices.backend = request.backend;
  choices.lod = VOY_LOD_ALL_LEAVES;
  choices.experiment.truth = 1;
  choices.supersample = kSamples;
  std::copy_n(request.background, 3, choices.background);
  checkpoint(stopped);
  tools::Renderer renderer(request.file, choices, request.camera.width, request.camera.height);
  checkpoint(stopped);
  renderer.render({&request.camera, 1});
  checkpoint(stopped);
  return renderer.image(0).rgba8;
}

tools::RgbaImage values(const std::vector<uint8_t>& rgba) {
  tools::RgbaImage out(rgba.size());
  std::transform(rgba.begin(), rgba.end(), out.begin(),
                 [](uint8_t code) { return static_cast<float>(code) / 255; });
  return out;
}

std::vector<uint8_t> difference(const std::vector<uint8_t>& picture,
                                const std::vector<uint8_t>& truth) {
  std::vector<uint8_t> out(picture.size(), 255);
  for (size_t i = 0; i < out.size(); ++i)
    if (i % 4 != 3)
      out[i] = static_cast<uint8_t>(std::clamp(128 + kGain * (picture[i] - truth[i]), 0, 255));
  return out;
}

}  // namespace

TruthJob::TruthJob(TruthRequest request)
    : request_(std::move(request)), thread_([this] { run(); }) {}

void TruthJob::run() {
  try {
    const std::vector<uint8_t> truth = truth_of(request_, stopped_);
    TruthResult result;
    result.psnr = tools::image_error({values(request_.rgba)}, {values(truth)}).psnr;
    result.width = request_.camera.width;
    result.height = request_.camera.height;
    result.difference = difference(request_.rgba, truth);
    result_ = std::move(result);
  } catch (const TruthStopped&) {
  } catch (const std::exception& problem) {
    error_ = refusal_of(problem);
  }
  done_ = true;
}

}  // namespace voyager::view
