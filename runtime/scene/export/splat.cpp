// antimatter15's .splat: 32 bytes a Gaussian, no header.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "runtime/math/gaussian.h"
#include "runtime/math/sh.h"
#include "runtime/scene/export/batch_check.h"
#include "runtime/scene/export/unit_code.h"
#include "runtime/scene/export/writer.h"

namespace voyager {
namespace {

static_assert(std::endian::native == std::endian::little,
              "words are written as they lie in memory");

constexpr size_t kRowsInBlock = 1 << 15;

struct SplatRow {
  float position[3], scale[3];
  uint8_t colour[4], rotation[4];
};
static_assert(sizeof(SplatRow) == kSplatBytes);

// Of a component of a unit quaternion, in steps of 1/128 about 128: 1 is one step beyond the last.
uint8_t rotation_byte(float component) {
  return static_cast<uint8_t>(std::fmin(std::fmax(component * 128.0f + 128.5f, 0.0f), 255.0f));
}

SplatRow splat_row(const GaussianCloud& cloud, size_t i) {
  const Gaussian g = activate(cloud.words(i), true);
  SplatRow row;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<size_t>(k);
    row.position[k] =
        static_cast<float>(cloud.origin[axis] + static_cast<double>(cloud.position[3 * i + axis]));
    row.scale[k] = g.scale[k];
    const float f_dc = cloud.sh[i * static_cast<size_t>(cloud.coefficients()) * 3 + axis];
    row.colour[k] = static_cast<uint8_t>(unit_code(flat_colour(f_dc), 8));
  }
  row.colour[3] = static_cast<uint8_t>(unit_code(g.opacity, 8));
  const float q[4] = {g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z};
  std::transform(q, q + 4, row.rotation, rotation_byte);
  return row;
}

class SplatWriter final : public GaussianWriter {
 public:
  SplatWriter(ByteSink& sink, uint64_t count, int sh_degree)
      : sink_(sink), check_(count, sh_degree) {
    check_sh_degree(sh_degree);
  }

  void append(const GaussianCloud& batch) override {
    check_.accept(batch);
    for (size_t i = 0; i < batch.size(); ++i) {
      rows_.push_back(splat_row(batch, i));
      if (rows_.size() == kRowsInBlock) flush();
    }
  }

  void finish() override {
    check_.finish();
    flush();
  }

 private:
  void flush() {
    sink_.write(std::as_bytes(std::span(rows_)));
    rows_.clear();
  }

  ByteSink& sink_;
  BatchCheck check_;
  std::vector<SplatRow> rows_;
};

}  // namespace

std::unique_ptr<GaussianWriter> write_splat(ByteSink& sink, uint64_t count, int sh_degree) {
  return std::make_unique<SplatWriter>(sink, count, sh_degree);
}

}  // namespace voyager
