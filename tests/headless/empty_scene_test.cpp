// A scene without Gaussians is a scene: it opens, draws the background, and its cut
// is empty.
#include "host.h"

namespace empty_scene_test {
namespace {

// A .voy of format 4, compact, no nodes.
std::string empty_voy() {
  std::string bytes(320, '\0');
  const auto put = [&](size_t offset, std::string_view value) {
    bytes.replace(offset, value.size(), value);
  };
  put(0x00, "\x89VOY\r\n\x1a\n\x04");
  put(0x10, "\x40\x01");
  put(0x18, "\x02");
  put(0x1c, "\x01");
  put(0xc4, "\x60\x0d");
  put(0xcc, "\x02");
  put(0xd0, "\x01");
  put(0xd8, "\x20\x01");
  put(0xe0, "\x20");
  put(0xe8, "\x9d\xc9\x71\x90\x1c\x27\x57\xa0\x02");
  put(0xf8, "\x20\x01");
  put(0x108, "\xc2\x94\xd3\x38\x05\x80\x06\x2d");
  put(0x118, "\x6b\x9f\xbd\xac\xfd");
  put(0x11e, "\x01\x85");
  return bytes;
}

// The fixture's flat scene is replaced.
void expect_empty(const Library& voy, const std::string& bytes, VoyResult cut_result) {
  Host host(voy);
  BytesHost empty;
  empty.bytes = bytes;
  const VoyByteSource source = empty.source();
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  desc.source = &source;
  ASSERT_EQ(voy.OpenScene(host.device, &desc, &host.scene), VOY_SUCCESS) << voy.message();
  const VoyViewDesc view_desc = host.view_desc();
  ASSERT_EQ(voy.CreateView(host.device, &view_desc, &host.view), VOY_SUCCESS) << voy.message();
  ASSERT_EQ(host.render(), VOY_SUCCESS) << voy.message();
  for (const float value : host.pixels) ASSERT_EQ(value, 0);
  uint32_t count = 7, node = 7;
  for (const uint32_t capacity : {0u, 1u}) {
    EXPECT_EQ(voy.GetViewCut(host.view, 0, capacity, &node, &count), cut_result) << voy.message();
    EXPECT_EQ(count, cut_result == VOY_SUCCESS ? 0u : 7u);
    EXPECT_EQ(node, 7u);
  }
}

TEST(EmptyScene, OfATreeHasAnEmptyCut) {
  expect_empty(Library(), empty_voy(), VOY_SUCCESS);
}

TEST(EmptyScene, ThatIsFlatHasNone) {
  expect_empty(Library(), ply_bytes(0), VOY_ERROR_UNSUPPORTED);
}

}  // namespace
}  // namespace empty_scene_test
