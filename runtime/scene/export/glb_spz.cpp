// A .glb whose primitive of KHR_gaussian_splatting is compressed: a whole .spz in its only view.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "runtime/scene/export/batch_check.h"
#include "runtime/scene/export/glb_container.h"
#include "runtime/scene/export/glb_document.h"
#include "runtime/scene/export/spz_writer.h"
#include "runtime/scene/gltf_format.h"

namespace voyager {
namespace {

// What is written here lies in the binary chunk.
class BinarySink final : public ByteSink {
 public:
  BinarySink(PlacedSink& inner, uint64_t begin) : inner_(inner), begin_(begin) {}
  void write(std::span<const std::byte> bytes) override {
    inner_.write_at(begin_ + written_, bytes);
    written_ += bytes.size();
  }
  uint64_t written() const { return written_; }

 private:
  PlacedSink& inner_;
  uint64_t begin_, written_ = 0;
};

class SpzGlbWriter final : public GaussianWriter {
 public:
  SpzGlbWriter(PlacedSink& sink, uint64_t count, int sh_degree, float reach, int version)
      : sink_(sink),
        check_(count, sh_degree),
        json_bytes_(bytes_of_json(count, sh_degree)),
        binary_(sink, glb::binary_at(json_bytes_)),
        bits_(spz_fractional_bits_inside(reach)),
        spz_(spz::write(binary_, count, sh_degree, {version, bits_, gltf::kToInria})) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    if (count == 0)
      throw Error(ErrorCode::unsupported, ".glb: found 0 Gaussians, expected 1 or more");
    document_.count = count;
    document_.sh_degree = sh_degree;
    document_.least.fill(kInfinity);
    document_.most.fill(-kInfinity);
  }

  void append(const GaussianCloud& batch) override {
    check_.accept_of_one_origin(batch);
    widen_bounds(batch);
    if (batch.origin == std::array<double, 3>{}) return spz_->append(batch);
    GaussianCloud local = batch;  // the node is at the origin
    local.origin = {};
    spz_->append(local);
  }

  void finish() override {
    check_.finish();
    spz_->finish();
    document_.spz_bytes = binary_.written();
    const std::byte zeros[3] = {};
    binary_.write(std::span(zeros).first((4 - binary_.written() % 4) % 4));
    const uint64_t bytes = glb::binary_at(json_bytes_) + binary_.written();
    if (bytes > std::numeric_limits<uint32_t>::max())
      throw Error(ErrorCode::unsupported,
                  ".glb: found " + std::to_string(bytes) + " bytes, expected at most 4294967295");
    for (size_t k = 0; k < 3; ++k)
      document_.translation[k] = gltf::kToInria.turned(check_.origin()[k], k);
    glb::write_head(sink_, glb::json(document_), json_bytes_, binary_.written());
  }

 private:
  static uint64_t bytes_of_json(uint64_t count, int sh_degree) {
    glb::Document document;
    document.count = count;
    document.sh_degree = sh_degree;
    document.spz_bytes = std::numeric_limits<uint32_t>::max();
    return (glb::json(document).size() + glb::kJsonSlack + 3) / 4 * 4;
  }

  // As positions come back.
  void widen_bounds(const GaussianCloud& batch) {
    for (size_t i = 0; i < batch.size(); ++i)
      for (size_t k = 0; k < 3; ++k) {
        const double position = gltf::kToInria.turned(double{batch.position[3 * i + k]}, k);
        const auto at =
            static_cast<float>(std::ldexp(std::round(std::ldexp(position, bits_)), -bits_) + 0.0);
        document_.least[k] = std::min(document_.least[k], at);
        document_.most[k] = std::max(document_.most[k], at);
      }
  }

  PlacedSink& sink_;
  BatchCheck check_;
  uint64_t json_bytes_;
  BinarySink binary_;
  int bits_;  // of a position after the point
  std::unique_ptr<GaussianWriter> spz_;
  glb::Document document_;
};

}  // namespace

std::unique_ptr<GaussianWriter> write_spz_glb(PlacedSink& sink, uint64_t count, int sh_degree,
                                              float largest_coordinate, int version) {
  check_sh_degree(sh_degree);
  return std::make_unique<SpzGlbWriter>(sink, count, sh_degree, largest_coordinate, version);
}

}  // namespace voyager
