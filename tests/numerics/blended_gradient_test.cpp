// What a drawn Gaussian's gradient says of the two that it lies between (METHOD §4), against
// central differences: of a loss that is linear in what is drawn.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "runtime/stages/learn.h"

namespace voyager::blended_gradient_test {
namespace {

using Numbers = std::array<double, kShapeNumbers>;

Gaussian random_gaussian(std::mt19937& random, const Quatf& near) {
  const auto within = [&](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  Gaussian g{};
  for (int i = 0; i < 3; ++i) {
    g.mean[i] = within(-1, 1);
    g.scale[i] = within(0.1f, 1);
  }
  g.rotation = normalise(Quatf{near.w + within(-0.1f, 0.1f), near.x + within(-0.1f, 0.1f),
                               near.y + within(-0.1f, 0.1f), near.z + within(-0.1f, 0.1f)});
  g.opacity = within(0.2f, 0.9f);
  g.log_opacity = std::log(g.opacity);
  return g;
}

// Node 0 is the parent of node 1.
struct Pair {
  std::array<Gaussian, 2> nodes;
  std::array<uint8_t, 2> codes{};
  DrawItem item{1, 0, 0.6f, 1.0f};

  GaussianArrays arrays() const { return {nodes.data(), nullptr, codes.data(), 0, false, false}; }
  // As a trainer has them: the mean, scales, a unit rotation, and the logarithm of the opacity.
  Numbers drawn() const {
    const Vec3f mean = interpolated_mean(arrays(), item);
    const Shape<double> s = interpolated_shape<double>(arrays(), item);
    const Quatd q = normalise(s.rotation);
    return {mean.x, mean.y, mean.z, s.scale.x, s.scale.y,    s.scale.z,
            q.w,    q.x,    q.y,    q.z,       s.log_opacity};
  }
  // Moves a number as a trainer does.
  void move(size_t node, int number, float by) {
    Gaussian& g = nodes[node];
    float moves[kShapeNumbers] = {};
    moves[number] = -by;
    move_shape(moves, g);
  }
};

double loss(const Pair& pair, const Numbers& weights) {
  const Numbers drawn = pair.drawn();
  double sum = 0;
  for (size_t i = 0; i < drawn.size(); ++i) sum += weights[i] * drawn[i];
  return sum;
}

// Along the unit rotation nothing changes.
Numbers by_drawn(const Pair& pair, const Numbers& weights) {
  const Numbers drawn = pair.drawn();
  Numbers by = weights;
  double along = 0;
  for (size_t i = 6; i < 10; ++i) along += weights[i] * drawn[i];
  for (size_t i = 6; i < 10; ++i) by[i] -= along * drawn[i];
  return by;
}

void expect_right(const Pair& pair, const Numbers& weights, size_t node) {
  float drawn[kShapeNumbers];
  const Numbers by = by_drawn(pair, weights);
  for (int i = 0; i < kShapeNumbers; ++i) drawn[i] = static_cast<float>(by[static_cast<size_t>(i)]);
  const bool parent = node == 0;
  const double opacity = interpolated_shape<double>(pair.arrays(), pair.item).opacity;
  ShapeGradient found;
  add_share(drawn, parent ? 1 - pair.item.t : pair.item.t,
            parent ? parent_sign(pair.arrays(), pair.item) : 1.0f, static_cast<float>(opacity),
            pair.nodes[node], found);
  // Of a rotation what lies along it changes nothing, and a blended one is a little shorter.
  const Quatf own = pair.nodes[node].rotation;
  const float along =
      found.by[6] * own.w + found.by[7] * own.x + found.by[8] * own.y + found.by[9] * own.z;
  const float off[] = {along * own.w, along * own.x, along * own.y, along * own.z};
  for (int i = 6; i < 10; ++i) found.by[i] -= off[i - 6];
  constexpr float kStep = 2e-3f;
  for (int i = 0; i < kShapeNumbers; ++i) {
    Pair above = pair, below = pair;
    above.move(node, i, kStep);
    below.move(node, i, -kStep);
    const double expected = (loss(above, weights) - loss(below, weights)) / (2 * double{kStep});
    EXPECT_NEAR(double{found.by[i]}, expected, 0.03 * std::max(std::fabs(expected), 0.2))
        << "node " << node << ", number " << i;
  }
}

// A leaf's axes may be named otherwise than its parent's (a node code); merged nodes' never are.
// Either's rotation may have the other sign.
TEST(BlendedGradient, IsThatOfCentralDifferences) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> weight(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const Quatf near = random_gaussian(random, {0, 0, 0, 0}).rotation;
    Pair pair{{random_gaussian(random, near), random_gaussian(random, near)}};
    const bool leaf = trial % 2 == 1;
    if (leaf) {
      const int code = trial / 2 % kAxisCodes;
      pair.codes[1] = node_code(code, 0);
      const Quatf cube = cube_rotation<float>(code);
      pair.nodes[1].rotation =
          normalise(pair.nodes[1].rotation * Quatf{cube.w, -cube.x, -cube.y, -cube.z});
    }
    for (Gaussian& g : pair.nodes)
      if (random() % 2 != 0)
        g.rotation = {-g.rotation.w, -g.rotation.x, -g.rotation.y, -g.rotation.z};
    Numbers weights;
    for (double& w : weights) w = weight(random);
    expect_right(pair, weights, 0);
    if (!leaf) expect_right(pair, weights, 1);
  }
}

}  // namespace
}  // namespace voyager::blended_gradient_test
