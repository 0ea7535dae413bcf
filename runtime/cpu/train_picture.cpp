#include "runtime/cpu/train_picture.h"

#include <algorithm>
#include <cmath>

#include "runtime/stages/bin.h"
#include "runtime/stages/blend_gradient.h"

namespace voyager {
namespace {

constexpr size_t kItemsBlock = 2048;
constexpr uint32_t kNowhere = 0xffffffffu;

// α of METHOD §6 at a pixel, and where that is in the conic's axes. False outside the support.
struct Alpha {
  float plain, p, q;
};
bool alpha_at(const Splat& s, int x, int y, Alpha& at) {
  const float dx = static_cast<float>(x) + 0.5f - s.x, dy = static_cast<float>(y) + 0.5f - s.y;
  at.p = dx * s.conic.p_x;
  at.q = (dy - s.conic.skew * dx) * s.conic.q_y;
  const float rho = -(at.p * at.p + at.q * at.q);
  if (!(rho >= s.rho_min)) return false;
  const float log_alpha = s.log_opacity + rho;
  at.plain = log_alpha < 0.0f ? exp_negative(log_alpha) : 1.0f;
  return true;
}

int at_most(float x, int most) {
  return static_cast<int>(std::clamp(x, 0.0f, static_cast<float>(most)));
}

}  // namespace

TrainPicture::TrainPicture(const ProjectParams& params, const GaussianArrays& arrays,
                           std::span<const DrawItem> items, Workers& workers)
    : width_(static_cast<int>(params.width)),
      height_(static_cast<int>(params.height)),
      columns_((width_ + kTile - 1) / kTile),
      rows_((height_ + kTile - 1) / kTile),
      items_(items.size()),
      pixels_(static_cast<size_t>(width_) * static_cast<size_t>(height_)) {
  std::vector<std::vector<Listed>> found((items.size() + kItemsBlock - 1) / kItemsBlock);
  workers.for_blocks(items.size(), kItemsBlock, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      DrawnGaussian drawn;
      Listed listed{{}, static_cast<uint32_t>(i)};
      if (read_gaussian(params, arrays, items[i], drawn) &&
          project(params, arrays, items[i], drawn, listed.splat))
        found[begin / kItemsBlock].push_back(listed);
    }
  });
  for (const auto& block : found) splats_.insert(splats_.end(), block.begin(), block.end());
  workers.sort(splats_.begin(), splats_.end(), [](const Listed& a, const Listed& b) {
    return a.splat.depth != b.splat.depth ? a.splat.depth < b.splat.depth : a.item < b.item;
  });
  place_.assign(items_, kNowhere);
  for (uint32_t i = 0; i < splats_.size(); ++i) place_[splats_[i].item] = i;
  list_tiles();
  workers.for_blocks(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), 1,
                     [&](size_t tile, size_t) { blend(static_cast<int>(tile)); });
}

void TrainPicture::list_tiles() {
  const auto each = [&](const auto& put) {
    for (uint32_t i = 0; i < splats_.size(); ++i) {
      const Splat& s = splats_[i].splat;
      const int left = at_most(s.x - s.half_width, width_ - 1) / kTile;
      const int right = at_most(s.x + s.half_width, width_ - 1) / kTile;
      const int top = at_most(s.y - s.half_height, height_ - 1) / kTile;
      const int bottom = at_most(s.y + s.half_height, height_ - 1) / kTile;
      for (int row = top; row <= bottom; ++row)
        for (int column = left; column <= right; ++column)
          put(static_cast<size_t>(row) * static_cast<size_t>(columns_) +
                  static_cast<size_t>(column),
              i);
    }
  };
  tile_begin_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_) + 1, 0);
  each([&](size_t tile, uint32_t) { ++tile_begin_[tile + 1]; });
  for (size_t tile = 1; tile < tile_begin_.size(); ++tile)
    tile_begin_[tile] += tile_begin_[tile - 1];
  tile_splats_.resize(tile_begin_.back());
  std::vector<uint32_t> next(tile_begin_.begin(), tile_begin_.end() - 1);
  each([&](size_t tile, uint32_t i) { tile_splats_[next[tile]++] = i; });
}

TrainPicture::Span TrainPicture::span_of(const Splat& s, int tile) const {
  const int left = tile % columns_ * kTile, top = tile / columns_ * kTile;
  const int right = std::min(left + kTile, width_) - 1, bottom = std::min(top + kTile, height_) - 1;
  return {std::max(left, at_most(s.x - s.half_width - 0.5f, width_)),
          std::min(right, at_most(s.x + s.half_width, width_)),
          std::max(top, at_most(s.y - s.half_height - 0.5f, height_)),
          std::min(bottom, at_most(s.y + s.half_height, height_))};
}

void TrainPicture::blend(int tile) {
  const auto at = static_cast<size_t>(tile);
  float transmittance[kTile * kTile];
  bool open[kTile * kTile];
  std::fill_n(transmittance, kTile * kTile, 1.0f);
  std::fill_n(open, kTile * kTile, true);
  for (uint32_t k = tile_begin_[at]; k < tile_begin_[at + 1]; ++k) {
    const Splat& s = splats_[tile_splats_[k]].splat;
    const Span span = span_of(s, tile);
    for (int y = span.y0; y <= span.y1; ++y)
      for (int x = span.x0; x <= span.x1; ++x) {
        const int local = y % kTile * kTile + x % kTile;
        Alpha alpha;
        if (!open[local] || !alpha_at(s, x, y, alpha)) continue;
        float a = std::min(alpha.plain, kAlphaMax);
        if (s.t != 1.0f) a = sibling_alpha(a, s.t, s.inverse_k);
        const float before = transmittance[local], after = before - a * before;
        if (after < kTransmittanceEnd) {
          open[local] = false;
          continue;
        }
        TrainPixel& pixel = pixels_[index(x, y)];
        pixel.r += a * before * s.colour.x;
        pixel.g += a * before * s.colour.y;
        pixel.b += a * before * s.colour.z;
        pixel.alpha = 1.0f - after;
        transmittance[local] = after;
      }
  }
}

double TrainPicture::squares(std::span<const TrainPixel> truth) const {
  double sum = 0;
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const double r = double{pixels_[i].r} - truth[i].r, g = double{pixels_[i].g} - truth[i].g,
                 b = double{pixels_[i].b} - truth[i].b;
    sum += r * r + g * g + b * b;
  }
  return sum;
}

void TrainPicture::blend_back(int tile, std::span<const TrainPixel> truth, float weight,
                              std::span<TrainSums> pairs) const {
  PixelAdjoint<float> adjoint[kTile * kTile];
  float error[kTile * kTile];
  bool open[kTile * kTile];
  const int left = tile % columns_ * kTile, top = tile / columns_ * kTile;
  for (int local = 0; local < kTile * kTile; ++local) {
    const int x = left + local % kTile, y = top + local / kTile;
    open[local] = x < width_ && y < height_;
    if (!open[local]) continue;
    const size_t i = index(x, y);
    const TrainPixel &drawn = pixels_[i], &wanted = truth[i];
    const Vec3f off{drawn.r - wanted.r, drawn.g - wanted.g, drawn.b - wanted.b};
    adjoint[local] = {{drawn.r, drawn.g, drawn.b},
                      1.0f - drawn.alpha,
                      (2.0f * weight) * off,
                      2.0f * weight * kCoverageWeight * (drawn.alpha - wanted.alpha)};
    error[local] = dot(off, off);
  }
  for (size_t k = 0; k < pairs.size(); ++k) {
    const Splat& s = splats_[tile_splats_[tile_begin_[static_cast<size_t>(tile)] + k]].splat;
    const Span span = span_of(s, tile);
    TrainSums& sum = pairs[k];
    for (int y = span.y0; y <= span.y1; ++y)
      for (int x = span.x0; x <= span.x1; ++x) {
        const int local = y % kTile * kTile + x % kTile;
        Alpha at;
        if (!open[local] || !alpha_at(s, x, y, at)) continue;
        float alpha = std::min(at.plain, kAlphaMax);
        float slope = at.plain < kAlphaMax ? alpha : 0.0f;
        if (s.t != 1.0f) {
          slope *= sibling_alpha_slope(alpha, s.t, s.inverse_k);
          alpha = sibling_alpha(alpha, s.t, s.inverse_k);
        }
        PixelShare<float> share;
        open[local] = blend_adjoint(alpha, slope, s.colour, adjoint[local], share);
        if (!open[local]) continue;
        const double g = double{share.g}, p = double{at.p}, q = double{at.q};
        SplatSums<double>& of = sum.sums;
        of.g += g, of.gp += g * p, of.gq += g * q;
        of.gpp += g * p * p, of.gpq += g * p * q, of.gqq += g * q * q;
        const Vec3f by = share.weight * adjoint[local].by_colour;
        of.colour = of.colour + Vec3d{double{by.x}, double{by.y}, double{by.z}};
        sum.squares += double{share.weight} * double{error[local]};
        sum.any = true;
      }
  }
}

std::vector<TrainSums> TrainPicture::adjoint(std::span<const TrainPixel> truth, double weight,
                                             Workers& workers) const {
  std::vector<TrainSums> pairs(tile_splats_.size());
  workers.for_blocks(tile_begin_.size() - 1, 1, [&](size_t tile, size_t) {
    const uint32_t begin = tile_begin_[tile], count = tile_begin_[tile + 1] - begin;
    blend_back(static_cast<int>(tile), truth, static_cast<float>(weight),
               std::span(pairs).subspan(begin, count));
  });
  std::vector<TrainSums> all(items_);
  for (size_t k = 0; k < pairs.size(); ++k) {
    if (!pairs[k].any) continue;
    TrainSums& of = all[splats_[tile_splats_[k]].item];
    SplatSums<double>& sum = of.sums;
    const SplatSums<double>& more = pairs[k].sums;
    sum.g += more.g, sum.gp += more.gp, sum.gq += more.gq;
    sum.gpp += more.gpp, sum.gpq += more.gpq, sum.gqq += more.gqq;
    sum.colour = sum.colour + more.colour;
    of.squares += pairs[k].squares;
    of.any = true;
  }
  return all;
}

}  // namespace voyager
