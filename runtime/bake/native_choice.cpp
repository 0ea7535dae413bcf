#include "runtime/bake/native_choice.h"

#include <charconv>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"

namespace voyager {
namespace {

std::string exactly(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace

std::string request_line(const NativeChoice& choice) {
  if (choice.pixel) return "native pixel " + exactly(*choice.pixel) + "\n";
  if (choice.cameras.empty()) return {};
  // Two sizes end a camera and no byte of it is padding.
  static_assert(sizeof(TrainingCamera) == 16 * sizeof(double) + 2 * sizeof(uint32_t));
  return "native pixel from cameras with checksum " +
         std::to_string(checksum(std::as_bytes(std::span(choice.cameras)))) + "\n";
}

FoundScale native_scale(const NativeChoice& choice, const NativeScale& of_inputs,
                        const NativePixelHistogram& pixels, std::span<const InputScales> inputs) {
  if (choice.pixel && !of_inputs.antialiased())
    return {{NativeSource::given, *choice.pixel, kPixelVariance}, {}, {}};
  std::optional<NativePixel> found;
  if (!choice.cameras.empty()) {
    found = pixels.find();
    if (found->looked_at != 0 && found->seen == 0)
      throw Error(ErrorCode::refused_input,
                  "training cameras: found none that sees a Gaussian of the scene, expected the "
                  "cameras of this scene, in its coordinates");
  }
  if (of_inputs.antialiased()) return {of_inputs, {}, {}};
  if (found) return {found->scale(), found, {}};
  if (of_inputs.source != NativeSource::unknown) return {of_inputs, {}, {}};
  JoinedScale joined = joined_scale(inputs);
  return {joined.scale, {}, std::move(joined.levels)};
}

FoundScale native_scale(const NativeChoice& choice, const GaussianCloud& cloud,
                        std::span<const uint32_t> ends) {
  NativePixelHistogram pixels(choice.cameras, cloud.report.read);
  if (!choice.pixel && !choice.cameras.empty()) pixels.add(cloud, 0);
  const uint32_t whole[] = {static_cast<uint32_t>(cloud.size())};
  if (ends.empty()) ends = whole;
  std::vector<InputScales> inputs;
  for (const uint32_t end : ends) {
    const uint32_t begin = inputs.empty() ? 0 : inputs.back().end;
    inputs.emplace_back().end = end;
    inputs.back().scales.add(cloud, begin, end);
  }
  return native_scale(choice, cloud.native, pixels, inputs);
}

}  // namespace voyager
