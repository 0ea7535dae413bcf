#include "runtime/scene/import/gltf/accessor_blocks.h"

#include <algorithm>

#include "runtime/math/byte_code.h"
#include "runtime/scene/gltf_format.h"
#include "runtime/scene/sanitise.h"

namespace voyager::gltf {
namespace {

// Without a minus before a zero.
float minus(double value) {
  return static_cast<float>(0.0 - value);
}

class AccessorReader final : public BlockReader {
 public:
  AccessorReader(std::string name, Primitive primitive)
      : name_(std::move(name)), primitive_(std::move(primitive)) {
    for (const Attribute& attribute : primitive_.attributes) stride_ += attribute.accessor.stride;
  }

  const std::string& name() const override { return name_; }
  uint64_t count() const override { return primitive_.count; }
  int sh_degree() const override { return primitive_.sh_degree; }
  NativeScale native() const override { return {}; }

  RawBlock next(size_t most) override {
    RawBlock block;
    const uint64_t left = primitive_.count - taken_;
    block.count = static_cast<size_t>(
        std::min<uint64_t>({most, left, std::max<size_t>(1, kMostBlockBytes / stride_)}));
    if (block.count == 0) return block;
    size_t bytes = 0;
    for (const Attribute& attribute : primitive_.attributes)
      bytes += attribute.accessor.span_of(block.count);
    block.bytes.resize(bytes);
    std::span<std::byte> rest(block.bytes);
    for (const Attribute& attribute : primitive_.attributes) {
      const size_t span = attribute.accessor.span_of(block.count);
      attribute.accessor.read(taken_, rest.first(span));
      rest = rest.subspan(span);
    }
    taken_ += block.count;
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud;
    cloud.sh_degree = primitive_.sh_degree;
    cloud.position.resize(3 * block.count);
    cloud.log_scale.resize(3 * block.count);
    cloud.rotation.resize(4 * block.count);
    cloud.opacity.resize(block.count);
    cloud.sh.resize(block.count * static_cast<size_t>(cloud.coefficients()) * 3);
    if (block.count == 0) return cloud;
    std::span<const std::byte> rest(block.bytes);
    for (const Attribute& attribute : primitive_.attributes) {
      const Accessor& accessor = attribute.accessor;
      for (size_t i = 0; i < block.count; ++i) {
        double numbers[4] = {};
        for (size_t k = 0; k < accessor.width; ++k)
          numbers[k] = accessor.number(rest.subspan(i * accessor.stride), k);
        store(attribute, numbers, i, cloud);
      }
      rest = rest.subspan(accessor.span_of(block.count));
    }
    return cloud;
  }

 private:
  void store(const Attribute& attribute, std::span<const double, 4> v, size_t i,
             GaussianCloud& cloud) const {
    const size_t coefficients = static_cast<size_t>(cloud.coefficients());
    float* sh = cloud.sh.data() + (i * coefficients + attribute.k) * 3;
    switch (attribute.parameter) {
      case Parameter::position:
        for (size_t k = 0; k < 3; ++k)
          cloud.position[3 * i + k] = static_cast<float>(kToInria.turned(v[k], k));
        return;
      case Parameter::rotation:
        return store_rotation(v, std::span<float, 4>(&cloud.rotation[4 * i], 4));
      case Parameter::scale:
        for (size_t k = 0; k < 3; ++k)  // a flat disc has a scale of 0
          cloud.log_scale[3 * i + k] =
              primitive_.log_scales ? static_cast<float>(v[k]) : log_of_scale(v[k], kMinLogScale);
        return;
      case Parameter::opacity:
        cloud.opacity[i] = logit_of_opacity(v[0]);
        return;
      case Parameter::colour_opacity:
        cloud.opacity[i] = logit_of_opacity(v[3]);
        return;
      case Parameter::colour:
        for (size_t k = 0; k < 3; ++k) sh[k] = sh_of_colour(v[k]);
        return;
      case Parameter::sh:
        for (size_t k = 0; k < 3; ++k) sh[k] = static_cast<float>(kToInria.sh[attribute.k] * v[k]);
    }
  }

  // The half turn before x, y, z, w, and not after it too: the Gaussian's own axes are free to
  // stay.
  static void store_rotation(std::span<const double, 4> v, std::span<float, 4> wxyz) {
    wxyz[0] = static_cast<float>(v[2]), wxyz[1] = static_cast<float>(v[1]);
    wxyz[2] = minus(v[0]), wxyz[3] = minus(v[3]);
  }

  std::string name_;
  Primitive primitive_;
  size_t stride_ = 0;   // bytes of a Gaussian
  uint64_t taken_ = 0;  // Gaussians
};

}  // namespace

std::unique_ptr<BlockReader> read_accessors(std::string name, Primitive primitive) {
  return std::make_unique<AccessorReader>(std::move(name), std::move(primitive));
}

}  // namespace voyager::gltf
