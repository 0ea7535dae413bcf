#pragma once
// A picture of some draw items, and the adjoint of how it was blended (METHOD §4, §6;
// runtime/stages/blend_gradient.h). Only for learning: frames are drawn by rasterize.h.
#include <span>
#include <vector>

#include "runtime/base/workers.h"
#include "runtime/stages/project_gradient.h"

namespace voyager {

struct TrainPixel {
  float r = 0, g = 0, b = 0, alpha = 0;
};

// Of an item: SplatSums in double, and the squared error that falls to it.
struct TrainSums {
  SplatSums<double> sums{};
  double squares = 0;
  bool any = false;
};

class TrainPicture {
 public:
  TrainPicture(const ProjectParams& params, const GaussianArrays& arrays,
               std::span<const DrawItem> items, Workers& workers);

  const std::vector<TrainPixel>& pixels() const { return pixels_; }
  // Squared error of colours, summed.
  double squares(std::span<const TrainPixel> truth) const;
  // By item, of the squared error times a weight. Sums do not depend on how threads take turns.
  std::vector<TrainSums> adjoint(std::span<const TrainPixel> truth, double weight,
                                 Workers& workers) const;
  // By item; of one that reaches the picture.
  const Vec3f& colour(uint32_t item) const { return splats_[place_[item]].splat.colour; }

 private:
  struct Listed {
    Splat splat;
    uint32_t item;
  };
  // The pixels of a tile that a splat may reach, both ends included.
  struct Span {
    int x0, x1, y0, y1;
  };
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }
  Span span_of(const Splat& splat, int tile) const;
  void list_tiles();
  void blend(int tile);
  void blend_back(int tile, std::span<const TrainPixel> truth, float weight,
                  std::span<TrainSums> pairs) const;

  int width_, height_, columns_, rows_;
  size_t items_;
  std::vector<Listed> splats_;         // front to back
  std::vector<uint32_t> place_;        // of an item in splats_
  std::vector<uint32_t> tile_begin_;   // by tile, and one behind
  std::vector<uint32_t> tile_splats_;  // indices into splats_
  std::vector<TrainPixel> pixels_;
};

}  // namespace voyager
