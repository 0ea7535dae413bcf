// METHOD §7b: no pixel that passes the contribution test may be missed by the
// bins, whatever the rounding; and the ellipse's bins are tight.
#include "runtime/cpu/bin.h"

#include <set>

#include "runtime/cpu/rasterize.h"
#include "tests/support/render_scene.h"

namespace voyager::bin_test {
namespace {

constexpr uint32_t kWidth = 150, kHeight = 101;

void set_box(Splat& s) {
  const SupportEllipse support = support_ellipse(s);
  s.half_width = static_cast<float>(support.reach_x * 1.000001);
  s.half_height = static_cast<float>(support.reach_y * 1.000001);
}

Splat make_splat(float x, float y, double sigma_x, double sigma_y, double correlation, float rho) {
  Splat s{};
  s.x = x, s.y = y;
  const double xx = sigma_x * sigma_x + 0.3, xy = correlation * sigma_x * sigma_y,
               yy = sigma_y * sigma_y + 0.3;
  const double given = (1 - correlation) * (1 + correlation) * sigma_y * sigma_y + 0.3;
  s.conic = conic(ImageCovariance<float>{static_cast<float>(xx), static_cast<float>(xy),
                                         static_cast<float>(yy), static_cast<float>(given), 1},
                  0.5f);
  s.rho_min = rho;
  s.opacity = s.t = 1;
  set_box(s);
  return s;
}

Splat random_splat(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double size = std::pow(10, 4 * uniform(random) + 1),
               ratio = std::pow(10, 3 * uniform(random));
  const double tilt = 1 - std::pow(10, -4 + 4 * uniform(random));
  const double away = random() % 3 == 0 ? size : 100;
  return make_splat(
      static_cast<float>(75 + away * uniform(random)),
      static_cast<float>(50 + away * uniform(random)), size, size * ratio,
      (random() % 2 ? 1 : -1) * std::max(0.0, tilt),
      static_cast<float>(-5.5 * std::fabs(uniform(random)) - (random() % 5 == 0 ? 10 : 0)));
}

// The kernel's own arithmetic at one pixel.
float rho_at(const Splat& s, uint32_t x, uint32_t y) {
  const float dx = (static_cast<float>(x) + 0.5f) - s.x, dy = (static_cast<float>(y) + 0.5f) - s.y;
  const float p = dx * s.conic.p_x, q = std::fma(-s.conic.skew, dx, dy) * s.conic.q_y;
  return -std::fma(q, q, p * p);
}
bool contributes(const Splat& s, uint32_t x, uint32_t y) {
  return rho_at(s, x, y) >= s.rho_min;
}

std::set<size_t> tiles_of(const Splat& splat, bool alpha_filter, Workers& workers,
                          cpu::TileBins& bins) {
  const uint32_t order[1] = {0};
  const TileGrid grid = tile_grid(kWidth, kHeight);
  bins.build(&splat, order, grid, alpha_filter, workers);
  std::set<size_t> tiles;
  for (size_t tile = 0; tile < static_cast<size_t>(grid.columns * grid.rows); ++tile)
    if (!bins.tile(tile).empty()) tiles.insert(tile);
  return tiles;
}

std::set<size_t> tiles_with_pixels(const Splat& splat) {
  std::set<size_t> tiles;
  const auto columns = static_cast<size_t>(tile_grid(kWidth, kHeight).columns);
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x)
      if (contributes(splat, x, y)) tiles.insert(y / kTile * columns + x / kTile);
  return tiles;
}

TEST(Bin, NoContributingPixelIsMissedAndTheEllipseStaysInItsBox) {
  Workers workers(1);
  cpu::TileBins bins(std::pmr::get_default_resource());
  std::mt19937 random(1);
  size_t emitted = 0, boxed = 0, useful = 0;
  for (int i = 0; i < 3000; ++i) {
    const Splat splat = random_splat(random);
    const std::set<size_t> needed = tiles_with_pixels(splat);
    const std::set<size_t> ellipse = tiles_of(splat, true, workers, bins);
    const std::set<size_t> box = tiles_of(splat, false, workers, bins);
    EXPECT_EQ(bins.pairs_before(), box.size());
    ASSERT_TRUE(std::includes(ellipse.begin(), ellipse.end(), needed.begin(), needed.end())) << i;
    ASSERT_TRUE(std::includes(box.begin(), box.end(), ellipse.begin(), ellipse.end())) << i;
    emitted += ellipse.size(), boxed += box.size(), useful += needed.size();
  }
  EXPECT_GE(static_cast<double>(useful), 0.95 * static_cast<double>(emitted));
  RecordProperty("useful_of_emitted",
                 std::to_string(static_cast<double>(useful) / static_cast<double>(emitted)));
  RecordProperty("emitted_of_boxed",
                 std::to_string(static_cast<double>(emitted) / static_cast<double>(boxed)));
}

// ρ_min set to the largest ρ of one tile as the kernel rounds it: the real
// ellipse then touches or just misses the tile, and only the margin saves it.
TEST(Bin, ATileThatIsOnlyJustReachedIsNotMissed) {
  Workers workers(1);
  cpu::TileBins bins(std::pmr::get_default_resource());
  std::mt19937 random(4);
  const TileGrid grid = tile_grid(kWidth, kHeight);
  size_t touched = 0;
  for (int i = 0; i < 20000; ++i) {
    Splat splat = random_splat(random);
    const auto column = static_cast<uint32_t>(random() % static_cast<unsigned>(grid.columns));
    const auto row = static_cast<uint32_t>(random() % static_cast<unsigned>(grid.rows));
    float most = -INFINITY;
    for (uint32_t y = row * kTile; y < std::min((row + 1) * kTile, kHeight); ++y)
      for (uint32_t x = column * kTile; x < std::min((column + 1) * kTile, kWidth); ++x)
        most = std::max(most, rho_at(splat, x, y));
    if (most < -20.0f || most == 0.0f) continue;
    ++touched;
    splat.rho_min = most;
    set_box(splat);
    const size_t tile = row * static_cast<size_t>(grid.columns) + column;
    ASSERT_EQ(tiles_of(splat, true, workers, bins).count(tile), 1u) << i;
    ASSERT_EQ(tiles_of(splat, false, workers, bins).count(tile), 1u) << i;
  }
  EXPECT_GT(touched, 3000u);
}

// One row is left out at a time: a rasterizer that skips rows by the splat's box
// must not skip one in which a pixel passes the test.
TEST(Bin, TheRasterizerVisitsEveryRowThatContributes) {
  std::mt19937 random(2);
  std::vector<cpu::Pixel> filtered(kTile * kTile), whole(kTile * kTile);
  const uint32_t index[1] = {0};
  for (int i = 0; i < 20000; ++i) {
    Splat splat = random_splat(random);
    splat.x -= 70, splat.y -= 45;
    splat.colour = {1, 1, 1};
    for (const bool filter : {true, false}) {
      const cpu::RasterParams params{
          &splat, nullptr, 0, kTile, kTile, filter ? filtered.data() : whole.data(), nullptr, {}};
      cpu::pick_rasterizer(Exponential::exact, filter, false, false)(params, {0, 0, index});
    }
    for (size_t pixel = 0; pixel < whole.size(); ++pixel) {
      ASSERT_EQ(filtered[pixel].transmittance, whole[pixel].transmittance) << i;
      const auto at = static_cast<uint32_t>(pixel);
      ASSERT_EQ(whole[pixel].transmittance < 1, contributes(splat, at % kTile, at / kTile)) << i;
    }
  }
}

TEST(Bin, KeepsTheOrderAndDoesNotDependOnThreads) {
  std::mt19937 random(3);
  std::vector<Splat> splats;
  std::vector<uint32_t> order;
  for (uint32_t i = 0; i < 20000; ++i) {
    splats.push_back(make_splat(static_cast<float>(random() % kWidth),
                                static_cast<float>(random() % kHeight), 1 + random() % 8,
                                1 + random() % 8, 0.5, -3));
    order.push_back(i);
  }
  std::shuffle(order.begin(), order.end(), random);
  std::vector<uint32_t> place(order.size());
  for (uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  const TileGrid grid = tile_grid(kWidth, kHeight);
  Workers one(1), five(5);
  cpu::TileBins a(std::pmr::get_default_resource()), b(std::pmr::get_default_resource());
  a.build(splats.data(), order, grid, true, one);
  b.build(splats.data(), order, grid, true, five);
  ASSERT_EQ(a.pairs_after(), b.pairs_after());
  ASSERT_LE(a.pairs_after(), a.pairs_before());
  for (size_t tile = 0; tile < static_cast<size_t>(grid.columns * grid.rows); ++tile) {
    const auto list = a.tile(tile), other = b.tile(tile);
    ASSERT_TRUE(std::equal(list.begin(), list.end(), other.begin(), other.end()));
    for (size_t i = 1; i < list.size(); ++i) ASSERT_LT(place[list[i - 1]], place[list[i]]);
  }
}

}  // namespace
}  // namespace voyager::bin_test
