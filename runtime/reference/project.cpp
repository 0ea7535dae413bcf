#include "runtime/reference/project.h"

#include <cmath>

#include "runtime/frame/draw_list.h"
#include "runtime/frame/project_params.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/math/alpha.h"
#include "runtime/math/sort_key.h"

namespace voyager::reference {
namespace {

Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

std::optional<Splat> project(const Scene& scene, const Camera& camera, const PipelineDesc& desc,
                             const InstanceLook& look, const DrawItem& cut_item) {
  const GaussianArrays arrays = gaussian_arrays(scene);
  const DrawItem item = drawn_item(cut_item, arrays.doubles);
  const Vec3f mean = interpolated_mean(arrays, item);
  if (!is_inside(local_clip(look.clip, scene.origin), mean)) return std::nullopt;
  const Vec3f key = camera_relative(mean, scene.origin, camera.eye);
  const float z = view_depth(key, to_float(camera.world_to_view.row[2]));
  if (!(z > static_cast<float>(camera.near_z))) return std::nullopt;

  Shape<double> shape = interpolated_shape<double>(arrays, item);
  fade(shape, double{look.opacity}, std::log(double{look.opacity}));
  const auto filter = pixel_filter<double>(scene, desc.antialias);
  if (filter.footprint > 0)
    shape.scale = widened(shape.scale, interpolated_footprint(arrays, item, filter.footprint));

  const Vec3d d{double{mean.x} + scene.origin.x - camera.eye.x,
                double{mean.y} + scene.origin.y - camera.eye.y,
                double{mean.z} + scene.origin.z - camera.eye.z};
  const Vec3d view = camera.world_to_view * d;
  const ViewProjection<double> v =
      view_projection<double>(camera.world_to_view, camera.fx, camera.fy, camera.cx, camera.cy,
                              camera.width, camera.height);
  const ImageCovariance<double> c =
      image_covariance(image_jacobian(v, view), shape.rotation, shape.scale, filter.low_pass);
  if (filter.compensated) shape.opacity *= std::sqrt(c.kept);
  const double rho = rho_min(std::log(shape.opacity), double{log_threshold(desc.antialias)});
  if (!(rho <= 0)) return std::nullopt;
  Splat s;
  s.x = camera.fx * view.x / view.z + camera.cx;
  s.y = camera.fy * view.y / view.z + camera.cy;
  s.conic = conic(c, 0.5);
  const double radius = std::sqrt(-2 * rho) * (1 + 1e-9);
  s.half_width = radius * std::sqrt(c.xx) + 1e-6;
  s.half_height = radius * std::sqrt(c.yy) + 1e-6;
  s.rho_min = rho;
  s.opacity = shape.opacity;
  s.colour = interpolated_colour(arrays, item, (1 / std::sqrt(dot(d, d))) * d);
  s.t = item.t;
  s.inverse_k = item.inverse_k;
  s.depth = sort_depth(z, static_cast<float>(camera.depth_scale));
  if (s.x + s.half_width < 0 || s.x - s.half_width > camera.width || s.y + s.half_height < 0 ||
      s.y - s.half_height > camera.height)
    return std::nullopt;
  return s;
}

}  // namespace voyager::reference
