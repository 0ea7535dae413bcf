#include "tools/view/scene_loader.h"

#include <filesystem>
#include <new>

#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/frame/scene.h"
#include "runtime/scene/import/block_reader.h"
#include "tools/default_camera.h"
#include "tools/view/background_bake.h"
#include "tools/view/bake_cache.h"
#include "tools/view/sample.h"
#include "tools/view/sparse_ply.h"

namespace voyager::view {
namespace {

struct LoadStopped {};

// What opening says of a file that is damaged, or of another version.
bool is_of_the_file(const Refusal& refusal) {
  return refusal.code == ErrorCode::refused_input || refusal.code == ErrorCode::damaged_chunk;
}

}  // namespace

SceneLoader::SceneLoader(const voy::Device& device, LoadRequest request)
    : device_(device), request_(std::move(request)), thread_([this] { run(); }) {}

SceneLoader::~SceneLoader() {
  stopped_ = true;
  thread_.join();
}

LoadProgress SceneLoader::progress() const {
  const std::lock_guard lock(mutex_);
  if (progress_.stage.empty() && ready_) return {"opening", 0, 0};  // it was not taken yet
  return progress_;
}

std::optional<LoadedScene> SceneLoader::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(ready_, std::nullopt);
}

std::optional<Refusal> SceneLoader::take_error() {
  const std::lock_guard lock(mutex_);
  return std::exchange(error_, std::nullopt);
}

std::optional<std::string> SceneLoader::take_note() {
  const std::lock_guard lock(mutex_);
  return std::exchange(note_, std::nullopt);
}

void SceneLoader::run() {
  std::optional<Refusal> error;
  try {
    load();
  } catch (const LoadStopped&) {
  } catch (const std::bad_alloc& problem) {
    error = refusal_of(problem);
    error->text = request_.path + ": " + error->text;
  } catch (const std::exception& problem) {
    error = refusal_of(problem);
  }
  const std::lock_guard lock(mutex_);
  error_ = std::move(error);
  progress_ = {};
}

void SceneLoader::load() {
  std::shared_ptr<const ByteSource> source = open_source(request_.path);
  if (scene_format(*source) == SceneFormat::baked)
    load_baked(request_.path);
  else
    load_flat(std::move(source));
}

void SceneLoader::load_baked(const std::string& file) {
  if (!shown_) camera_ = tools::default_camera(file);
  checkpoint();
  VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
  streaming.memoryBudget = request_.budget;
  streaming.startPosition = camera_.pose.position;
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  desc.next = &streaming;
  desc.path = file.c_str();
  LoadedScene scene = described(device_.open_scene(desc), file);
  scene.gaussians = scene.info.gaussianCount;
  show(std::move(scene));
}

void SceneLoader::load_flat(std::shared_ptr<const ByteSource> source) {
  const std::string bake =
      request_.keep.empty() ? cached_bake(request_.path, *source) : request_.keep;
  if (request_.keep.empty() && load_cached(bake)) return trim_cache(bake);
  gaussians_ = open_blocks(source)->count();
  // Where a small sample takes as long as a large one, the large one is first.
  if (gaussians_ > kMostFlat && sparse_ply(source, 2))
    for (const uint64_t wanted : kFirstSamples) show_sample(source, wanted);
  show_sample(source, kMostFlat);
  source.reset();
  if (request_.keep.empty()) make_cache_folder();
  bake_scene(request_.path, bake, [this](const char* name, uint64_t done, uint64_t total) {
    checkpoint();
    stage(name, done, total);
  });
  if (request_.keep.empty()) trim_cache(bake);
  load_baked(bake);
}

bool SceneLoader::load_cached(const std::string& bake) {
  if (!std::filesystem::exists(bake)) return false;
  try {
    load_baked(bake);
    return true;
  } catch (const std::exception& problem) {
    const Refusal refusal = refusal_of(problem);
    if (!is_of_the_file(refusal)) throw;
    std::filesystem::remove(bake);
    const std::lock_guard lock(mutex_);
    note_ = refusal.text + ": the bake that was kept is of no use, and is made anew";
    return false;
  }
}

// Whole, where it has no more than was wanted.
void SceneLoader::show_sample(const std::shared_ptr<const ByteSource>& source, uint64_t wanted) {
  stage("reading", 0, 0);
  const GaussianCloud cloud = read_sample(source, wanted, [this] { checkpoint(); });
  if (!shown_) camera_ = tools::camera_around(positions(cloud));
  auto memory = std::make_unique<MemoryFile>(source->name() + ", as a .ply", as_ply(cloud));
  const VoyByteSource bytes = memory->source();
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  desc.source = &bytes;
  LoadedScene scene =
      described(device_.open_scene(desc), gaussians_ > kMostFlat ? "" : request_.path);
  scene.memory = std::move(memory);
  scene.gaussians = gaussians_;
  show(std::move(scene));
}

LoadedScene SceneLoader::described(voy::Scene scene, const std::string& file) const {
  LoadedScene loaded;
  loaded.scene = std::move(scene);
  loaded.info = loaded.scene.info();
  loaded.path = request_.path;
  loaded.file = file;
  loaded.camera = camera_;
  return loaded;
}

void SceneLoader::show(LoadedScene scene) {
  checkpoint();
  const std::lock_guard lock(mutex_);
  // One that nobody has taken yet is replaced: the view has still to go to its camera.
  scene.first = !shown_ || (ready_ && ready_->first);
  shown_ = true;
  ready_ = std::move(scene);
}

void SceneLoader::stage(const char* name, uint64_t done, uint64_t total) {
  const std::lock_guard lock(mutex_);
  progress_ = {name, done, total};
}

void SceneLoader::checkpoint() const {
  if (stopped_) throw LoadStopped();
}

}  // namespace voyager::view
