#include <algorithm>

#include "plugin/byte_source.h"
#include "plugin/call.h"
#include "plugin/streaming.h"
#include "plugin/structs.h"
#include "plugin/text.h"
#include "runtime/base/open_source.h"

using namespace voyager;

namespace {

std::shared_ptr<const ByteSource> source_of(const VoySceneDesc& desc) {
  if ((desc.path == nullptr) == (desc.source == nullptr))
    refuse(std::string("desc: found ") + (desc.path ? "both" : "neither") +
           " of path and source, expected exactly one");
  if (desc.path != nullptr) return open_source(desc.path);
  check_structure(desc.source, VOY_STRUCTURE_TYPE_BYTE_SOURCE, "VoyByteSource");
  if (desc.source->read == nullptr) refuse("desc.source.read: found NULL, expected a function");
  return std::make_shared<HostSource>(*desc.source);
}

VoySceneStorage storage_of(Storage storage) {
  switch (storage) {
    case Storage::lossless:
      return VOY_SCENE_STORAGE_LOSSLESS;
    case Storage::compact:
      return VOY_SCENE_STORAGE_COMPACT;
    case Storage::flat:
      break;
  }
  return VOY_SCENE_STORAGE_FLAT;
}

VoySceneNoteKind kind_of(SceneNote::Kind kind) {
  switch (kind) {
    case SceneNote::Kind::repaired:
      return VOY_SCENE_NOTE_KIND_REPAIRED;
    case SceneNote::Kind::dropped:
      return VOY_SCENE_NOTE_KIND_DROPPED;
    case SceneNote::Kind::damaged:
      return VOY_SCENE_NOTE_KIND_DAMAGED;
    case SceneNote::Kind::omitted:
      break;
  }
  return VOY_SCENE_NOTE_KIND_OMITTED;
}

VoySceneNote note_of(const SceneNote& note) {
  VoySceneNote out = {VOY_STRUCTURE_TYPE_SCENE_NOTE,
                      nullptr,
                      kind_of(note.kind),
                      0,
                      note.count,
                      note.bytes,
                      {},
                      {}};
  put_text(note.what, out.what);
  put_text(note.why, out.why);
  return out;
}

uint32_t damaged_chunks(const Scene& scene) {
  return static_cast<uint32_t>(scene.damaged_chunks.size());
}

void log_opening(const Log& log, const Scene& scene) {
  const std::string tree =
      scene.flat() ? "a flat scene" : std::to_string(scene.node_count) + " nodes in its tree";
  log.write(VOY_LOG_LEVEL_INFO,
            ("voyOpenScene: " + scene.name + ": " + std::to_string(scene.leaf_count) +
             " Gaussians, " + tree + (scene.streamed() ? ", streamed" : ""))
                .c_str());
  for (const SceneNote& note : scene.notes)
    if (note.kind != SceneNote::Kind::omitted)
      log.write(VOY_LOG_LEVEL_WARNING,
                ("voyOpenScene: " + scene.name + ": " + note.what + ": " + note.why).c_str());
}

// But for type and next.
void put_profile(const Scene& scene, VoySceneProfile& out) {
  const SceneProfile& profile = scene.profile;
  out.inputShDegree = static_cast<uint32_t>(profile.input_sh_degree);
  out.merged = profile.merged ? 1 : 0;
  out.interpolated = profile.interpolated ? 1 : 0;
  out.streamed = scene.streamed() ? 1 : 0;
  out.complete = profile.complete ? 1 : 0;
  out.reserved = 0;
  std::copy(profile.chunks_of_degree.begin(), profile.chunks_of_degree.end(), out.chunksByShDegree);
  out.opacitiesAboveOne = profile.opacities_above_one;
  out.minAnisotropy = profile.least_anisotropy;
  out.maxAnisotropy = profile.greatest_anisotropy;
}

VoySceneInfo info_of(const Scene& scene, uint64_t resident_bytes) {
  VoySceneInfo info = VOY_SCENE_INFO_INIT;
  info.gaussianCount = scene.leaf_count;
  info.nodeCount = scene.node_count;
  info.treeDepth = scene.tree_depth;
  info.chunkCount = scene.chunk_count;
  info.damagedChunkCount = damaged_chunks(scene);
  info.shDegree = static_cast<uint32_t>(scene.sh_degree);
  info.storage = storage_of(scene.storage);
  info.trainedAntialiased = scene.native.antialiased() ? 1 : 0;
  for (int i = 0; i < 3; ++i) {
    info.origin[i] = scene.origin[i];
    info.boundsMin[i] = scene.origin[i] + static_cast<double>(scene.bounds_min[i]);
    info.boundsMax[i] = scene.origin[i] + static_cast<double>(scene.bounds_max[i]);
  }
  info.residentBytes = resident_bytes;
  info.droppedGaussianCount = scene.import.dropped();
  info.repairCount = scene.import.repaired();
  info.maxPositionError = scene.position_error;
  info.nativePixel = scene.native.pixel;
  const bool known = scene.native.source != NativeSource::unknown;
  info.pixelFilter = known ? scene.native.low_pass : kLowPass;
  info.nativePixelSource = static_cast<VoyNativePixelSource>(scene.native.source);
  return info;
}

}  // namespace

VoyResult VOY_CALL voyOpenScene(VoyDevice device, const VoySceneDesc* desc, VoyScene* scene) {
  return guarded("voyOpenScene", [&](Call& call) {
    const auto owner = call.use<DeviceObject>(device);
    const VoySceneStreaming* streaming = nullptr;
    check_structure(desc, VOY_STRUCTURE_TYPE_SCENE_DESC, "VoySceneDesc",
                    Extension{VOY_STRUCTURE_TYPE_SCENE_STREAMING, streaming});
    check_pointer(scene, "scene");
    if (streaming != nullptr) check_streaming(*streaming);
    const auto object = std::make_shared<SceneObject>(owner);
    if (streaming != nullptr)
      open_streamed(*object, source_of(*desc), *streaming);
    else
      object->scene = load_scene(source_of(*desc), &object->memory, owner->workers);
    log_opening(owner->log, *object->scene);
    *scene = static_cast<VoyScene>(HandleTable::instance().insert(object));
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyCloseScene(VoyScene scene) {
  return guarded("voyCloseScene", [&](Call& call) {
    for (const auto& object : call.remove<SceneObject>(scene)) {
      // No call holds the scene now, so no view of it can appear any more.
      for (const auto& child : HandleTable::instance().children(*object->parent(), Kind::view)) {
        auto& view = static_cast<ViewObject&>(*child);
        if (!view.draws(object)) continue;
        const std::lock_guard frame(view.state);
        view.lose(object);
      }
      // A view that another thread destroys holds the scene a while longer.
      static_cast<SceneObject&>(*object).stop_reading();
    }
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyGetSceneInfo(VoyScene scene, VoySceneInfo* info) {
  return guarded("voyGetSceneInfo", [&](Call& call) {
    const auto object = call.use<SceneObject>(scene);
    VoySceneProfile* profile = nullptr;
    check_structure(info, VOY_STRUCTURE_TYPE_SCENE_INFO, "VoySceneInfo",
                    Extension{VOY_STRUCTURE_TYPE_SCENE_PROFILE, profile});
    void* const next = info->next;
    *info = info_of(*object->scene, object->memory.counted());
    info->next = next;
    if (profile != nullptr) put_profile(*object->scene, *profile);
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyGetSceneNotes(VoyScene scene, uint32_t capacity, VoySceneNote* notes,
                                    uint32_t* count) {
  return guarded("voyGetSceneNotes", [&](Call& call) {
    const auto object = call.use<SceneObject>(scene);
    check_pointer(count, "count");
    if (capacity > 0) check_pointer(notes, "notes");
    const std::vector<SceneNote>& found = object->scene->notes;
    const size_t written = std::min<size_t>(capacity, found.size());
    std::transform(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(written), notes,
                   note_of);
    *count = static_cast<uint32_t>(found.size());
    return capacity > 0 && written < found.size() ? VOY_INCOMPLETE : VOY_SUCCESS;
  });
}
