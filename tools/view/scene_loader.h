#pragma once
// Opens a scene on a thread of its own: a .voy is streamed; of a flat scene what can be drawn at
// once comes first, then its bake, which is made where there is none.
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "runtime/base/file.h"
#include "tools/view/loaded_scene.h"
#include "tools/view/refusal.h"

namespace voyager::view {

// Flat scenes of more Gaussians are shown by a sample until they are baked.
inline constexpr uint64_t kMostFlat = 300'000;
// What of them comes first, one after the other: a disk that is slow has little to find at first.
inline constexpr uint64_t kFirstSamples[] = {20'000, 100'000};

struct LoadRequest {
  std::string path;
  uint64_t budget = 0;  // bytes of a streamed scene
  std::string keep;     // where a bake is written; "": the cache
};

struct LoadProgress {
  std::string stage;             // "" when all is done
  uint64_t done = 0, total = 0;  // total 0: not known
};

class SceneLoader {
 public:
  // The device must outlive it.
  SceneLoader(const voy::Device& device, LoadRequest request);
  // Ends the work, as soon as it can be.
  ~SceneLoader();
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;

  const LoadRequest& request() const { return request_; }
  LoadProgress progress() const;
  // The newest that has come since the last call.
  std::optional<LoadedScene> take();
  // Why it could not be opened, or baked; once.
  std::optional<Refusal> take_error();
  // What people are to know of a scene that is opened all the same; once.
  std::optional<std::string> take_note();

 private:
  void run();
  void load();
  void load_baked(const std::string& file);
  void load_flat(std::shared_ptr<const ByteSource> source);
  bool load_cached(const std::string& bake);  // false: there is none that can be opened
  void show_sample(const std::shared_ptr<const ByteSource>& source, uint64_t wanted);
  void show(LoadedScene scene);
  LoadedScene described(voy::Scene scene, const std::string& file) const;
  void stage(const char* name, uint64_t done, uint64_t total);
  void checkpoint() const;  // throws where the work is to end

  const voy::Device& device_;
  const LoadRequest request_;
  uint64_t gaussians_ = 0;
  tools::Camera camera_ = {};
  bool shown_ = false;
  std::atomic<bool> stopped_ = false;
  mutable std::mutex mutex_;
  LoadProgress progress_{"opening", 0, 0};
  std::optional<LoadedScene> ready_;
  std::optional<Refusal> error_;
  std::optional<std::string> note_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace voyager::view
