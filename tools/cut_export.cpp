#include "tools/cut_export.h"

#include "runtime/base/open_source.h"
#include "runtime/frame/draw_list.h"
#include "runtime/frame/frame_search.h"
#include "runtime/frame/scene_gaussians.h"

namespace voyager::tools {
namespace {

void append(GaussianCloud& cloud, const GaussianArrays& arrays, const DrawItem& cut_item) {
  const DrawItem item = drawn_item(cut_item, arrays.doubles);
  const Vec3f mean = interpolated_mean(arrays, item);
  const Shape<float> shape = interpolated_shape<float>(arrays, item);
  for (int i = 0; i < 3; ++i) cloud.position.push_back(mean[i]);
  for (int i = 0; i < 3; ++i) cloud.log_scale.push_back(std::log(shape.scale[i]));
  for (const float q : {shape.rotation.w, shape.rotation.x, shape.rotation.y, shape.rotation.z})
    cloud.rotation.push_back(q);
  cloud.opacity.push_back(flat_logit(shape.opacity));
  const auto own = arrays.sh(item.gaussian);
  const auto parent = arrays.sh(item.t == 1.0f ? item.gaussian : item.parent);
  for (int k = 0; k < sh_coefficients(arrays.sh_degree()); ++k)
    for (int channel = 0; channel < 3; ++channel)
      cloud.sh.push_back(item.t == 1.0f ? own(k, channel)
                                        : lerp(parent(k, channel), own(k, channel), item.t));
}

}  // namespace

FlatContents export_cut(const std::string& scene_path, const Camera& camera, double tau,
                        const std::string& path, const FlatOptions& options) {
  require_flat_file(path, {});
  Workers workers;
  const auto scene = load_scene(open_source(scene_path), std::pmr::get_default_resource(), workers);
  voyager::Camera seen;
  seen.eye = {camera.pose.position[0], camera.pose.position[1], camera.pose.position[2]};
  const VoyFrustum f = camera.frustum();
  seen.fx = camera.width / (f.right - f.left);
  DrawList draws(scene, Lod::cut, Search::exhaustive, std::pmr::get_default_resource(), workers);
  draws.update(cut_query(seen, tau, scene->origin), workers);

  GaussianCloud cloud;
  cloud.sh_degree = scene->sh_degree;
  for (int i = 0; i < 3; ++i) cloud.origin[static_cast<size_t>(i)] = scene->origin[i];
  const GaussianArrays arrays = gaussian_arrays(*scene);
  for (const DrawItem& item : draws.items()) append(cloud, arrays, item);

  cloud.native = scene->native;

  FlatContents contents;
  contents.sh_degree = cloud.sh_degree;
  contents.native = cloud.native;
  contents.add(cloud);
  write_flat_file(path, options, contents, [&](GaussianWriter& writer) { writer.append(cloud); });
  return contents;
}

}  // namespace voyager::tools
