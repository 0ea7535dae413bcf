// A .glb: glTF's binary container with one primitive of KHR_gaussian_splatting.
#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <vector>

#include "runtime/math/gaussian.h"
#include "runtime/scene/export/batch_check.h"
#include "runtime/scene/export/glb_container.h"
#include "runtime/scene/export/glb_document.h"
#include "runtime/scene/export/writer.h"
#include "runtime/scene/gltf_format.h"

namespace voyager {
namespace {

using namespace glb;

static_assert(std::endian::native == std::endian::little,
              "words are written as they lie in memory");

uint64_t glb_gaussian_bytes(int sh_degree) {
  return (3 + 4 + 3 + 1 + 3 * static_cast<uint64_t>(sh_coefficients(sh_degree))) * sizeof(float);
}

class GlbWriter final : public GaussianWriter {
 public:
  GlbWriter(PlacedSink& sink, uint64_t count, int sh_degree)
      : sink_(sink), check_(count, sh_degree), arrays_(attributes(sh_degree)) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    document_.count = count;
    document_.sh_degree = sh_degree;
    json_bytes_ = (json(document_).size() + kJsonSlack + 3) / 4 * 4;
    check_size();
    document_.least.fill(kInfinity);
    document_.most.fill(-kInfinity);
  }

  void append(const GaussianCloud& batch) override {
    const uint64_t first = check_.written();
    check_.accept_of_one_origin(batch);
    widen_bounds(batch);
    uint64_t array_at = binary_at(json_bytes_);
    for (size_t i = 0; i < arrays_.size(); ++i) {
      const size_t components = arrays_[i].components;
      values_.clear();
      put_array(batch, i);
      sink_.write_at(array_at + first * components * sizeof(float),
                     std::as_bytes(std::span(values_)));
      array_at += document_.count * components * sizeof(float);
    }
  }

  void finish() override {
    check_.finish();
    for (size_t k = 0; k < 3; ++k)
      document_.translation[k] = gltf::kToInria.turned(check_.origin()[k], k);
    write_head(sink_, json(document_), json_bytes_, binary_bytes());
  }

 private:
  uint64_t binary_bytes() const {
    return document_.count * glb_gaussian_bytes(document_.sh_degree);
  }

  // glTF counts bytes in 32 bits, and has no array of no elements.
  void check_size() const {
    constexpr uint64_t kMostBytes = std::numeric_limits<uint32_t>::max();
    const uint64_t most =
        (kMostBytes - binary_at(json_bytes_)) / glb_gaussian_bytes(document_.sh_degree);
    if (document_.count == 0 || document_.count > most)
      throw Error(ErrorCode::unsupported, ".glb: found " + std::to_string(document_.count) +
                                              " Gaussians of SH degree " +
                                              std::to_string(document_.sh_degree) +
                                              ", expected 1 to " + std::to_string(most));
  }

  void widen_bounds(const GaussianCloud& batch) {
    for (size_t i = 0; i < batch.size(); ++i)
      for (size_t k = 0; k < 3; ++k) {
        const float at = gltf::kToInria.turned(batch.position[3 * i + k], k);
        document_.least[k] = std::min(document_.least[k], at);
        document_.most[k] = std::max(document_.most[k], at);
      }
  }

  void put_array(const GaussianCloud& cloud, size_t array) {
    for (size_t i = 0; i < cloud.size(); ++i) {
      if (array < 4)
        put_shape(activate(cloud.words(i), true), array);
      else
        put_sh(cloud, i, array - 4);
    }
  }

  void put(std::initializer_list<float> values) { values_.insert(values_.end(), values); }

  void put_shape(const Gaussian& g, size_t array) {
    const Vec3f mean = gltf::kToInria * g.mean;
    const Quatf rotation = gltf::kToInria * g.rotation;
    switch (array) {
      case 0:
        return put({mean.x, mean.y, mean.z});
      case 1:
        return put({rotation.x, rotation.y, rotation.z, rotation.w});
      case 2:
        return put({g.scale.x, g.scale.y, g.scale.z});
      default:
        return put({g.opacity});
    }
  }

  void put_sh(const GaussianCloud& cloud, size_t i, size_t k) {
    const auto sign = static_cast<float>(gltf::kToInria.sh[k]);
    const float* rgb = &cloud.sh[(i * static_cast<size_t>(cloud.coefficients()) + k) * 3];
    put({sign * rgb[0], sign * rgb[1], sign * rgb[2]});
  }

  PlacedSink& sink_;
  BatchCheck check_;
  std::vector<Attribute> arrays_;
  Document document_;
  uint64_t json_bytes_ = 0;  // with the spaces that fill it up
  std::vector<float> values_;
};

}  // namespace

uint64_t glb_bytes(uint64_t count, int sh_degree) {
  return count * glb_gaussian_bytes(sh_degree);
}

std::unique_ptr<GaussianWriter> write_glb(PlacedSink& sink, uint64_t count, int sh_degree) {
  check_sh_degree(sh_degree);
  return std::make_unique<GlbWriter>(sink, count, sh_degree);
}

}  // namespace voyager
