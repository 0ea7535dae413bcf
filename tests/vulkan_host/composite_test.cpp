// Meshes before, among and behind the splats, both ways, against pictures made without Vulkan.
#include <algorithm>
#include <limits>

#include "tests/vulkan_host/host_run.h"
#include "tools/cameras.h"
#include "voyager/voyager.hpp"

namespace voyager::test {
namespace composite_test {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

// What lies before a depth: straight colour times alpha, and T, as a host blends them.
struct Splats {
  Picture colour;  // three channels, code values from 0 to 1
  std::vector<float> transmittance;
  Picture depth;
};

class Composites : public VulkanHost {
 protected:
  static constexpr int kCamera = 3;

  void SetUp() override {
    VulkanHost::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    std::ifstream source(file("cameras.json"));
    const nlohmann::json all = nlohmann::json::parse(source);
    std::ofstream(file("one.json")) << nlohmann::json::array({all[kCamera]});
    camera_ = tools::read_cameras(file("one.json")).front();
    rows_ = all[kCamera]["rotation"];
    splats_ = render("");
    std::vector<float> depths;
    for (const float z : splats_.depth.values)
      if (z < kNothing) depths.push_back(z);
    ASSERT_GT(depths.size(), splats_.depth.values.size() / 4);
    std::sort(depths.begin(), depths.end());
    nearest_ = depths.front();
    middle_ = depths[depths.size() / 2];
    farthest_ = depths.back();
  }

  // By `voyager render`; T is the difference that a white background makes.
  Splats render(const std::string& options) const {
    const std::string command = "voyager render " + file("city.voy") + " --cameras " +
                                file("one.json") + " --camera 0 --float " + options;
    expect_success(command + " -o " + file("black.pfm") + " --depth " + file("depth.pfm"));
    expect_success(command + " --background 1,1,1 -o " + file("white.pfm"));
    Splats splats{read_pfm(file("black.pfm")), {}, read_pfm(file("depth.pfm"))};
    const Picture white = read_pfm(file("white.pfm"));
    for (size_t i = 0; i < splats.depth.values.size(); ++i)
      splats.transmittance.push_back(white.values[3 * i] - splats.colour.values[3 * i]);
    return splats;
  }

  // The same with the mesh's depth as a limit, in metres, through the C ABI.
  Splats render_limited(const Picture& metres) const {
    const voy::Device device = voy::Device::create();
    const voy::Scene scene = device.open_scene(file("city.voy"));
    const VoyScene scenes[] = {scene.get()};
    VoyViewDesc view_desc = VOY_VIEW_DESC_INIT;
    view_desc.instanceCount = 1;
    view_desc.scenes = scenes;
    view_desc.maxWidth = camera_.width;
    view_desc.maxHeight = camera_.height;
    voy::View view = device.create_view(view_desc);
    std::vector<float> rgba(4 * metres.values.size());
    Splats splats;
    splats.depth = metres;
    VoyTargetDesc target_desc = VOY_TARGET_DESC_INIT;
    target_desc.colorFormat = VOY_COLOR_FORMAT_RGBA32F;
    target_desc.width = camera_.width;
    target_desc.height = camera_.height;
    target_desc.color = rgba.data();
    target_desc.depth = splats.depth.values.data();
    const voy::Target target = device.create_target(target_desc);
    VoyEyeDepthLimit limit = VOY_EYE_DEPTH_LIMIT_INIT;
    limit.depth = metres.values.data();
    VoyFrameEye eye = VOY_FRAME_EYE_INIT;
    eye.next = &limit;
    eye.pose = camera_.pose;
    eye.frustum = camera_.frustum();
    eye.target = target.get();
    VoyFrame frame = VOY_FRAME_INIT;
    frame.eyeCount = 1;
    frame.eyes = &eye;
    view.render(frame);
    splats.colour = {camera_.width, camera_.height, {}};
    for (size_t i = 0; i < metres.values.size(); ++i) {
      splats.colour.values.insert(splats.colour.values.end(), &rgba[4 * i], &rgba[4 * i] + 3);
      splats.transmittance.push_back(1 - rgba[4 * i + 3]);
    }
    return splats;
  }

  // A sheet over the left two thirds of the image, at depth `left` there and `right` at its
  // other end, as glTF (y up) with a buffer in a file of its own and no normals.
  void write_sheet(float left, float right) const {
    const VoyFrustum f = camera_.frustum();
    const double edge = f.left + (f.right - f.left) * 0.66;
    std::string bytes;
    const auto corner = [&](double x, double y, double z) {
      const double view[] = {x * z, y * z, z};  // x right, y down, z forward
      for (size_t row = 0; row < 3; ++row) {
        double world = camera_.pose.position[row];
        for (size_t axis = 0; axis < 3; ++axis)
          world += rows_[row][axis].get<double>() * view[axis];
        const auto value = static_cast<float>(row == 0 ? world : -world);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
      }
    };
    corner(2 * f.left, -2 * f.up, left), corner(2 * f.left, -2 * f.down, left);
    corner(edge, -2 * f.up, right), corner(edge, -2 * f.down, right);
    const uint16_t indices[] = {0, 1, 2, 2, 1, 3};
    bytes.append(reinterpret_cast<const char*>(indices), sizeof indices);
    write_bytes(file("sheet.bin"), bytes);
    write_bytes(file("sheet.gltf"), R"({"asset": {"version": "2.0"}, "scene": 0,
      "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
      "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
                      {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
      "buffers": [{"byteLength": 60, "uri": "sheet.bin"}]})");
  }

  // The sheet's frame with `options` in folder `name`.
  void draw(const std::string& name, const std::string& options) const {
    expect_success(host("--frames 1 --write-depth --mesh-at 0,0,0,1 --mesh " + file("sheet.gltf") +
                            " -o " + file(name) + " " + options,
                        "one.json"));
  }

  // Two tiers: all but `outliers` of the pixels within 2/255 (the image's own rounding and the
  // blend's); where a depth is a rounding away from the sheet's, either side of it may be drawn.
  static void expect_near(const Picture& found, const Picture& expected, double outliers,
                          const std::string& what) {
    ASSERT_EQ(found.values.size(), expected.values.size()) << what;
    size_t out = 0;
    for (size_t i = 0; i < found.values.size(); i += 3) {
      float most = 0;
      for (size_t c = 0; c < 3; ++c)
        most = std::max(most, std::abs(found.values[i + c] - expected.values[i + c]));
      out += most > 2;
    }
    EXPECT_LE(static_cast<double>(out), outliers * static_cast<double>(found.values.size() / 3))
        << what;
  }

  static void expect_near_depth(const Picture& found, const std::vector<float>& expected,
                                double outliers, const std::string& what) {
    ASSERT_EQ(found.values.size(), expected.size()) << what;
    size_t out = 0;
    for (size_t i = 0; i < expected.size(); ++i) {
      const bool nothing = expected[i] == kNothing;
      if (nothing != (found.values[i] == kNothing))
        ++out;
      else if (!nothing)
        out += std::abs(found.values[i] - expected[i]) > 1e-3f * expected[i];
    }
    EXPECT_LE(static_cast<double>(out), outliers * static_cast<double>(expected.size())) << what;
  }

  // Splats over the mesh's picture where `over`, which alone is seen elsewhere.
  static Picture blend(const Splats& splats, const Picture& mesh, const auto& over) {
    Picture out = mesh;
    for (size_t i = 0; i < mesh.values.size(); ++i)
      if (over(i / 3))
        out.values[i] = std::clamp(splats.colour.values[i], 0.0f, 1.0f) * 255 +
                        splats.transmittance[i / 3] * mesh.values[i];
    return out;
  }

  void expect_test_composite(const std::string& depth, const std::string& what) const {
    draw("tested", "--composite test" + depth);
    const Picture mesh_depth = read_pfm(numbered("mesh", 0, "pfm"));
    const auto over = [&](size_t i) { return splats_.depth.values[i] <= mesh_depth.values[i]; };
    expect_near(read_png(numbered("tested", 0, "png")),
                blend(splats_, read_png(numbered("mesh", 0, "png")), over), 0.005, what);
    std::vector<float> nearer;
    for (size_t i = 0; i < mesh_depth.values.size(); ++i)
      nearer.push_back(std::min(splats_.depth.values[i], mesh_depth.values[i]));
    expect_near_depth(read_pfm(numbered("tested", 0, "pfm")), nearer, 0.005, what);
  }

  void expect_limit_composite(const std::string& depth, const std::string& what) const {
    draw("limited", "--composite limit" + depth);
    const Picture mesh_depth = read_pfm(numbered("mesh", 0, "pfm"));
    const Splats before = render_limited(mesh_depth);
    expect_near(read_png(numbered("limited", 0, "png")),
                blend(before, read_png(numbered("mesh", 0, "png")), [](size_t) { return true; }),
                0.005, what);
    std::vector<float> nearer;
    for (size_t i = 0; i < mesh_depth.values.size(); ++i)
      nearer.push_back(std::min(before.depth.values[i], mesh_depth.values[i]));
    expect_near_depth(read_pfm(numbered("limited", 0, "pfm")), nearer, 0.005, what);
  }

  // The mesh alone is drawn once for both composites. Which depths are nearer shows among the
  // splats, so both depth conventions are tried there.
  void expect_composites(const std::string& place, const std::string& depth, float left,
                         float right) const {
    write_sheet(left, right);
    draw("mesh", "--composite none" + depth);
    expect_test_composite(depth, place + depth + ", test");
    expect_limit_composite(depth, place + depth + ", limit");
  }

  tools::Camera camera_ = {};
  nlohmann::json rows_;
  Splats splats_;
  float nearest_ = 0, middle_ = 0, farthest_ = 0;
};

// The finished image is tested against the mesh's depth, or the mesh's depth limits the splats.
TEST_F(Composites, ASheetBeforeAmongAndBehindTheSplats) {
  expect_composites("before", " --depth reversed", 0.5f * nearest_, 0.5f * nearest_);
  expect_composites("among", " --depth standard", 0.7f * middle_, 1.3f * middle_);
  expect_composites("among", " --depth reversed", 0.7f * middle_, 1.3f * middle_);
  expect_composites("behind", " --depth standard", 3 * farthest_, 3 * farthest_);
}

}  // namespace
}  // namespace composite_test
}  // namespace voyager::test
