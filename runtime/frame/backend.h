#pragma once
// The boundary behind which backends live: Backend makes one Pipeline for each
// view, which holds the view's state (the last cut, scratch that is kept between frames)
// and runs the stages of a frame in order.
#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/workers.h"
#include "runtime/frame/external_ring.h"
#include "runtime/frame/image.h"
#include "runtime/frame/omission.h"
#include "runtime/frame/scene.h"
#include "runtime/frame/scene_search.h"
#include "runtime/math/clip_box.h"
#include "runtime/math/host_depth.h"
#include "runtime/math/vec.h"

namespace voyager {

// half2: ex2 and what follows it in binary16, two pixels at a time (CUDA only).
enum class Exponential { exact, ex2, lut, half2 };
constexpr bool is_base_2(Exponential exponential) {
  return exponential == Exponential::ex2 || exponential == Exponential::half2;
}
// baseline_3dgs: as 3DGS does it, the baseline of measurements (METHOD §4, §7: boxes of
// 3σ, α' tested against α*).
enum class Splatting { ours, baseline_3dgs };
// on: METHOD §12. off: METHOD §5, 3DGS's own picture. truth: as on, with the lower α* of the
// truth, for the samples of a picture that others are judged by; exact and ex2 only.
enum class Antialias { on, off, truth };
// What tiles draw behind what covered them in the frame before, on CUDA. off: all of it. on:
// nothing, and once more, whole, those that this left open. automatic: as on where that makes fewer
// pairs. No bit of an image depends on it.
enum class Occlusion { automatic, on, off };

// Resolved once, at view creation.
struct PipelineDesc {
  Lod lod = Lod::cut;
  Search search = Search::temporal;
  bool alpha_filter = true;
  Exponential exponential = Exponential::exact;
  uint32_t lut_size = 32;
  Splatting splatting = Splatting::ours;
  Antialias antialias = Antialias::on;
  Occlusion occlusion = Occlusion::automatic;
  uint32_t eyes = 1;          // of each frame, up to kMaxEyes
  bool count_pixels = false;  // fill FrameStats::pixels_..., at a cost; for measurements
};

// One eye's camera. View space: x right, y down, z forward (METHOD §5).
struct Camera {
  Vec3d eye{0, 0, 0};     // world, metres
  Mat3d world_to_view{};  // rows: right, down, forward
  double fx = 0, fy = 0;  // pixels
  double cx = 0, cy = 0;  // pixels, from the top left corner
  uint32_t width = 0, height = 0;
  double near_z = 0.2;  // metres
  // Where these are a scaled instance's coordinates: metres in the world a unit here.
  double depth_scale = 1;
  bool operator==(const Camera&) const = default;
};

// Where an instance stands: x in its scene's axes is position + scale·rotation·x in the world.
struct InstancePose {
  Mat3d rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3d position{0, 0, 0};
  double scale = 1;
};

// What else is told of an instance.
struct InstanceLook {
  float opacity = 1;               // times that of each Gaussian; 0 to 1
  ClipBox<double> clip = kNoClip;  // in its scene's axes, the scene's origin included
};

struct FrameEye {
  Camera camera;
  Image image;  // of the camera's size
  bool depth_wanted = false;
  // In host memory, read by draw(). A splat whose z exceeds the pixel's is not blended there.
  DepthLimits limits;
};

// The eyes share the search: their cut is that of the point amid them, at the smallest τ*.
struct FrameInput {
  std::vector<FrameEye> eyes{1};        // as many as the view has
  std::vector<InstancePose> instances;  // one an instance of the view; none: all at the identity
  std::vector<InstanceLook> looks;      // as many; none: all whole and as opaque as stored
  double tau = 3;
  Vec3f background{0, 0, 0};
  // Of streamed scenes: what is seen is waited for, as far as it can come. stand_in: what cannot
  // is drawn by its ancestors; else the frame fails.
  bool wait_resident = false, stand_in = false;
};

enum Stage { kSearch, kProject, kSort, kBin, kRasterize, kResolve, kStageCount };
inline constexpr const char* kStageNames[kStageCount] = {"search", "project",   "sort",
                                                         "bin",    "rasterize", "resolve"};

struct FrameStats {
  uint64_t frame_index = 0;
  bool searched = false;
  Search search = Search::exhaustive;  // the one that ran, of the first instance with a tree
  bool changes_counted = true;         // entered and left are the searches' own
  double tau = 0;                      // the frame's
  double time_budget = 0;              // milliseconds; 0 where there is none
  bool tau_is_greatest = false;        // as far as the budget may raise it
  float tau_star = 0;
  Vec3f cut_centre{0, 0, 0};  // the first instance's, in its scene's coordinates
  // Sums over the instances, as all that follows; from splats on over the eyes, too.
  uint64_t nodes_total = 0, nodes_tested = 0, subtrees_visited = 0, chunks_read = 0, bytes_read = 0;
  uint64_t cut_size = 0, entered = 0, left = 0;
  uint64_t missing = 0;         // of the cut: stand in for what is not there
  uint64_t bytes_streamed = 0;  // since the view's frame before
  uint64_t bytes_needed = 0;    // stored bytes of chunks that are needed and not there
  uint64_t splats = 0, pairs_before = 0, pairs_after = 0;
  // Pairs, or what would have become pairs, for which a device had no memory; 0 in a whole image.
  uint64_t pairs_dropped = 0;
  uint32_t redraws = 0;        // of the frame, or of its lists, with larger buffers
  uint64_t tiles_redrawn = 0;  // by a second pass, since what the frame before hid is seen
  // (pixel, splat) pairs: whose ρ was found, and that were blended.
  uint64_t pixels_evaluated = 0, pixels_blended = 0;
  uint64_t places_read = 0;     // of pairs_after, that blending came to; counted with the pixels
  uint32_t gaussian_bytes = 0;  // stored, that a device reads of a visible Gaussian, at most
  // What each stage has to move through a device's memory, from its layouts and the counters
  // above; 0 on a host.
  uint64_t bytes[kStageCount] = {};
  double milliseconds[kStageCount] = {};
  double total_milliseconds = 0;
};

using Scenes = std::vector<std::shared_ptr<const Scene>>;

class NodeTrainer;  // node_trainer.h

class Pipeline {
 public:
  virtual ~Pipeline() = default;
  // Runs the stages but for the last and sets what it knows of stats. Reads the images'
  // sizes and formats; only resolve() writes to them, after all else that may fail.
  virtual void draw(const FrameInput& frame, FrameStats& stats) = 0;
  virtual void resolve(const FrameInput& frame, FrameStats& stats) = 0;
  // As draw() and resolve(), into rings of another API, but leaves the frame in flight.
  // checked: room that is too small is found out first; else the frame is what it can be.
  // Where it throws, nothing is waited for and nothing signalled.
  virtual void submit(const FrameInput&, bool) {
    throw Error(ErrorCode::unsupported,
                "target: found another API's memory, expected the host's: this pipeline draws "
                "into no other");
  }
  // Adds what is known of the oldest frame in flight. False, and untouched stats, where
  // there is none or, without `wait`, it has not ended. A frame may wait for the host: so `wait`
  // ends after kHostPatience, with Error(timeout), as do draw(), submit() and set_scenes() where
  // they have to wait for frames in flight.
  virtual bool finish(bool, FrameStats&) { return false; }
  // The instances from now on; no frame is in flight. from: of each the one so far whose state it
  // takes over (match_instances.h). The state of the others is freed. Where it throws, nothing has
  // changed.
  virtual void set_scenes(const Scenes& scenes, std::span<const size_t> from) = 0;
  // The search's own entered and left are right for each frame.
  virtual bool counts_changes() const { return false; }
  // An instance's of the last frame, ascending; none where it draws no cut.
  virtual void read_cut(size_t instance, std::pmr::vector<uint32_t>& cut) const = 0;
  // What the last frame that has ended showed of a streamed instance's chunks, if its stream wanted
  // to know.
  virtual const ShownChunks* shown_chunks(size_t) const { return nullptr; }
  // Reading a cut is a copy in memory, and waits for no device.
  virtual bool cut_is_near() const = 0;
  // What the frames so far did without, beside what their scenes do without.
  virtual std::vector<Omission> omissions() const { return {}; }
};

// What a device could do at best. Zero where unknown.
struct DeviceRates {
  double lane_instructions = 0;  // a second
  double bytes = 0;              // of its memory, a second
};

class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::string device_name() const = 0;
  // As VkPhysicalDeviceIDProperties has it; zero for a CPU.
  virtual std::array<uint8_t, 16> device_uuid() const { return {}; }
  virtual DeviceRates rates() const { return {}; }
  // Of a device's own memory; 0 where scenes are in the host's.
  virtual uint64_t memory_bytes() const { return 0; }
  // While the result lives, this thread's calls may change what is current to a device's
  // driver; then all is as it was.
  virtual std::shared_ptr<void> enter() const { return nullptr; }
  virtual ExternalSupport external_support() const { return {}; }
  // Only where external_support() has images. Memory and semaphores are the result's.
  virtual std::unique_ptr<ExternalRing> import_ring(ExternalRingDesc&&) const { return nullptr; }
  // scenes: one an instance, up to kMaxInstances; a scene may be several. Throws
  // Error(unsupported) for a choice that the backend lacks.
  virtual std::unique_ptr<Pipeline> create_pipeline(const Scenes& scenes, const PipelineDesc& desc,
                                                    std::pmr::memory_resource* memory,
                                                    Workers& workers) = 0;
  // Where the chunks of a streamed scene lie, whose description is complete. The scene outlives
  // the pool. Throws Error(over_budget), std::bad_alloc.
  virtual std::unique_ptr<ChunkPool> create_pool(Scene& scene,
                                                 const std::shared_ptr<const SceneFile>& file,
                                                 SlotShape shape, PoolRoom room);
  // What that takes of the memory that a budget for streaming bounds, and each instance in a view.
  virtual RoomBytes room_bytes(const Scene& scene, SlotShape shape) const;
  // Of a resident scene with a tree, which stays as it is. Throws Error(unsupported) where the
  // backend has none, Error(over_budget).
  virtual std::unique_ptr<NodeTrainer> create_trainer(const std::shared_ptr<const Scene>& scene,
                                                      Workers& workers);
  // The search of the scene's cut that runs where `asked` is asked for; never Search::fastest.
  virtual Search search_for(const Scene&, Search asked) const { return without_sweep(asked); }
  // The scene has a tree. Throws Error(unsupported) where the backend has no such search.
  virtual std::unique_ptr<SceneSearch> create_search(std::shared_ptr<const Scene> scene,
                                                     const SearchDesc& desc,
                                                     std::pmr::memory_resource* memory,
                                                     Workers& workers) = 0;
};

inline constexpr uint32_t kMaxImageSide =
    16384;  // pixels; 2^20 tiles of 16 x 16 then fit a 32-bit key
// Of a view. Each costs a search, a projection and their launches, however little it draws.
inline constexpr uint32_t kMaxInstances = 64;
inline constexpr uint32_t kMaxEyes = 2;

}  // namespace voyager
