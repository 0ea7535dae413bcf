/* Voyager: city-scale 3D Gaussian scenes in an engine's frame loop.
 *
 * The C ABI, C99. docs/abi.md explains the life of a frame; docs/conventions.md
 * has axes, units and colour space. In short: metres, seconds, radians nowhere
 * (a frustum is four tangents), poses as in OpenXR (x right, y up, -z forward),
 * colours are display-referred code values, premultiplied.
 *
 * Every struct starts with `type` and `next`, but for VoyPose and VoyFrustum, which
 * are plain values inside others, as XrPosef and XrFovf are, and never change.
 * `type` must be the struct's own enumerant and `next` NULL or a struct that the
 * call knows: anything else is VOY_ERROR_INVALID_STRUCTURE, so that a request is
 * never ignored silently. The VOY_..._INIT macros fill `type` and the defaults.
 *
 * Every call returns a VoyResult: 0 is success, positive a qualified success,
 * negative an error whose text voyGetLastErrorMessage has. On error, outputs
 * are untouched unless the function says otherwise. No call aborts or throws.
 *
 * Handles are checked: NULL, stale and wrong-kind handles give
 * VOY_ERROR_INVALID_HANDLE. Destroying a parent destroys its children, whose
 * handles are then stale (as in OpenXR).
 *
 * Thread-safety: any call may come from any thread. Calls on different objects
 * run concurrently. A view renders one frame at a time: a call on a view that
 * is busy in another thread returns VOY_ERROR_BUSY and changes nothing.
 * Destruction waits for calls in flight on that object; a callback may therefore
 * not destroy an object of its own device. */
#ifndef VOYAGER_VOYAGER_H_
#define VOYAGER_VOYAGER_H_

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define VOY_API __attribute__((visibility("default")))
#else
#define VOY_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The API version this header describes: major << 22 | minor << 12 | patch.
 * While the major version is 0, a library serves the hosts that were built against
 * the same minor version, and no others. From 1 on, it serves those of the same
 * major version and a minor version up to its own. The patch version never matters. */
#define VOY_MAKE_VERSION(major, minor, patch) \
  ((UINT32_C(0x400000) * (major)) | (UINT32_C(0x1000) * (minor)) | (UINT32_C(1) * (patch)))
#define VOY_API_VERSION VOY_MAKE_VERSION(0, 3, 0)

typedef enum VoyResult {
  VOY_SUCCESS = 0,
  VOY_INCOMPLETE =
      1, /* the array was too short: it was filled, and count says how many there are */
  VOY_ERROR_INVALID_ARGUMENT = -1,
  VOY_ERROR_INVALID_HANDLE = -2,
  VOY_ERROR_INVALID_STRUCTURE = -3, /* wrong type, or a next that the call does not know */
  VOY_ERROR_INCOMPATIBLE_VERSION = -4,
  VOY_ERROR_UNSUPPORTED = -5, /* a mode that this build or backend lacks; the message names it */
  VOY_ERROR_OUT_OF_HOST_MEMORY = -6,
  VOY_ERROR_OVER_BUDGET = -7,
  VOY_ERROR_FILE_NOT_FOUND = -8,
  VOY_ERROR_IO = -9,
  VOY_ERROR_REFUSED_INPUT = -10, /* a malformed file: the message has place, found, expected */
  VOY_ERROR_DAMAGED_CHUNK = -11, /* a chunk that this frame needs is damaged; nothing was drawn */
  VOY_ERROR_NO_DEVICE = -12,
  VOY_ERROR_BUSY = -13,
  VOY_ERROR_SCENE_DESTROYED = -14, /* a scene that the view draws is gone; destroy the view */
  VOY_ERROR_INTERNAL = -15,        /* a bug of ours: please report the message */
  VOY_ERROR_DEVICE_LOST = -16,     /* a GPU stopped working: destroy the device and what is on it */
  VOY_ERROR_TIMEOUT = -17,         /* what the host promised to signal did not come */
  VOY_RESULT_MAX_ENUM = 0x7fffffff
} VoyResult;

typedef enum VoyStructureType {
  VOY_STRUCTURE_TYPE_DEVICE_DESC = 1,
  VOY_STRUCTURE_TYPE_CAPABILITIES = 2,
  VOY_STRUCTURE_TYPE_SCENE_DESC = 3,
  VOY_STRUCTURE_TYPE_BYTE_SOURCE = 4,
  VOY_STRUCTURE_TYPE_SCENE_INFO = 5,
  VOY_STRUCTURE_TYPE_SCENE_NOTE = 6,
  VOY_STRUCTURE_TYPE_VIEW_DESC = 7,
  VOY_STRUCTURE_TYPE_TARGET_DESC = 8,
  VOY_STRUCTURE_TYPE_FRAME = 9,
  VOY_STRUCTURE_TYPE_FRAME_STATS = 10,
  VOY_STRUCTURE_TYPE_ALLOCATOR = 11,
  VOY_STRUCTURE_TYPE_FRAME_EYE = 12,
  VOY_STRUCTURE_TYPE_INSTANCE_POSE = 13,
  VOY_STRUCTURE_TYPE_EYE_DEPTH_LIMIT = 14,
  /* voyager_vulkan.h */
  VOY_STRUCTURE_TYPE_VULKAN_PHYSICAL_DEVICE = 15,
  VOY_STRUCTURE_TYPE_VULKAN_REQUIREMENTS = 16,
  VOY_STRUCTURE_TYPE_VULKAN_DEVICE_DESC = 17,
  VOY_STRUCTURE_TYPE_VULKAN_CAPABILITIES = 18,
  VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_IMAGE = 19,
  VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_SEMAPHORES = 20,
  VOY_STRUCTURE_TYPE_VULKAN_TARGET_DESC = 21,
  VOY_STRUCTURE_TYPE_VULKAN_IMAGE = 22,
  VOY_STRUCTURE_TYPE_VULKAN_FRAME = 23,
  VOY_STRUCTURE_TYPE_VULKAN_USE = 24,
  VOY_STRUCTURE_TYPE_VULKAN_COPY = 25,
  VOY_STRUCTURE_TYPE_VULKAN_DEPTH_LIMIT = 26,
  VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DESC = 27,
  VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DRAW = 28,
  VOY_STRUCTURE_TYPE_TIME_BUDGET = 29,
  VOY_STRUCTURE_TYPE_SCENE_STREAMING = 30,
  VOY_STRUCTURE_TYPE_FRAME_STREAMING = 31,
  VOY_STRUCTURE_TYPE_STREAMING_STATS = 32,
  VOY_STRUCTURE_TYPE_SCENE_PROFILE = 33,
  VOY_STRUCTURE_TYPE_OMISSION = 34,
  VOY_STRUCTURE_TYPE_MAX_ENUM = 0x7fffffff
} VoyStructureType;

typedef struct VoyDevice_T* VoyDevice;
typedef struct VoyScene_T* VoyScene;
typedef struct VoyView_T* VoyView;
typedef struct VoyTarget_T* VoyTarget;

/* ------------------------------------------------------------------ library */

/* The library's version, as VOY_MAKE_VERSION packs it. */
VOY_API uint32_t voyGetVersion(void);

/* The enumerant's name, "VOY_ERROR_..."; never NULL. Static storage. */
VOY_API const char* voyResultString(VoyResult result);

/* What was wrong with this thread's last call that failed, and what would be
 * right. Never NULL; "" before any failure. Valid until this thread's next call. */
VOY_API const char* voyGetLastErrorMessage(void);

/* ------------------------------------------------------------------- device */

typedef enum VoyBackend {
  VOY_BACKEND_AUTO = 0, /* CUDA where it is to be had, else CPU; the log says why (INFO) */
  VOY_BACKEND_CPU = 1,
  VOY_BACKEND_CUDA = 2,      /* libvoyager_cuda.so beside the library, a driver and a device */
  VOY_BACKEND_REFERENCE = 3, /* float64, slow: the judge of the others */
  VOY_BACKEND_MAX_ENUM = 0x7fffffff
} VoyBackend;

typedef enum VoyLogLevel {
  VOY_LOG_ERROR = 0,
  VOY_LOG_WARNING = 1,
  VOY_LOG_INFO = 2,
  VOY_LOG_LEVEL_MAX_ENUM = 0x7fffffff
} VoyLogLevel;

/* Called on the thread of the call that logs, never from a thread of ours.
 * The message is valid during the call. Must not call back into this device. */
typedef void (*VoyLogFunction)(void* user, VoyLogLevel level, const char* message);

/* Scene data, cut state and frame buffers are allocated here; small fixed-size
 * bookkeeping is not. Called from any thread, several at once, worker threads
 * included. allocate returns `size` bytes aligned to `alignment` (a power of
 * two), or NULL, which the call in progress reports as OUT_OF_HOST_MEMORY.
 * release gets the size and alignment of the allocation. Both must stay callable
 * until the device is destroyed, or, where the host forgets that, until the library
 * is unloaded, which destroys what is left. */
typedef struct VoyAllocator {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_ALLOCATOR */
  const void* next;
  void* user;
  void* (*allocate)(void* user, size_t size, size_t alignment);
  void (*release)(void* user, void* memory, size_t size, size_t alignment);
} VoyAllocator;

typedef struct VoyDeviceDesc {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_DEVICE_DESC */
  const void* next;
  uint32_t apiVersion; /* VOY_API_VERSION of the header that the host was built with */
  VoyBackend backend;
  /* 16 bytes as VkPhysicalDeviceIDProperties has them, or NULL for any; zeros are a CPU.
   * AUTO is CUDA on the device that has it, and the CPU where there is none (another
   * maker's device, say). The other backends are refused where it is not theirs. */
  const uint8_t* deviceUuid;
  /* Bytes that scene data may occupy in host memory, over all scenes of this device; 0 is
   * no limit. */
  uint64_t memoryBudget;
  /* The same for streamed scenes in CUDA's own memory. The copies that CUDA makes of scenes that
   * are loaded whole are not counted. Without meaning for the other backends. */
  uint64_t deviceMemoryBudget;
  uint32_t workerThreads; /* 1 to 1024, no more than there are processors; 0 is one a processor */
  VoyLogLevel logLevel;   /* the most verbose level wanted */
  VoyLogFunction log;     /* or NULL */
  void* logUser;
  const VoyAllocator* allocator; /* or NULL for malloc; the struct is copied */
} VoyDeviceDesc;
#define VOY_DEVICE_DESC_INIT                                                                \
  {                                                                                         \
    VOY_STRUCTURE_TYPE_DEVICE_DESC, NULL, VOY_API_VERSION, VOY_BACKEND_AUTO, NULL, 0, 0, 0, \
        VOY_LOG_WARNING, NULL, NULL, NULL                                                   \
  }

/* VOY_SUCCESS if voyCreateDevice can make this backend here, on any device; else
 * VOY_ERROR_NO_DEVICE and the message says why. AUTO can always be made. Asking for CUDA
 * loads its module, and what its run-time sets up stays until the process ends. */
VOY_API VoyResult voyQueryBackend(VoyBackend backend);

/* Errors: INCOMPATIBLE_VERSION, NO_DEVICE (no such backend or UUID: never for AUTO),
 * INVALID_ARGUMENT, OVER_BUDGET (CUDA: the device's memory is full). */
VOY_API VoyResult voyCreateDevice(const VoyDeviceDesc* desc, VoyDevice* device);

/* Destroys its scenes, views and targets with it. NULL is a no-op that succeeds,
 * here and in every destroy call. */
VOY_API VoyResult voyDestroyDevice(VoyDevice device);

/* Bit masks: 1 << enumerant. */
typedef struct VoyCapabilities {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_CAPABILITIES */
  void* next;
  VoyBackend backend; /* CPU, CUDA or REFERENCE: the one that AUTO chose */
  uint32_t workerThreads;
  char deviceName[256];         /* UTF-8, terminated */
  uint8_t deviceUuid[16];       /* zero for a CPU */
  uint32_t maxInstances;        /* of a view; 64 in this version */
  uint32_t maxEyes;             /* of a view; 2 in this version */
  uint32_t maxWidth, maxHeight; /* pixels */
  uint32_t searches;            /* of VoySearch */
  uint32_t exponentials;        /* of VoyExponential */
  uint32_t splattings;          /* of VoySplatting */
  uint32_t targetKinds;         /* of VoyTargetKind */
  uint32_t colorFormats;        /* of VoyColorFormat */
} VoyCapabilities;
#define VOY_CAPABILITIES_INIT                                                                     \
  {                                                                                               \
    VOY_STRUCTURE_TYPE_CAPABILITIES, NULL, VOY_BACKEND_AUTO, 0, {0}, {0}, 0, 0, 0, 0, 0, 0, 0, 0, \
        0                                                                                         \
  }

VOY_API VoyResult voyGetCapabilities(VoyDevice device, VoyCapabilities* capabilities);

/* -------------------------------------------------------------------- scene */

/* Bytes that the host supplies: a pak file, an asset bundle, memory.
 * read fills `size` bytes from `offset` (in range) and returns VOY_SUCCESS, or
 * an error, which the call in progress reports as VOY_ERROR_IO. The same read may
 * be tried again later, but not after VOY_ERROR_FILE_NOT_FOUND and
 * VOY_ERROR_REFUSED_INPUT, which say that it is no use. It may be called
 * from any thread, several at once, from voyOpenScene until voyDestroyScene (or
 * voyDestroyDevice) returns: read, user and the bytes must stay valid that long.
 * Where voyOpenScene fails, until it returns. */
typedef struct VoyByteSource {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_BYTE_SOURCE */
  const void* next;
  const char* name; /* what messages call it; copied; may be NULL */
  uint64_t size;    /* bytes */
  void* user;
  VoyResult (*read)(void* user, uint64_t offset, uint64_t size, void* into);
} VoyByteSource;
#define VOY_BYTE_SOURCE_INIT \
  { VOY_STRUCTURE_TYPE_BYTE_SOURCE, NULL, NULL, 0, NULL, NULL }

/* In VoySceneDesc.next: of a .voy only what frames need is in memory, chunk by chunk, and comes
 * while frames are drawn; other formats are loaded whole all the same. What has not come yet is
 * drawn by its nearest ancestors, so that a frame waits for nothing and has no hole
 * (VoyFrameStreaming changes that). A streamed scene is searched by STREAMING or a TEMPORAL
 * search, and drawn as a cut. docs/streaming.md has the rest.
 * Threads of ours read the bytes, also while no call is in progress, from voyOpenScene until
 * voyDestroyScene (or voyDestroyDevice) returns. */
typedef struct VoySceneStreaming {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_SCENE_STREAMING */
  const void* next;
  /* Bytes that the scene may take where it is drawn: VoyDeviceDesc.memoryBudget's, on CUDA
   * deviceMemoryBudget's. 0, or more than is left of that: what is left. */
  uint64_t memoryBudget;
  /* Where the first frames will look from: x, y, z in the scene's coordinates, or NULL. What
   * voyOpenScene reads is then what is large from there, beside the top of the tree, up to 64 MB
   * of the file. Each below 1e18 in magnitude; copied. */
  const double* start;
  uint32_t readerThreads; /* that read and decode; 0 to 64, 0 is 4 */
  uint32_t reserved;      /* 0 */
} VoySceneStreaming;
#define VOY_SCENE_STREAMING_INIT \
  { VOY_STRUCTURE_TYPE_SCENE_STREAMING, NULL, 0, NULL, 0, 0 }

/* Exactly one of path and source. The format is told from the bytes: .voy (with
 * its tree), or a flat scene (.ply, .spz), which draws every Gaussian. */
typedef struct VoySceneDesc {
  VoyStructureType type;       /* VOY_STRUCTURE_TYPE_SCENE_DESC */
  const void* next;            /* NULL or a VoySceneStreaming */
  const char* path;            /* UTF-8; copied: a file, or an http:// or https:// URL */
  const VoyByteSource* source; /* the struct is copied; its user must live as long as the scene */
} VoySceneDesc;
#define VOY_SCENE_DESC_INIT \
  { VOY_STRUCTURE_TYPE_SCENE_DESC, NULL, NULL, NULL }

/* Errors: FILE_NOT_FOUND, IO, REFUSED_INPUT, OVER_BUDGET, OUT_OF_HOST_MEMORY;
 * UNSUPPORTED for a URL where libvoyager_http.so is missing (docs/streaming.md).
 * A damaged chunk of a .voy does not fail the opening: frames that need it do. But the top of
 * a streamed scene's tree is read here, and DAMAGED_CHUNK where it cannot be. OVER_BUDGET: of a
 * streamed scene, the budget has no room for that top; the message says what it takes. */
VOY_API VoyResult voyOpenScene(VoyDevice device, const VoySceneDesc* desc, VoyScene* scene);

/* Changes VoySceneStreaming.memoryBudget. All but the top of the tree is dropped, and comes again
 * as frames need it. Waits for frames that draw the scene. UNSUPPORTED where it is not streamed;
 * OVER_BUDGET as in voyOpenScene, and nothing has changed then. */
VOY_API VoyResult voySetSceneMemoryBudget(VoyScene scene, uint64_t bytes);

/* Waits for frames that draw it, and frees its memory. Every call on a view with an
 * instance of it then returns VOY_ERROR_SCENE_DESTROYED, but for voyDestroyView. */
VOY_API VoyResult voyDestroyScene(VoyScene scene);

typedef enum VoySceneStorage {
  VOY_SCENE_STORAGE_FLAT = 0, /* no tree */
  VOY_SCENE_STORAGE_LOSSLESS = 1,
  VOY_SCENE_STORAGE_COMPACT = 2,
  VOY_SCENE_STORAGE_MAX_ENUM = 0x7fffffff
} VoySceneStorage;

typedef struct VoySceneInfo {
  VoyStructureType type;  /* VOY_STRUCTURE_TYPE_SCENE_INFO */
  void* next;             /* NULL or a VoySceneProfile */
  uint64_t gaussianCount; /* the scene's own: the leaves of a tree */
  uint64_t nodeCount;     /* 0 for a flat scene */
  uint32_t treeDepth;     /* levels; 0 for a flat scene */
  uint32_t chunkCount;
  uint32_t damagedChunkCount;
  uint32_t shDegree; /* 0-3, of what is kept: bands that are zero everywhere are not */
  VoySceneStorage storage;
  uint32_t antialiased; /* 1: the input says it was trained with the antialiased low-pass */
  double origin[3];     /* world position of the scene-local zero, metres */
  double boundsMin[3];  /* world metres: means ± 3·max(s) */
  double boundsMax[3];
  uint64_t residentBytes; /* of scene data, as VoyDeviceDesc.memoryBudget counts it */
  uint64_t droppedCount;  /* Gaussians left out at import because they were impossible */
  uint64_t repairedCount; /* Gaussians mended at import, one for each attribute (scale,
                             rotation, opacity, SH) that was */
  double positionError;   /* compact storage: largest error of a mean, metres; else 0 */
} VoySceneInfo;
#define VOY_SCENE_INFO_INIT                                                                      \
  {                                                                                              \
    VOY_STRUCTURE_TYPE_SCENE_INFO, NULL, 0, 0, 0, 0, 0, 0, VOY_SCENE_STORAGE_FLAT, 0, {0, 0, 0}, \
        {0, 0, 0}, {0, 0, 0}, 0, 0, 0, 0                                                         \
  }

/* In VoySceneInfo.next: what decides what is stored, loaded and launched for a scene
 * (docs/omissions.md). type and next must be set; the rest is written. */
typedef struct VoySceneProfile {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_SCENE_PROFILE */
  void* next;
  uint32_t inputShDegree; /* what the input had: at least VoySceneInfo.shDegree */
  uint32_t merged;        /* 1: a tree with nodes that stand for several Gaussians */
  uint32_t interpolated;  /* 1: cuts of it draw nodes between their parents and themselves */
  uint32_t streamed;      /* 1: opened with VoySceneStreaming; 0: all of it is in memory */
  /* 1: all Gaussians were looked at. 0, of a streamed scene: what follows is 0, not known. */
  uint32_t complete;
  uint32_t reserved;                         /* 0 */
  uint64_t chunksByShDegree[4];              /* chunks by the SH degree that they use */
  uint64_t opacitiesAboveOne;                /* Gaussians; only merged ones have such */
  float leastAnisotropy, greatestAnisotropy; /* longest axis over shortest; 0 without Gaussians */
} VoySceneProfile;
#define VOY_SCENE_PROFILE_INIT \
  { VOY_STRUCTURE_TYPE_SCENE_PROFILE, NULL, 0, 0, 0, 0, 0, 0, {0, 0, 0, 0}, 0, 0, 0 }

VOY_API VoyResult voyGetSceneInfo(VoyScene scene, VoySceneInfo* info);

typedef enum VoySceneNoteKind {
  VOY_SCENE_NOTE_OMITTED = 0,  /* what this scene does not need and so does not pay for */
  VOY_SCENE_NOTE_REPAIRED = 1, /* Gaussians of which one attribute was mended at import */
  VOY_SCENE_NOTE_DROPPED = 2,  /* Gaussians left out at import */
  VOY_SCENE_NOTE_DAMAGED = 3,  /* chunks that cannot be read */
  VOY_SCENE_NOTE_KIND_MAX_ENUM = 0x7fffffff
} VoySceneNoteKind;

typedef struct VoySceneNote {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_SCENE_NOTE */
  void* next;
  VoySceneNoteKind kind;
  uint32_t reserved;
  uint64_t count; /* Gaussians (REPAIRED, DROPPED) or chunks (DAMAGED); 0 for OMITTED */
  uint64_t bytes; /* saved, for OMITTED; else 0 */
  char what[64];  /* UTF-8, terminated */
  char why[192];
} VoySceneNote;

/* What was left out, mended, dropped or damaged: a note for each kind and cause, so a
 * Gaussian of which two attributes were mended counts in two of them.
 * capacity 0: only *count is set. Otherwise up to capacity notes are written
 * (their type and next are set by the call), *count is how many there are, and the
 * result is VOY_INCOMPLETE if that is more. */
VOY_API VoyResult voyGetSceneNotes(VoyScene scene, uint32_t capacity, VoySceneNote* notes,
                                   uint32_t* count);

/* Since the scene was opened, but for what is of the latest frames. */
typedef struct VoyStreamingStats {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_STREAMING_STATS */
  void* next;
  uint64_t budgetBytes;           /* that the scene takes of its budget: slots and tables */
  uint64_t slots, residentChunks; /* room, and what is there */
  uint64_t neededChunks;          /* by the latest frames, whatever the budget */
  uint64_t missingChunks;         /* of these, not there */
  uint64_t missingBytes;          /* and what they take in the file */
  uint64_t seenChunks;            /* of those needed: within an eye's frustum and the margin */
  uint64_t seenMissingChunks;     /* of these, not there: 0 in a frame that shows nothing coarse */
  uint64_t requested, arrived;    /* chunks */
  uint64_t late;    /* of those that arrived: a frame had looked where they were not yet */
  uint64_t evicted; /* to make room */
  uint64_t flushed; /* that nobody wanted any more before they had arrived */
  uint64_t reads, bytesRead;
  uint64_t failures; /* reads that failed, and chunks that were damaged; each is tried again where
                        that may help. The log names each cause once (WARNING) */
} VoyStreamingStats;
#define VOY_STREAMING_STATS_INIT \
  { VOY_STRUCTURE_TYPE_STREAMING_STATS, NULL, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 }

/* UNSUPPORTED where the scene is not streamed. */
VOY_API VoyResult voyGetStreamingStats(VoyScene scene, VoyStreamingStats* stats);

/* ------------------------------------------------------------------- target */

typedef enum VoyTargetKind {
  VOY_TARGET_KIND_HOST_MEMORY = 0,
  VOY_TARGET_KIND_VULKAN = 1, /* images of a Vulkan host: voyager_vulkan.h */
  VOY_TARGET_KIND_MAX_ENUM = 0x7fffffff
} VoyTargetKind;

/* All hold display-referred code values, as they were blended: what an _SRGB format holds
 * once it has encoded. Copied to such an image they are right; written through a view
 * that encodes, they would be encoded twice. */
typedef enum VoyColorFormat {
  VOY_COLOR_FORMAT_NONE = 0,        /* depth only */
  VOY_COLOR_FORMAT_RGBA8_UNORM = 1, /* code values, rounded to nearest, clamped to [0, 1] */
  VOY_COLOR_FORMAT_RGBA32F = 2,     /* before clamping */
  VOY_COLOR_FORMAT_RGBA16F = 3,     /* the same in binary16, rounded to nearest even; what lies
                                       beyond +-65504 becomes that, so all values are finite */
  VOY_COLOR_FORMAT_MAX_ENUM = 0x7fffffff
} VoyColorFormat;

/* An image that frames are written to. rgb is premultiplied colour + T·background,
 * a is 1 - T (T: transmittance). Rows run top to bottom.
 * Depth is binary32 view-space z in metres of the first splat after which
 * T <= 0.5, +inf where there is none.
 * The memory is the host's: it must stay valid until the target is destroyed, is
 * written only during voyRenderFrame, and only within width x height. */
typedef struct VoyTargetDesc {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_TARGET_DESC */
  const void* next;
  VoyTargetKind kind;
  VoyColorFormat colorFormat;
  uint32_t width, height; /* pixels, 1 to VoyCapabilities.maxWidth/maxHeight */
  void* color;            /* NULL exactly where colorFormat is NONE; aligned to 4 bytes */
  uint64_t colorRowPitch; /* bytes, a multiple of 4; 0 is tightly packed */
  float* depth;           /* or NULL */
  uint64_t depthRowPitch; /* bytes, a multiple of 4; 0 is tightly packed */
} VoyTargetDesc;
#define VOY_TARGET_DESC_INIT                                           \
  {                                                                    \
    VOY_STRUCTURE_TYPE_TARGET_DESC, NULL, VOY_TARGET_KIND_HOST_MEMORY, \
        VOY_COLOR_FORMAT_RGBA8_UNORM, 0, 0, NULL, 0, NULL, 0           \
  }

VOY_API VoyResult voyCreateTarget(VoyDevice device, const VoyTargetDesc* desc, VoyTarget* target);
VOY_API VoyResult voyDestroyTarget(VoyTarget target);

/* --------------------------------------------------------------------- view */

typedef enum VoyLod {
  VOY_LOD_CUT =
      0, /* the level-of-detail cut at tau; a flat scene has none and draws every Gaussian */
  VOY_LOD_ALL_LEAVES = 1, /* every leaf, no search, no interpolation */
  /* Baselines of measurements, without interpolation, of scenes that are loaded whole. */
  VOY_LOD_BLOCKS = 2, /* all of a block of the scene at one depth of the tree, by the block's
                         distance, as CityGaussian does it */
  VOY_LOD_LEVELS = 3, /* by each node's level, log2 of its extent rounded up, and that which its
                         distance asks for, as Octree-GS does it */
  VOY_LOD_MAX_ENUM = 0x7fffffff
} VoyLod;

/* How the cut is found. All searches give the same cut, to the bit; what differs is
 * what they read. */
typedef enum VoySearch {
  VOY_SEARCH_AUTO = 0,           /* TEMPORAL */
  VOY_SEARCH_EXHAUSTIVE = 1,     /* every node: the baseline */
  VOY_SEARCH_STREAMING = 2,      /* chunk by chunk from the top, skipping what the cut is above */
  VOY_SEARCH_TEMPORAL = 3,       /* from the view's last cut, only what may have changed since;
                                    streaming for a view's first frame and where that is cheaper */
  VOY_SEARCH_TEMPORAL_VISIT = 4, /* the same, but visits all of the last cut: for measurements */
  VOY_SEARCH_MAX_ENUM = 0x7fffffff
} VoySearch;

typedef enum VoyExponential {
  VOY_EXPONENTIAL_AUTO = 0,  /* EX2 on CUDA, where VoySplatting is OURS; else EXACT */
  VOY_EXPONENTIAL_EXACT = 1, /* within 2 ulp */
  VOY_EXPONENTIAL_EX2 = 2,   /* base 2, log2(e) folded into the conic */
  VOY_EXPONENTIAL_LUT = 3,   /* table of lutSize + 1 entries, nearest */
  VOY_EXPONENTIAL_HALF2 = 4, /* CUDA only: ex2 and blending in binary16; about 60 dB from exact */
  VOY_EXPONENTIAL_MAX_ENUM = 0x7fffffff
} VoyExponential;

typedef enum VoyAlphaFilter {
  VOY_ALPHA_FILTER_ON = 0,
  VOY_ALPHA_FILTER_OFF = 1, /* the same image to the bit, slower: for measurements */
  VOY_ALPHA_FILTER_MAX_ENUM = 0x7fffffff
} VoyAlphaFilter;

/* How Gaussians become pixels. */
typedef enum VoySplatting {
  VOY_SPLATTING_OURS = 0, /* tiles that the ellipse at the α threshold touches, sorted by depth */
  VOY_SPLATTING_3DGS = 1, /* the baseline of measurements, CUDA only: boxes of 3 sigma, (tile,
                             depth) keys, expf, one pixel a thread */
  VOY_SPLATTING_MAX_ENUM = 0x7fffffff
} VoySplatting;

/* In VoyViewDesc.next, or given to voySetViewTimeBudget: the view chooses tau, frame by frame,
 * so that millisecondsTotal of VoyFrameStats stays within the budget; it aims at nine tenths of
 * it. That is the device's time on CUDA, the call's own on the CPU, without what the host draws.
 * tau starts at VoyViewDesc.tau, brought into the range, and depends on nothing but the times
 * of the view's frames that have ended: the same times give the same tau. While they stay about
 * the aim tau rests. docs/time-budget.md says how it moves. */
typedef struct VoyTimeBudget {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_TIME_BUDGET */
  const void* next;
  double milliseconds; /* a frame, all eyes together; finite, > 0 */
  double leastTau;     /* pixels, finite, >= 0: time to spare is not spent on more than that */
  double greatestTau;  /* pixels, finite, >= leastTau: where more is needed, frames are late */
} VoyTimeBudget;
#define VOY_TIME_BUDGET_INIT \
  { VOY_STRUCTURE_TYPE_TIME_BUDGET, NULL, 0.0, 1.0, 60.0 }

/* The eyes of a view see one cut: that of the point amid them, as fine as the finest of them
 * wants it. Of a scene's data each is read once for both; covariance, colour, order and
 * blending are each eye's own, so that an eye's image is what it would be alone with that cut:
 * to the bit on the CPU and on CUDA. VOY_SPLATTING_3DGS draws one eye.
 *
 * A view draws instances of scenes, sorted together, so that where they overlap the nearer
 * hides the farther; and keeps the cut of each between frames. A scene may be several. */
typedef struct VoyViewDesc {
  VoyStructureType type;  /* VOY_STRUCTURE_TYPE_VIEW_DESC */
  const void* next;       /* NULL or a VoyTimeBudget */
  uint32_t instanceCount; /* 1 to VoyCapabilities.maxInstances; more are UNSUPPORTED */
  const VoyScene* scenes; /* one an instance, of the same device; copied */
  uint32_t eyeCount;      /* 1 to VoyCapabilities.maxEyes, of each frame; more are UNSUPPORTED */
  uint32_t maxWidth, maxHeight; /* pixels: no target of a frame may be larger */
  VoyLod lod;
  double tau; /* granularity in pixels, finite, >= 0; where a time budget starts */
  VoySearch search;
  VoyAlphaFilter alphaFilter;
  VoyExponential exponential;
  uint32_t lutSize; /* intervals, 1 to 4096; 0 is 32 */
  VoySplatting splatting;
} VoyViewDesc;
#define VOY_VIEW_DESC_INIT                                                                   \
  {                                                                                          \
    VOY_STRUCTURE_TYPE_VIEW_DESC, NULL, 0, NULL, 1, 0, 0, VOY_LOD_CUT, 3.0, VOY_SEARCH_AUTO, \
        VOY_ALPHA_FILTER_ON, VOY_EXPONENTIAL_AUTO, 0, VOY_SPLATTING_OURS                     \
  }

/* Errors: INVALID_ARGUMENT, UNSUPPORTED (a choice that VoyCapabilities does not have; a time
 * budget where the view draws a cut of no instance, so that tau changes nothing),
 * OUT_OF_HOST_MEMORY, OVER_BUDGET (CUDA: its own memory has no room for the scene). */
VOY_API VoyResult voyCreateView(VoyDevice device, const VoyViewDesc* desc, VoyView* view);
VOY_API VoyResult voyDestroyView(VoyView view);

/* From the next frame on. tau in pixels, finite, >= 0. Ends a time budget. */
VOY_API VoyResult voySetViewTau(VoyView view, double tau);

/* From the next frame on: sets a time budget, or changes it, and tau goes on from where it is.
 * May be called every frame. Errors: INVALID_ARGUMENT, UNSUPPORTED as in voyCreateView. */
VOY_API VoyResult voySetViewTimeBudget(VoyView view, const VoyTimeBudget* budget);

/* -------------------------------------------------------------------- frame */

/* As XrPosef, in double: position in metres, orientation (x, y, z, w) takes the
 * object's axes (x right, y up, -z forward) to the parent's. The orientation is
 * normalised by the call; zero or non-finite is refused. */
typedef struct VoyPose {
  double position[3];
  double orientation[4];
} VoyPose;

/* Tangents of the half-angles: right and up positive to the right of and above
 * the view axis, left and down normally negative. left < right, down < up, by
 * 1e-6 at least; each between -1e4 and 1e4. */
typedef struct VoyFrustum {
  double left, right, up, down;
} VoyFrustum;

/* From angles in radians as XrFovf has them, each inside ±π/2. INVALID_ARGUMENT where
 * the tangents are not those of a VoyFrustum. */
VOY_API VoyResult voyFovFromAngles(double left, double right, double up, double down,
                                   VoyFrustum* frustum);

/* From pinhole intrinsics in pixels: pixel centres at +0.5, cx and cy measured
 * from the top left corner. INVALID_ARGUMENT where the tangents are not those of a
 * VoyFrustum. */
VOY_API VoyResult voyFovFromIntrinsics(double fx, double fy, double cx, double cy, double width,
                                       double height, VoyFrustum* frustum);

/* Element of an array, so this size is for good: what is added later goes through next. */
typedef struct VoyFrameEye {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_FRAME_EYE */
  const void* next;      /* NULL or a VoyEyeDepthLimit */
  VoyPose pose;          /* in the world */
  VoyFrustum frustum;
  VoyTarget target;  /* of the view's device; its size is the image's. No two eyes have one image:
                        they have targets of one kind, or layers of one target */
  uint32_t layer;    /* of the target's array (voyager_vulkan.h); 0 in host memory */
  uint32_t reserved; /* 0 */
} VoyFrameEye;
/* At the origin, looking along -z; frustum and target are the host's to set. */
#define VOY_FRAME_EYE_INIT \
  { VOY_STRUCTURE_TYPE_FRAME_EYE, NULL, {{0, 0, 0}, {0, 0, 0, 1}}, {0, 0, 0, 0}, NULL, 0, 0 }

/* What a value of a host's depth buffer says. METRES: view-space z, +inf where there is
 * nothing. The others are a projection's depth, d = a + b / z, from 0 to 1: 0 at nearZ and 1
 * at farZ (STANDARD), or 1 at nearZ and 0 at farZ (REVERSED). d is clamped to that range. d of
 * farZ, which buffers are cleared to, is nothing; so is NaN in all of them. */
typedef enum VoyDepthEncoding {
  VOY_DEPTH_ENCODING_METRES = 0,
  VOY_DEPTH_ENCODING_STANDARD = 1,
  VOY_DEPTH_ENCODING_REVERSED = 2,
  VOY_DEPTH_ENCODING_MAX_ENUM = 0x7fffffff
} VoyDepthEncoding;

/* In VoyFrameEye.next: how far the host's opaque geometry is at each pixel of the eye's
 * target. Splats whose centre lies at a greater view-space z than that are not blended in
 * the pixel, nor do they count for its depth: the image is what lies before the geometry,
 * to be composited over the host's picture. The memory is read during voyRenderFrame only.
 * VOY_SPLATTING_3DGS is VOY_ERROR_UNSUPPORTED with it. */
typedef struct VoyEyeDepthLimit {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_EYE_DEPTH_LIMIT */
  const void* next;
  const float* depth;     /* rows from the top, as the target's; aligned to 4 bytes. NULL: what
                             voyRecordVulkanDepthLimit took in, for a target made for that */
  uint64_t depthRowPitch; /* bytes, a multiple of 4; 0 is tightly packed */
  VoyDepthEncoding encoding;
  uint32_t reserved;  /* 0 */
  double nearZ, farZ; /* metres, of the host's projection: 1e-18 <= nearZ <= 1e18, nearZ < farZ,
                         which may be infinite; ignored for METRES */
} VoyEyeDepthLimit;
#define VOY_EYE_DEPTH_LIMIT_INIT \
  { VOY_STRUCTURE_TYPE_EYE_DEPTH_LIMIT, NULL, NULL, 0, VOY_DEPTH_ENCODING_METRES, 0, 0.0, 0.0 }

/* Where an instance stands: a point x of the scene (in its axes, its origin included, as
 * VoySceneInfo.boundsMin has them) is at position + scale·R·x in the world, R being the
 * orientation's rotation of the scene's own axes, whatever these are: VoyPose's (x right, y up)
 * are a habit of eyes. Colours turn with the scene. Element of an array, as VoyFrameEye is.
 * A frame is INVALID_ARGUMENT where the eye comes to lie 1e18 m or more from the origin of an
 * instance's scene, in the scene's own metres. */
typedef struct VoyInstancePose {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_INSTANCE_POSE */
  const void* next;
  VoyPose pose;
  double scale; /* uniform, 1e-9 to 1e9 */
} VoyInstancePose;
/* The identity. */
#define VOY_INSTANCE_POSE_INIT \
  { VOY_STRUCTURE_TYPE_INSTANCE_POSE, NULL, {{0, 0, 0}, {0, 0, 0, 1}}, 1 }

/* In VoyFrame.next: for loading screens, cuts and pictures that must be whole. */
typedef struct VoyFrameStreaming {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_FRAME_STREAMING */
  const void* next;
  /* 1: the call waits until all is there that the frame sees of its streamed scenes, with a margin
   * (docs/streaming.md); the image is then that of the scenes loaded whole, to the bit.
   * OVER_BUDGET where that is more than a budget has room for; the message says what it takes. */
  uint32_t waitResident;
  /* 1: what cannot be had, because it is damaged or cannot be read, is drawn by its ancestors.
   * 0: such a frame fails, if it waits, with what was wrong (DAMAGED_CHUNK, IO). */
  uint32_t standIn;
} VoyFrameStreaming;
#define VOY_FRAME_STREAMING_INIT \
  { VOY_STRUCTURE_TYPE_FRAME_STREAMING, NULL, 0, 0 }

typedef struct VoyFrame {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_FRAME */
  const void* next;      /* NULL or a chain of VoyFrameStreaming and VoyVulkanFrame */
  uint32_t eyeCount;     /* the view's */
  const VoyFrameEye* eyes;
  const VoyInstancePose* instances; /* one an instance, or NULL: all at the identity */
  double nearZ; /* metres in the world, > 0: splats with z <= nearZ are not drawn; 0.2 by default */
  float background[3]; /* code values behind everything, finite */
  uint32_t reserved;   /* 0 */
} VoyFrame;
#define VOY_FRAME_INIT \
  { VOY_STRUCTURE_TYPE_FRAME, NULL, 0, NULL, NULL, 0.2, {0, 0, 0}, 0 }

/* Renders into the targets and returns when they are written; into Vulkan's images, as
 * VoyVulkanFrame says. On error no target is changed. Errors: INVALID_ARGUMENT (values out of
 * range), UNSUPPORTED (a depth limit where the view's splatting has none), SCENE_DESTROYED,
 * DAMAGED_CHUNK, IO, FILE_NOT_FOUND, REFUSED_INPUT (a frame that waits for what cannot be read of a
 * streamed scene: VoyFrameStreaming), OUT_OF_HOST_MEMORY, OVER_BUDGET (CUDA: its own memory has no
 * room for the frame), BUSY, TIMEOUT (a Vulkan target: what the frame waits for was not signalled
 * within 10 s), DEVICE_LOST (CUDA's or Vulkan's device no longer works). */
VOY_API VoyResult voyRenderFrame(VoyView view, const VoyFrame* frame);

/* The last frame's cut of one instance (its index in VoyViewDesc.scenes): node ids in
 * ascending order.
 * capacity 0: only *count is set. Otherwise up to capacity ids are written, *count
 * is the size of the cut, and the result is VOY_INCOMPLETE if that is more.
 * VOY_ERROR_UNSUPPORTED where the view draws no cut of it (flat scene, ALL_LEAVES), and
 * where CUDA drew it and a later frame failed, until the next that does not;
 * VOY_ERROR_INVALID_ARGUMENT before any frame, or for an instance that there is not. */
VOY_API VoyResult voyGetViewCut(VoyView view, uint32_t instance, uint32_t capacity, uint32_t* nodes,
                                uint32_t* count);

/* What a view does without. Element of an array, so this size is for good. */
typedef struct VoyOmission {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_OMISSION */
  void* next;
  uint64_t bytes; /* of memory that is not taken; 0 where that is not known */
  /* What the last frame was spared: the bytes that it would have moved, at the rate that the
   * device's memory has at best, and so the least. 0 where bytes or rate are not known. */
  double milliseconds;
  char what[64]; /* UTF-8, terminated */
  char why[192];
} VoyOmission;

/* What the view's scenes do without (their VOY_SCENE_NOTE_OMITTED, each scene's once), and what
 * the view does without beside that, as far as its frames so far tell (docs/omissions.md).
 * capacity, count and result are as voyGetSceneNotes has them. */
VOY_API VoyResult voyGetViewOmissions(VoyView view, uint32_t capacity, VoyOmission* omissions,
                                      uint32_t* count);

typedef enum VoyStage {
  VOY_STAGE_SEARCH = 0,
  VOY_STAGE_PROJECT = 1,
  VOY_STAGE_SORT = 2,
  VOY_STAGE_BIN = 3,
  VOY_STAGE_RASTERIZE = 4,
  VOY_STAGE_RESOLVE = 5,
  VOY_STAGE_MAX_ENUM = 0x7fffffff
} VoyStage;

typedef enum VoyBudgetState {
  VOY_BUDGET_STATE_NONE = 0,        /* the view had no time budget */
  VOY_BUDGET_STATE_HELD = 1,        /* millisecondsTotal <= timeBudget */
  VOY_BUDGET_STATE_LATE = 2,        /* more than that: tau rises if it stays so */
  VOY_BUDGET_STATE_UNREACHABLE = 3, /* more than that at greatestTau */
  VOY_BUDGET_STATE_MAX_ENUM = 0x7fffffff
} VoyBudgetState;

/* Room for stages in VoyFrameStats, for good; how many there are is its stageCount. */
#define VOY_MAX_STAGES 16

/* Counters are sums over the view's instances; splats and pairs over its eyes, too. */
typedef struct VoyFrameStats {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_FRAME_STATS */
  void* next;
  uint64_t frameIndex; /* of the view, from 0 */
  VoySearch search;   /* the one that ran, STREAMING where TEMPORAL fell back, of the first instance
                         that has a cut; AUTO where none has */
  float tauStar;      /* instance 0's: the target size as used (METHOD §3) */
  float cutCentre[3]; /* instance 0's: scene-local, as used */
  uint32_t stageCount; /* of this library: the entries of milliseconds that are in use */
  uint64_t nodesTotal;
  uint64_t nodesTested; /* evaluations of the predicate */
  uint64_t subtreesVisited;
  uint64_t chunksRead;    /* by the search: that hold a subtree it visited; EXHAUSTIVE: 0 */
  uint64_t bytesRead;     /* by the search, of its records, tables and kept state */
  uint64_t cutSize;       /* nodes, or Gaussians where there is no cut */
  uint64_t entered, left; /* nodes, against the view's last frame */
  uint64_t splats;        /* that reach the image */
  uint64_t pairsBefore;   /* (tile, splat) pairs of the bounding boxes */
  uint64_t pairsAfter;    /* of the ellipses at the α threshold */
  uint64_t pairsDropped;  /* pairs, strips and Gaussians for which a device had no memory;
                             0 in a whole image */
  uint64_t bytesStreamed; /* of streamed scenes, read since the view's last frame */
  uint64_t bytesNeeded;   /* what the file has of chunks that are needed and not there */
  uint64_t missing;       /* cut nodes of size >= tau* that stand in for children not there */
  double milliseconds[VOY_MAX_STAGES]; /* by VoyStage; 0 from stageCount on */
  double millisecondsTotal;
  double tau;        /* as used: voySetViewTau with it gives the same image, to the bit */
  double timeBudget; /* milliseconds, as the frame was drawn; 0 where there was none */
  VoyBudgetState budgetState;
  uint32_t reserved; /* 0 */
} VoyFrameStats;

/* Of the view's last successful frame; VOY_ERROR_INVALID_ARGUMENT before any. Where frames are
 * left under way (Vulkan's images), of the last that has ended: frameIndex says which. It
 * waits for none but the first.
 * type must be set; the rest is written. */
VOY_API VoyResult voyGetFrameStats(VoyView view, VoyFrameStats* stats);

/* "search", "project", ...; NULL for no stage, and so from stageCount on. Static storage. */
VOY_API const char* voyStageName(VoyStage stage);

#ifdef __cplusplus
}
#endif

#endif
