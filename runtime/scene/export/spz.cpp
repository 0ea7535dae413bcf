#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "runtime/scene/export/batch_check.h"
#include "runtime/scene/export/gzip_sink.h"
#include "runtime/scene/export/spool.h"
#include "runtime/scene/export/spz_quantise.h"
#include "runtime/scene/export/spz_writer.h"
#include "runtime/scene/export/writer.h"

namespace voyager {
namespace {

constexpr int kUsualFractionalBits = 12, kMostFractionalBits = 20;
constexpr double kStepsInside = 1 << 17;  // to the largest coordinate
constexpr double kMostSteps = (1 << 23) - 1;
constexpr size_t kBlockGaussians = 4096;
using Bytes = std::vector<std::byte>;

void put(Bytes& bytes, uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
}

class SpzWriter final : public GaussianWriter {
 public:
  SpzWriter(ByteSink& sink, uint64_t count, int sh_degree, const spz::WriterOptions& options)
      : sink_(sink),
        check_(count, sh_degree),
        count_(count),
        sh_degree_(sh_degree),
        version_(options.version),
        bits_(options.fractional_bits),
        to_inria_(options.to_inria),
        streams_(sh_degree > 0 ? spz::kAttributes : spz::kSh) {
    check_sh_degree(sh_degree);
    if (version_ != 3 && version_ != 4)
      throw Error(ErrorCode::invalid_argument,
                  ".spz: found version " + std::to_string(version_) + ", expected 3 or 4");
    if (count > std::numeric_limits<uint32_t>::max())
      throw Error(ErrorCode::invalid_argument, ".spz: found " + std::to_string(count) +
                                                   " Gaussians, expected at most 4294967295");
    for (int i = 0; i < streams_; ++i) spools_.emplace_back(uncompressed_size(i));
  }

  void append(const GaussianCloud& batch) override {
    const uint64_t first = check_.written();
    check_.accept(batch);
    antialiased_ = antialiased_ || batch.native.antialiased();
    for (size_t begin = 0; begin < batch.size(); begin += kBlockGaussians) {
      const size_t end = std::min(batch.size(), begin + kBlockGaussians);
      for (size_t i = begin; i < end; ++i) put_gaussian(batch, i, first + i);
      for (int i = 0; i < streams_; ++i) {
        spools_[static_cast<size_t>(i)].write(blocks_[i]);
        blocks_[i].clear();
      }
    }
  }

  void finish() override {
    check_.finish();
    for (Spool& spool : spools_) spool.close();
    version_ == 4 ? write_streams() : write_planar();
  }

 private:
  uint64_t uncompressed_size(int stream) const {
    return count_ * spz::width(static_cast<spz::Attribute>(stream), 4, sh_degree_);
  }

  void put_gaussian(const GaussianCloud& cloud, size_t i, uint64_t index) {
    for (size_t k = 0; k < 3; ++k) put_position(cloud, i, k, index);
    put(blocks_[spz::kAlphas], spz::quantise_alpha(cloud.opacity[i]), 1);
    const size_t coefficients = static_cast<size_t>(cloud.coefficients());
    const float* sh = &cloud.sh[i * coefficients * 3];
    for (size_t k = 0; k < 3; ++k) {
      put(blocks_[spz::kColours], spz::quantise_colour(sh[k]), 1);
      put(blocks_[spz::kScales], spz::quantise_scale(cloud.log_scale[3 * i + k]), 1);
    }
    put(blocks_[spz::kRotations], spz::quantise_rotation(cloud.words(i).rotation, to_inria_), 4);
    for (size_t k = 1; k < coefficients; ++k)
      for (size_t channel = 0; channel < 3; ++channel)
        put(blocks_[spz::kSh], spz::quantise_sh(sh[3 * k + channel], to_inria_.sh[k]), 1);
  }

  void put_position(const GaussianCloud& cloud, size_t i, size_t axis, uint64_t index) {
    const double world = cloud.origin[axis] + static_cast<double>(cloud.position[3 * i + axis]);
    const double steps = std::round(to_inria_.turned(world, axis) * (1 << bits_));
    if (!(std::fabs(steps) <= kMostSteps))
      throw Error(ErrorCode::invalid_argument,
                  ".spz: Gaussian " + std::to_string(index) + ", coordinate " + "xyz"[axis] +
                      ": found " + std::to_string(world) + " m, expected at most " +
                      std::to_string(kMostSteps / (1 << bits_)) + " m either way");
    put(blocks_[spz::kPositions], static_cast<uint64_t>(static_cast<int64_t>(steps)), 3);
  }

  void write_planar() {
    GzipSink gzip(sink_);
    gzip.write(header(0));
    for (Spool& spool : spools_) spool.copy_decompressed_to(gzip);
    gzip.close();
  }

  void write_streams() {
    Bytes bytes = header(streams_);
    put(bytes, spz::kStreamsHeaderBytes, 4);
    bytes.resize(spz::kStreamsHeaderBytes);
    for (int i = 0; i < streams_; ++i) {
      put(bytes, spools_[static_cast<size_t>(i)].compressed_size(), 8);
      put(bytes, uncompressed_size(i), 8);
    }
    sink_.write(bytes);
    for (Spool& spool : spools_) spool.copy_to(sink_);
  }

  // What all versions begin with; `last` is their own byte.
  Bytes header(int last) const {
    Bytes bytes;
    put(bytes, spz::kMagic, 4);
    put(bytes, static_cast<uint64_t>(version_), 4);
    put(bytes, count_, 4);
    put(bytes, static_cast<uint64_t>(sh_degree_), 1);
    put(bytes, static_cast<uint64_t>(bits_), 1);
    put(bytes, antialiased_ ? spz::kFlagAntialiased : 0, 1);
    put(bytes, static_cast<uint64_t>(last), 1);
    return bytes;
  }

  ByteSink& sink_;
  BatchCheck check_;
  uint64_t count_;
  int sh_degree_, version_, bits_;
  HalfTurn to_inria_;
  int streams_;
  bool antialiased_ = false;
  std::vector<Spool> spools_;
  Bytes blocks_[spz::kAttributes];
};

}  // namespace

int spz_fractional_bits(float largest_coordinate) {
  int bits = kUsualFractionalBits;
  while (bits > 0 && double{largest_coordinate} * (1 << bits) > kMostSteps) --bits;
  return bits;
}

int spz_fractional_bits_inside(float largest_coordinate) {
  int bits = spz_fractional_bits(largest_coordinate);
  while (bits >= kUsualFractionalBits && bits < kMostFractionalBits &&
         double{largest_coordinate} * (1 << bits) < kStepsInside)
    ++bits;
  return bits;
}

std::unique_ptr<GaussianWriter> spz::write(ByteSink& sink, uint64_t count, int sh_degree,
                                           const WriterOptions& options) {
  return std::make_unique<SpzWriter>(sink, count, sh_degree, options);
}

std::unique_ptr<GaussianWriter> write_spz(ByteSink& sink, uint64_t count, int sh_degree,
                                          float largest_coordinate, int version) {
  return spz::write(sink, count, sh_degree,
                    {version, spz_fractional_bits(largest_coordinate), spz::kToInria});
}

}  // namespace voyager
