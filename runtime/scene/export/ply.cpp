#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "runtime/scene/export/batch_check.h"
#include "runtime/scene/export/ply_comment.h"
#include "runtime/scene/export/writer.h"

namespace voyager {
namespace {

static_assert(std::endian::native == std::endian::little,
              "words are written as they lie in memory");

constexpr size_t kBlockBytes = 1 << 20;

std::string header(uint64_t count, int sh_degree, bool double_positions,
                   const NativeScale& native) {
  std::string text = std::string("ply\nformat binary_little_endian 1.0\n") +
                     filter_comment(native) + "element vertex " + std::to_string(count) + "\n";
  const auto add = [&](const std::string& name, const char* type = "float") {
    text += std::string("property ") + type + " " + name + "\n";
  };
  for (const char* axis : {"x", "y", "z"}) add(axis, double_positions ? "double" : "float");
  for (const char* axis : {"nx", "ny", "nz"}) add(axis);
  for (int i = 0; i < 3; ++i) add("f_dc_" + std::to_string(i));
  for (int i = 0; i < 3 * (sh_coefficients(sh_degree) - 1); ++i) add("f_rest_" + std::to_string(i));
  add("opacity");
  for (int i = 0; i < 3; ++i) add("scale_" + std::to_string(i));
  for (int i = 0; i < 4; ++i) add("rot_" + std::to_string(i));
  return text + "end_header\n";
}

class PlyWriter final : public GaussianWriter {
 public:
  PlyWriter(ByteSink& sink, uint64_t count, int sh_degree, bool double_positions,
            const NativeScale& native)
      : sink_(sink), check_(count, sh_degree), double_positions_(double_positions) {
    check_sh_degree(sh_degree);
    const std::string text = header(count, sh_degree, double_positions, native);
    sink_.write(std::as_bytes(std::span(text)));
    block_.reserve(kBlockBytes + 1024);
  }

  void append(const GaussianCloud& batch) override {
    const bool moved = batch.origin != std::array<double, 3>{0, 0, 0};
    if (moved && !double_positions_)
      throw Error(ErrorCode::invalid_argument,
                  "origin of a batch: found a non-zero one, expected zero, or double positions");
    check_.accept(batch);
    for (size_t i = 0; i < batch.size(); ++i) {
      put_row(batch, i);
      if (block_.size() >= kBlockBytes) flush();
    }
  }

  void finish() override {
    check_.finish();
    flush();
  }

 private:
  template <class T>
  void put(const T* values, size_t count) {
    const size_t at = block_.size();
    block_.resize(at + count * sizeof(T));
    std::memcpy(block_.data() + at, values, count * sizeof(T));
  }

  void put_row(const GaussianCloud& cloud, size_t i) {
    if (double_positions_) {
      for (size_t k = 0; k < 3; ++k) {
        const double world = cloud.origin[k] + static_cast<double>(cloud.position[3 * i + k]);
        put(&world, 1);
      }
    } else {
      put(&cloud.position[3 * i], 3);
    }
    const float normal[3] = {0.0f, 0.0f, 0.0f};
    put(normal, 3);
    const size_t coefficients = static_cast<size_t>(cloud.coefficients());
    const float* sh = &cloud.sh[i * coefficients * 3];
    put(sh, 3);
    for (size_t channel = 0; channel < 3; ++channel)
      for (size_t k = 1; k < coefficients; ++k) put(sh + 3 * k + channel, 1);
    put(&cloud.opacity[i], 1);
    put(&cloud.log_scale[3 * i], 3);
    put(&cloud.rotation[4 * i], 4);
  }

  void flush() {
    sink_.write(block_);
    block_.clear();
  }

  ByteSink& sink_;
  BatchCheck check_;
  bool double_positions_;
  std::vector<std::byte> block_;
};

}  // namespace

uint64_t ply_bytes(uint64_t count, int sh_degree, bool double_positions) {
  const auto sh = static_cast<uint64_t>(sh_coefficients(sh_degree)) * 3;
  return count * ((3 + sh + 1 + 3 + 4) * sizeof(float) +
                  3 * (double_positions ? sizeof(double) : sizeof(float)));
}

std::unique_ptr<GaussianWriter> write_ply(ByteSink& sink, uint64_t count, int sh_degree,
                                          bool double_positions, const NativeScale& native) {
  return std::make_unique<PlyWriter>(sink, count, sh_degree, double_positions, native);
}

}  // namespace voyager
