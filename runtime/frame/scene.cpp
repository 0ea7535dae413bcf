#include "runtime/frame/scene.h"

#include <algorithm>
#include <array>

#include "runtime/base/error.h"
#include "runtime/frame/load.h"
#include "runtime/scene/import/importer.h"

namespace voyager {
namespace {

// As a message shows it: "70 6c 79 0a".
std::string hex(std::span<const std::byte> bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::byte b : bytes) {
    if (!text.empty()) text += ' ';
    text += kDigits[std::to_integer<int>(b) >> 4];
    text += kDigits[std::to_integer<int>(b) & 15];
  }
  return text.empty() ? "an empty file" : "first bytes " + text;
}

}  // namespace

SceneFormat scene_format(const ByteSource& source) {
  std::array<std::byte, 64> buffer;
  const std::span<std::byte> first =
      std::span(buffer).first(std::min<uint64_t>(buffer.size(), source.size()));
  source.read(0, first);
  if (SceneFile::is_scene_file(first)) return SceneFormat::baked;
  if (is_importable(first, source.name())) return SceneFormat::flat;
  throw Error(ErrorCode::refused_input, source.name() + ": offset 0: found " +
                                            hex(first.first(std::min<size_t>(8, first.size()))) +
                                            ", expected a .voy, or " +
                                            expected_format(first, source.name()));
}

std::shared_ptr<Scene> load_scene(const std::shared_ptr<const ByteSource>& source,
                                  std::pmr::memory_resource* memory, Workers& workers) {
  auto scene = std::make_shared<Scene>(memory);
  scene->name = source->name();
  if (scene_format(*source) == SceneFormat::baked)
    load_baked(SceneFile(source), workers, *scene);
  else
    load_flat(source, workers, *scene);
  return scene;
}

}  // namespace voyager
