#include "tools/synth/gaussian_maker.h"

#include <algorithm>
#include <cmath>

#include "tools/synth/light.h"
#include "tools/synth/portable_math.h"

namespace voyager::synth {

struct GaussianMaker::Mark {
  Vec3d position, normal;
  double scale[3];  // metres
  Quatd rotation;
  double opacity;
  double s = 0, t = 0;  // metres along u and v
};

namespace {

// Training presses a sixth of a captured city's Gaussians flat, one in a hundred
// to the last: conditioning is to be met, not avoided.
double thickness(double width, Random& random) {
  const double u = random.uniform();
  if (u < 0.01) return 1e-6 * random.uniform(1.0, 2.0);
  if (u < 0.17) {
    const double w = random.uniform();
    return 1e-5 / (1e-2 + (1.0 - 1e-2) * w * w);
  }
  const double w = random.uniform();
  return std::min(0.15, width * (0.02 + 0.6 * w * w));
}

// Log-normal around 1, without exp.
double spread(double sigma, Random& random) {
  const double x = sigma * random.bell() / 8.0;
  double y = 1.0 + x + 0.5 * x * x;
  y *= y;
  y *= y;
  return y * y;
}

// The standard deviation of each of m in a row, as a part of its cell: wide
// enough to close the row, narrower where few would spill over its ends.
double cell_width(double m) {
  return 0.60 * m / (m + 0.7);
}

// A little out of the surface, and by `turn`, the tangent of half an angle, within it.
Quatd tilted(const Quatd& frame, double sigma, double turn, Random& random) {
  const double x = sigma * random.bell(), y = sigma * random.bell();
  return normalise(frame * Quatd{1.0, x, y, turn});
}

Quatd surface_rotation(const Surface& surface) {
  return frame_rotation(unit(surface.u), unit(surface.v));
}

double structural_opacity(Random& random) {
  const double u = 1.0 - random.uniform();
  return 0.9975 - 0.55 * u * u * u;
}

double faint_opacity(Random& random) {
  const double u = random.uniform();
  return 0.02 + 0.55 * u * u;
}

// Area of the trapezium up to v, as a fraction of the whole.
double area_below(const Surface& s, double v) {
  const double taper = 0.5 * (s.inset_left + s.inset_right);
  return v * (1.0 - v * taper) / (1.0 - taper);
}

Vec3d point_on(const Surface& s, double a, double v) {
  const double left = v * s.inset_left, right = 1.0 - v * s.inset_right;
  return s.corner + (left + a * (right - left)) * s.u + v * s.v;
}

}  // namespace

GaussianMaker::GaussianMaker(const Layout& layout, int sh_degree, const Emit& emit)
    : layout_(layout), emit_(emit) {
  batch_.sh_degree = sh_degree;
  batch_.position.reserve(kBatch * 3);
  batch_.log_scale.reserve(kBatch * 3);
  batch_.rotation.reserve(kBatch * 4);
  batch_.opacity.reserve(kBatch);
  batch_.sh.reserve(kBatch * 3 * static_cast<size_t>(batch_.coefficients()));
}

void GaussianMaker::fill(const Surface& surface, uint64_t count, uint64_t seed) {
  if (count == 0) return;
  Random random(seed);
  if (surface.material == Material::leaves) {
    fill_crown(surface, count, random);
    return;
  }
  const uint64_t faint = count < 4 ? 0 : count * 28 / 100;
  tile(surface, count - faint, random);
  scatter(surface, faint, count, random);
}

void GaussianMaker::tile(const Surface& surface, uint64_t count, Random& random) {
  const double width = length(surface.u), height = length(surface.v),
               n = static_cast<double>(count);
  // Few Gaussians are kept round: a lone long one is a streak.
  const double stretch =
      1.0 + (static_cast<double>(look(surface.material).stretch) - 1.0) * std::min(1.0, n / 40.0);
  const double wanted = std::floor(std::sqrt(n * stretch * height / width) + 0.5);
  const auto rows = static_cast<uint64_t>(std::clamp(wanted, 1.0, n));
  const Quatd frame = surface_rotation(surface);
  const double r = static_cast<double>(rows);
  uint64_t before = 0;
  for (uint64_t row = 0; row < rows; ++row) {
    const double v1 = static_cast<double>(row + 1) / r;
    const auto after = row + 1 == rows ? count : static_cast<uint64_t>(n * area_below(surface, v1));
    const uint64_t columns = after - before;
    const double m = static_cast<double>(columns);
    const double middle = (static_cast<double>(row) + 0.5) / r;
    const double row_width = width * (1.0 - middle * (surface.inset_left + surface.inset_right));
    for (uint64_t column = 0; column < columns; ++column) {
      const double jitter = rows > 2 ? random.uniform(0.2, 0.8) : 0.5;
      const double v = (static_cast<double>(row) + jitter) / r;
      const double along =
          (static_cast<double>(column) + (columns > 2 ? random.uniform(0.2, 0.8) : 0.5)) / m;
      Mark mark;
      mark.position = point_on(surface, along, v);
      mark.s = along * width;
      mark.t = v * height;
      mark.scale[0] = row_width / m * cell_width(m) * spread(0.28, random);
      mark.scale[1] = height / r * cell_width(r) * spread(0.28, random);
      mark.scale[2] = thickness(std::min(mark.scale[0], mark.scale[1]), random);
      const double turn = random.uniform(-0.03, 0.03);
      mark.rotation = tilted(frame, 0.012, turn, random);
      mark.normal = surface.normal;
      mark.opacity = structural_opacity(random);
      append(surface, mark, random);
    }
    before = after;
  }
}

void GaussianMaker::scatter(const Surface& surface, uint64_t count, uint64_t of, Random& random) {
  const double width = length(surface.u), height = length(surface.v);
  const double size = std::sqrt(surface.area() / static_cast<double>(of));
  const Quatd frame = surface_rotation(surface);
  for (uint64_t i = 0; i < count; ++i) {
    Mark mark;
    const double a = random.uniform(), v = random.uniform();
    mark.position = point_on(surface, a, v) + (0.02 * random.uniform()) * surface.normal;
    mark.s = a * width;
    mark.t = v * height;
    const double ratio = spread(0.55, random), area = 0.5 * size * spread(0.45, random);
    mark.scale[0] = std::min(area * ratio * 1.4, 0.3 * width);
    mark.scale[1] = std::min(area / ratio, 0.3 * height);
    mark.scale[2] = thickness(std::min(mark.scale[0], mark.scale[1]), random);
    const bool roomy = std::max(mark.scale[0], mark.scale[1]) < 0.2 * std::min(width, height);
    const double turn = random.uniform(-1.0, 1.0) * (roomy ? 1.0 : 0.02);
    mark.rotation = tilted(frame, 0.03, turn, random);
    mark.normal = surface.normal;
    mark.opacity = faint_opacity(random);
    append(surface, mark, random);
  }
}

void GaussianMaker::fill_crown(const Surface& crown, uint64_t count, Random& random) {
  const double size = std::sqrt(crown.area() / static_cast<double>(count));
  for (uint64_t i = 0; i < count; ++i) {
    // Four bells are as good as round for leaves; the constant keeps the length off zero.
    const Vec3d d = unit({random.bell() + 1e-6, random.bell(), random.bell()});
    const double depth = 1.0 - 0.35 * random.uniform() * random.uniform();
    Mark mark;
    mark.position = crown.corner + Vec3d{depth * crown.u.x * d.x, depth * crown.v.y * d.y,
                                         depth * crown.u.x * d.z};
    const double base = std::min(0.40 * size, 0.5 * crown.u.x) * spread(0.35, random);
    mark.scale[0] = base * random.uniform(0.9, 1.4);
    mark.scale[1] = base * random.uniform(0.5, 1.0);
    // A crown of few leaves has round ones: seen edge-on, discs would be spikes.
    mark.scale[2] =
        count < 40 ? 0.6 * base : std::min(thickness(mark.scale[1], random), 0.3 * base);
    mark.rotation =
        normalise(Quatd{random.bell() + 1e-6, random.bell(), random.bell(), random.bell()});
    mark.normal = d;
    mark.opacity = random.chance(0.3) ? faint_opacity(random) : structural_opacity(random);
    append(crown, mark, random);
  }
}

void GaussianMaker::append(const Surface& surface, const Mark& mark, Random& random) {
  for (int k = 0; k < 3; ++k) {
    batch_.position.push_back(static_cast<float>(mark.position[k]));
    batch_.log_scale.push_back(static_cast<float>(portable_log(std::max(mark.scale[k], 1e-6))));
  }
  for (double q : {mark.rotation.w, mark.rotation.x, mark.rotation.y, mark.rotation.z})
    batch_.rotation.push_back(static_cast<float>(q));
  batch_.opacity.push_back(static_cast<float>(portable_logit(mark.opacity)));
  append_colour(surface, mark, random);
  if (batch_.size() == kBatch) flush();
}

void GaussianMaker::append_colour(const Surface& surface, const Mark& mark, Random& random) {
  Vec3f colour = albedo(surface, mark.s, mark.t);
  if (surface.material == Material::leaves) {
    // Deep leaves see less sky.
    const double up = 0.5 - 0.5 * mark.normal.y;
    colour = static_cast<float>(0.60 + 0.5 * up) * colour;
  }
  const Vec3d probe = mark.position + 0.05 * mark.normal;
  float sh[16][3] = {};
  light_point(surface, probe, mark.normal, colour, !layout_.shaded(probe), random, sh);
  const int coefficients = batch_.coefficients();
  for (int k = 0; k < coefficients; ++k)
    for (int c = 0; c < 3; ++c) batch_.sh.push_back(sh[k][c]);
}

void GaussianMaker::flush() {
  if (batch_.size() == 0) return;
  batch_.report.read = batch_.size();
  emit_(batch_);
  batch_.position.clear();
  batch_.log_scale.clear();
  batch_.rotation.clear();
  batch_.opacity.clear();
  batch_.sh.clear();
}

}  // namespace voyager::synth
