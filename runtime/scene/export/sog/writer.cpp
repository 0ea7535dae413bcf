// A .sog: PlayCanvas' images of codes, in a zip.
#include "runtime/scene/export/sog/writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "runtime/math/byte_code.h"
#include "runtime/math/gaussian.h"
#include "runtime/math/signed_log.h"
#include "runtime/scene/append.h"
#include "runtime/scene/export/batch_check.h"
#include "runtime/scene/export/morton_order.h"
#include "runtime/scene/export/sog/codebook.h"
#include "runtime/scene/export/sog/files.h"
#include "runtime/scene/export/sog/sh_sets.h"
#include "runtime/scene/export/unit_code.h"
#include "runtime/scene/export/writer.h"

namespace voyager::sog_export {
namespace {

using Json = nlohmann::json;

constexpr uint32_t kSetsARow = 64;      // of the image of SH sets
constexpr size_t kMostSets = 1 << 16;   // a label has two bytes
constexpr uint8_t kFirstLargest = 252;  // of a rotation: w; then x, y, z

struct Span {
  double least = std::numeric_limits<double>::infinity(), most = -least;

  void add(double v) { least = std::min(least, v), most = std::max(most, v); }
  uint32_t code(double v) const {
    return most > least ? static_cast<uint32_t>((v - least) / (most - least) * 65535 + 0.5) : 0;
  }
};

void require_finite(const GaussianCloud& batch) {
  for (const auto* values :
       {&batch.position, &batch.log_scale, &batch.rotation, &batch.opacity, &batch.sh})
    if (!std::all_of(values->begin(), values->end(), [](float v) { return std::isfinite(v); }))
      throw Error(ErrorCode::invalid_argument,
                  ".sog: found a number that is not finite, expected finite ones");
}

void put_rotation(const Quatf& q, uint8_t* pixel) {
  const SmallestThree three = smallest_three({q.w, q.x, q.y, q.z});
  for (const float other : three.others)
    *pixel++ = static_cast<uint8_t>(unit_code((other + kSqrtHalf) / (2 * kSqrtHalf), 8));
  *pixel = static_cast<uint8_t>(kFirstLargest + three.largest);
}

class SogWriter final : public GaussianWriter {
 public:
  SogWriter(ByteSink& sink, uint64_t count, int sh_degree, const NativeScale& native)
      : sink_(sink), check_(count, sh_degree), antialiased_(native.antialiased()) {
    if (count == 0 || count > kMostPixels)
      throw Error(ErrorCode::unsupported, ".sog: found " + std::to_string(count) +
                                              " Gaussians, expected 1 to " +
                                              std::to_string(kMostPixels));
    cloud_.sh_degree = sh_degree;
  }

  void append(const GaussianCloud& batch) override {
    check_.accept_of_one_origin(batch);
    require_finite(batch);
    const auto add = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    add(cloud_.position, batch.position);
    add(cloud_.log_scale, batch.log_scale);
    add(cloud_.rotation, batch.rotation);
    add(cloud_.opacity, batch.opacity);
    add(cloud_.sh, batch.sh);
  }

  void finish() override {
    check_.finish();
    order_ = morton_order(cloud_.position);
    meta_ = {{"version", 2}, {"asset", {{"generator", "Voyager"}}}, {"count", cloud_.size()}};
    if (antialiased_) meta_["antialias"] = true;
    add_means();
    add_scales();
    add_rotations();
    add_colours();
    if (cloud_.sh_degree > 0) add_sh();
    const std::string text = meta_.dump();
    const auto bytes = std::as_bytes(std::span(text));
    files_.emplace_back("meta.json", std::vector(bytes.begin(), bytes.end()));
    sink_.write(zip_of(files_));
  }

 private:
  size_t width() const { return static_cast<size_t>(cloud_.coefficients()) * 3; }

  void add_file(const char* parameter, const std::string& name, const Image& image) {
    meta_[parameter]["files"].push_back(name);
    files_.emplace_back(name, encode_webp(image));
  }

  // `put` gets a Gaussian's index and its pixel.
  template <class Put>
  void add_image(const char* parameter, const std::string& name, const Put& put) {
    Image image = image_of(cloud_.size());
    for (size_t i = 0; i < order_.size(); ++i) put(size_t{order_[i]}, image.pixel(i));
    add_file(parameter, name, image);
  }

  double mapped_position(size_t i, size_t axis) const {
    return signed_log(check_.origin()[axis] + double{cloud_.position[3 * i + axis]});
  }

  void add_means() {
    Span spans[3];
    for (size_t i = 0; i < cloud_.size(); ++i)
      for (size_t axis = 0; axis < 3; ++axis) spans[axis].add(mapped_position(i, axis));
    for (const Span& span : spans) {
      meta_["means"]["mins"].push_back(span.least);
      meta_["means"]["maxs"].push_back(span.most);
    }
    for (const auto& [name, shift] : {std::pair("means_l.webp", 0), {"means_u.webp", 8}})
      add_image("means", name, [&, shift = shift](size_t i, uint8_t* pixel) {
        for (size_t axis = 0; axis < 3; ++axis)
          pixel[axis] =
              static_cast<uint8_t>(spans[axis].code(mapped_position(i, axis)) >> shift & 255);
      });
  }

  void add_scales() {
    const Codebook codebook = codebook_of({cloud_.log_scale.begin(), cloud_.log_scale.end()});
    meta_["scales"]["codebook"] = codebook;
    add_image("scales", "scales.webp", [&](size_t i, uint8_t* pixel) {
      for (size_t axis = 0; axis < 3; ++axis)
        pixel[axis] = code_of(codebook, cloud_.log_scale[3 * i + axis]);
    });
  }

  void add_rotations() {
    add_image("quats", "quats.webp", [&](size_t i, uint8_t* pixel) {
      put_rotation(activate(cloud_.words(i), true).rotation, pixel);
    });
  }

  void add_colours() {
    std::vector<float> values;
    for (size_t i = 0; i < cloud_.size(); ++i)
      values.insert(values.end(), &cloud_.sh[i * width()], &cloud_.sh[i * width()] + 3);
    const Codebook codebook = codebook_of(std::move(values));
    meta_["sh0"]["codebook"] = codebook;
    add_image("sh0", "sh0.webp", [&](size_t i, uint8_t* pixel) {
      for (size_t channel = 0; channel < 3; ++channel)
        pixel[channel] = code_of(codebook, cloud_.sh[i * width() + channel]);
      pixel[3] = static_cast<uint8_t>(unit_code(activate(cloud_.words(i), true).opacity, 8));
    });
  }

  void add_sh() {
    const size_t each = width() - 3;
    const ShSets sets = sh_sets_of({cloud_.sh.data() + 3, cloud_.size(), each, width()},
                                   std::bit_floor(std::min(cloud_.size(), kMostSets)));
    const Codebook codebook = codebook_of(sets.values);
    const size_t count = sets.values.size() / each;
    meta_["shN"] = {{"count", count}, {"bands", cloud_.sh_degree}, {"codebook", codebook}};
    Image centroids = blank_image(kSetsARow * static_cast<uint32_t>(each / 3),
                                  static_cast<uint32_t>((count + kSetsARow - 1) / kSetsARow));
    for (size_t i = 0; i < sets.values.size(); ++i)
      centroids.pixel(i / 3)[i % 3] = code_of(codebook, sets.values[i]);
    add_file("shN", "shN_centroids.webp", centroids);
    add_image("shN", "shN_labels.webp", [&](size_t i, uint8_t* pixel) {
      pixel[0] = static_cast<uint8_t>(sets.labels[i] & 255);
      pixel[1] = static_cast<uint8_t>(sets.labels[i] >> 8);
    });
  }

  ByteSink& sink_;
  BatchCheck check_;
  bool antialiased_;
  GaussianCloud cloud_;
  std::vector<uint32_t> order_;
  Json meta_;
  NamedFiles files_;
};

}  // namespace

std::unique_ptr<GaussianWriter> write(ByteSink& sink, uint64_t count, int sh_degree,
                                      const NativeScale& native) {
  check_sh_degree(sh_degree);
  return std::make_unique<SogWriter>(sink, count, sh_degree, native);
}

}  // namespace voyager::sog_export
