/* Voyager draws city-scale 3D Gaussian scenes in an engine's frame loop. This is its C ABI, in C99.
 *
 * docs/abi.md shows the calls in the order in which a host makes them. docs/conventions.md defines
 * axes, units and colours. In short: lengths are metres and a field of view is four tangents.
 * Poses follow OpenXR: x right, y up, -z forward. Colours are premultiplied display-referred
 * code values: they are what a display shows, not linear light.
 *
 * STRUCTS. Every struct starts with `type` and `next`. Start from its VOY_..._INIT macro, which
 * sets `type` and the defaults. `next` is NULL or points to an extension that the comment at
 * `next` names. A wrong `type` or an unknown `next` is VOY_ERROR_INVALID_STRUCTURE, so that a
 * request is never ignored silently. VoyPose and VoyFrustum are plain values without `type`. A
 * zeroed VoyPose or VoyFrustum is refused, so start from VOY_POSE_INIT and VOY_FRUSTUM_INIT.
 * A structure never changes its size or a field: what a later version adds comes through `next`.
 * Fields named `reserved` must be 0.
 *
 * PROMISE. What this header and voyager_vulkan.h declare stays as it is until the major version
 * changes. A later version may add enumerators, and a host may meet them in results and in other
 * outputs, so give a switch over an enum a default. voyager_experiment.h is for measurements. It is
 * outside the promise. voyager.hpp is compiled into the host and calls only what is promised, so a
 * host that is built keeps running. The C++ names themselves are not promised: a host that is built
 * again with a later version may have to change.
 *
 * RESULTS. Every call that can fail returns a VoyResult. 0 is success. A positive value is a
 * success with a remark. A negative value is an error, and voyGetLastErrorMessage explains it.
 * After an error the outputs are unchanged unless the function says otherwise. No call aborts the
 * process or throws an exception. The error lists at the functions leave out INVALID_ARGUMENT,
 * INVALID_STRUCTURE and INVALID_HANDLE where these need no explanation. They also leave out BUSY
 * and SCENE_CLOSED of calls on a view or target, and DEVICE_LOST, which any call on a device and
 * its objects may return once a GPU stopped working or a frame never finished. Calls that close or
 * destroy an object still work then.
 *
 * HANDLES. A handle is a number, not an address. A NULL handle, a handle of a destroyed object and
 * a handle of another kind are VOY_ERROR_INVALID_HANDLE. Destroying a parent destroys its children
 * and makes their handles invalid, as in OpenXR. A device is the parent of its scenes, views,
 * targets and composites (voyager_vulkan.h).
 *
 * OWNERSHIP. The library copies what a descriptor points to before the call returns, unless the
 * comment at the field says how long the host must keep it. Strings that functions return have
 * static storage unless the function says otherwise.
 *
 * THREAD-SAFETY. Any function may be called from any thread. Calls on different objects run
 * concurrently. A view or a target works for one call at a time: a second call from another thread
 * returns VOY_ERROR_BUSY and changes nothing, unless the function says otherwise. Destroying an
 * object waits for the calls in progress that use it. A callback must therefore not destroy an
 * object of its own device.
 *
 * Where a comment writes METHOD and a section number, it means docs/method.md, which derives the
 * formula. */
#ifndef VOYAGER_VOYAGER_H_
#define VOYAGER_VOYAGER_H_

#include <stddef.h>
#include <stdint.h>

/* VOY_API exports a function from the library and imports it into a host. VOY_CALL is the calling
 * convention of every function and callback. Define your callbacks with VOY_CALL.
 * VOYAGER_BUILDS_LIBRARY is defined only while the library itself is built.
 * This version runs on Linux. The Windows definitions fix the ABI for a later version. */
#if defined(_WIN32)
#if defined(VOYAGER_BUILDS_LIBRARY)
#define VOY_API __declspec(dllexport)
#else
#define VOY_API __declspec(dllimport)
#endif
#define VOY_CALL __stdcall
#else
#if defined(__GNUC__)
#define VOY_API __attribute__((visibility("default")))
#else
#define VOY_API
#endif
#define VOY_CALL /* nothing: the convention is the compiler's own here */
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* A version is packed as major << 22 | minor << 12 | patch. */
#define VOY_MAKE_VERSION(major, minor, patch) \
  ((UINT32_C(0x400000) * (major)) | (UINT32_C(0x1000) * (minor)) | (UINT32_C(1) * (patch)))
/* The version of this header. A library accepts hosts that were built against the same major
 * version and its own minor version or an older one. The patch version never matters. */
#define VOY_API_VERSION VOY_MAKE_VERSION(1, 0, 0)

/* The numbers never change. docs/abi.md says what a host can do about each error. */
typedef enum VoyResult {
  VOY_SUCCESS = 0,
  VOY_INCOMPLETE = 1, /* the array was filled but was too short; *count is the full count */
  VOY_ERROR_INVALID_ARGUMENT = -1,     /* the message names the value and the range */
  VOY_ERROR_INVALID_HANDLE = -2,       /* NULL, of a destroyed object, or of another kind */
  VOY_ERROR_INVALID_STRUCTURE = -3,    /* a wrong `type` or an unknown `next` */
  VOY_ERROR_INCOMPATIBLE_VERSION = -4, /* host and library are of different versions */
  VOY_ERROR_UNSUPPORTED = -5, /* this build or backend lacks the mode that the message names */
  VOY_ERROR_OUT_OF_HOST_MEMORY = -6,
  VOY_ERROR_OVER_BUDGET = -7, /* a memory budget, or the memory of a GPU, is too small */
  VOY_ERROR_FILE_NOT_FOUND = -8,
  VOY_ERROR_IO = -9,             /* reading failed */
  VOY_ERROR_REFUSED_INPUT = -10, /* a malformed file; the message says where and why */
  VOY_ERROR_DAMAGED_CHUNK = -11, /* this frame needs a damaged chunk; nothing was drawn */
  VOY_ERROR_NO_DEVICE = -12,     /* the backend finds no device that it can use */
  VOY_ERROR_BUSY = -13,          /* another thread uses the view or target */
  VOY_ERROR_SCENE_CLOSED = -14,  /* a scene of the view was closed; give it other instances */
  VOY_ERROR_INTERNAL = -15,      /* a bug, or a driver's call that failed: the message says which */
  VOY_ERROR_DEVICE_LOST = -16,   /* a GPU stopped working; destroy the VoyDevice */
  VOY_ERROR_TIMEOUT = -17,       /* the host did not signal what the frame waits for */
  VOY_RESULT_MAX_ENUM = 0x7fffffff
} VoyResult;

/* The value that the field `type` of a structure has: VOY_STRUCTURE_TYPE_FRAME in a VoyFrame.
 * Structures with VULKAN in the name are in voyager_vulkan.h, those with EXPERIMENT in
 * voyager_experiment.h. */
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
  VOY_STRUCTURE_TYPE_DEVICE_INFO = 35,
  VOY_STRUCTURE_TYPE_VULKAN_REPROJECTION = 36,
  VOY_STRUCTURE_TYPE_EXPERIMENT = 37,
  VOY_STRUCTURE_TYPE_EXPERIMENT_CAPABILITIES = 38,
  VOY_STRUCTURE_TYPE_EXPERIMENT_STATS = 39,
  VOY_STRUCTURE_TYPE_INSTANCE = 40,
  VOY_STRUCTURE_TYPE_MAX_ENUM = 0x7fffffff
} VoyStructureType;

/* What draws: a backend on a GPU or on the CPU, with its memory budgets and threads. Everything
 * else is created from one. voyCreateDevice makes it, voyDestroyDevice ends it. */
typedef struct VoyDevice_T* VoyDevice;
/* An open scene file, which any number of views of its device may draw. voyOpenScene makes it,
 * voyCloseScene ends it. */
typedef struct VoyScene_T* VoyScene;
/* What draws instances of scenes frame after frame, and keeps what one frame can use of the last.
 * voyCreateView makes it, voyDestroyView ends it. */
typedef struct VoyView_T* VoyView;
/* An image, or a ring of Vulkan images, that frames are drawn into. voyCreateTarget makes it,
 * voyDestroyTarget ends it. */
typedef struct VoyTarget_T* VoyTarget;

/* ------------------------------------------------------------------ library */

/* Returns the version of the library, packed by VOY_MAKE_VERSION. */
VOY_API uint32_t VOY_CALL voyGetVersion(void);

/* Returns the name of a result, such as "VOY_ERROR_BUSY". Never NULL. */
VOY_API const char* VOY_CALL voyResultName(VoyResult result);

/* Returns the message of the last call that failed on this thread: what was found and what was
 * expected. UTF-8, never NULL, "" before the first failure. It stays valid until this thread's
 * next call into the library. */
VOY_API const char* VOY_CALL voyGetLastErrorMessage(void);

/* ------------------------------------------------------------------- device */

/* What computes the frames of a device. */
typedef enum VoyBackend {
  VOY_BACKEND_AUTO = 0, /* CUDA where it can be had, else the CPU; the log says why (WARNING) */
  VOY_BACKEND_CPU = 1,
  VOY_BACKEND_CUDA = 2,      /* needs libvoyager_cuda.so beside the library, a driver, a GPU */
  VOY_BACKEND_REFERENCE = 3, /* float64 and slow: the other backends are tested against it */
  VOY_BACKEND_MAX_ENUM = 0x7fffffff
} VoyBackend;

/* How serious a log message is. A lower number is more serious. */
typedef enum VoyLogLevel {
  VOY_LOG_LEVEL_ERROR = 0,   /* a call failed; the message is that of voyGetLastErrorMessage */
  VOY_LOG_LEVEL_WARNING = 1, /* it goes on, but not as asked: AUTO without CUDA, damaged data */
  VOY_LOG_LEVEL_INFO = 2,    /* which device was chosen, which scene was opened */
  VOY_LOG_LEVEL_MAX_ENUM = 0x7fffffff
} VoyLogLevel;

/* Receives log messages. It is called on the host's thread, during a call into the library, and
 * never on a thread of the library. Several host threads may call it at once. `message` is UTF-8
 * and valid during the call. The callback must not call functions on this device's objects. */
typedef void(VOY_CALL* VoyLogFunction)(void* user, VoyLogLevel level, const char* message);

/* Host functions that allocate the large data: scenes, cut state and frame buffers. Small
 * bookkeeping of fixed size does not come from here.
 * Both functions may be called from any thread, worker threads included, and from several at once.
 * They must stay callable until the device is destroyed. If the host never destroys the device,
 * they must stay callable until the library is unloaded, which destroys what is left. */
typedef struct VoyAllocator {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_ALLOCATOR */
  const void* next;
  void* user; /* passed to both functions as it is; may be NULL */
  /* Returns `size` bytes aligned to `alignment`, a power of two. On NULL the call in progress
   * returns VOY_ERROR_OUT_OF_HOST_MEMORY. */
  void*(VOY_CALL* allocate)(void* user, size_t size, size_t alignment);
  /* Frees `memory`, which was allocated with the same size and alignment. */
  void(VOY_CALL* deallocate)(void* user, void* memory, size_t size, size_t alignment);
} VoyAllocator;
/* The host must set both functions. */
#define VOY_ALLOCATOR_INIT \
  { VOY_STRUCTURE_TYPE_ALLOCATOR, NULL, NULL, NULL, NULL }

/* What a device draws with and what it may use: backend, GPU, memory, threads, log, allocator. */
typedef struct VoyDeviceDesc {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_DEVICE_DESC */
  const void* next;      /* NULL or a VoyVulkanDeviceDesc (voyager_vulkan.h) */
  uint32_t apiVersion;   /* VOY_API_VERSION, as the host was built */
  VoyBackend backend;    /* AUTO, or one that voyQueryBackend finds here */
  /* NULL for any device, or 16 bytes as in VkPhysicalDeviceIDProperties.deviceUUID. Sixteen zeros
   * are the CPU. AUTO takes the CUDA device with this UUID, or the CPU if there is none, as with a
   * GPU of another vendor. The other backends return VOY_ERROR_NO_DEVICE if the UUID is not
   * theirs. */
  const uint8_t* deviceUuid;
  /* Bytes of host memory that scene data may take, over all scenes of this device. 0: no limit.
   * It leaves out the directory of a streamed scene and, on CUDA, what the host keeps of one beside
   * the GPU, such as the links between chunks. docs/streaming.md tells how much that is. */
  uint64_t hostMemoryBudget;
  /* Bytes of CUDA device memory that streamed scenes may take, with what views keep of them. 0: no
   * limit. Scenes that are loaded whole are copied to the device without counting here. Other
   * backends ignore it. */
  uint64_t deviceMemoryBudget;
  uint32_t workerThreadCount;    /* 1 to 1024, capped at the number of processors; 0: one each */
  VoyLogLevel logLevel;          /* the most verbose level to log */
  VoyLogFunction log;            /* or NULL */
  void* logUser;                 /* the `user` of each call of `log`; may be NULL */
  const VoyAllocator* allocator; /* NULL: the C++ heap. The struct is copied */
} VoyDeviceDesc;
#define VOY_DEVICE_DESC_INIT                                                                \
  {                                                                                         \
    VOY_STRUCTURE_TYPE_DEVICE_DESC, NULL, VOY_API_VERSION, VOY_BACKEND_AUTO, NULL, 0, 0, 0, \
        VOY_LOG_LEVEL_WARNING, NULL, NULL, NULL                                             \
  }

/* Tells whether voyCreateDevice can create this backend here, on any device. AUTO always can.
 * Asking for CUDA loads the CUDA module and run-time, which stay loaded until the process ends.
 * Errors: NO_DEVICE (the message says why). */
VOY_API VoyResult VOY_CALL voyQueryBackend(VoyBackend backend);

/* A device that voyCreateDevice can be asked for, or a backend that finds no device here. It is the
 * element of an array, so its size never changes. */
typedef struct VoyDeviceInfo {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_DEVICE_INFO */
  void* next;
  VoyBackend backend;            /* CUDA, CPU or REFERENCE */
  uint32_t usable;               /* 1: yes. 0: no, and `why` says why not */
  uint8_t deviceUuid[16];        /* for VoyDeviceDesc.deviceUuid; zero for a CPU */
  uint64_t memoryBytes;          /* the device's own, or the host's; 0 if not known */
  uint32_t workerThreadCount;    /* CPU and REFERENCE: one a processor; else 0 */
  uint32_t computeCapability[2]; /* CUDA: major, minor; else 0 */
  uint32_t cudaVersion;          /* the newest that the driver supports, 1000 * major + 10 * minor;
                                    0 without a driver */
  char driver[64];               /* the driver's release; "" if not known. UTF-8, terminated */
  char deviceName[256];          /* "" where a backend finds no device */
  char needs[192];               /* what the backend needs of a machine */
  char why[512];                 /* why it is not usable, and what to do; "" if it is */
} VoyDeviceInfo;
#define VOY_DEVICE_INFO_INIT                                                                   \
  {                                                                                            \
    VOY_STRUCTURE_TYPE_DEVICE_INFO, NULL, VOY_BACKEND_AUTO, 0, {0}, 0, 0, {0, 0}, 0, {0}, {0}, \
        {0}, {                                                                                 \
      0                                                                                        \
    }                                                                                          \
  }

/* Lists the devices of this machine: CUDA devices in the order of the driver, the CPU, the
 * reference. AUTO takes the first CUDA device if it is usable, else the CPU. A backend that finds
 * no device has one entry, with usable 0. The call loads the CUDA module as voyQueryBackend does.
 * It starts no work on a device, so voyCreateDevice may still fail, for example because the GPU's
 * memory is full. With capacity 0 the call sets only *count. Otherwise it writes up to capacity
 * entries, with their type and next, and sets *count to the number of entries there are. Returns
 * VOY_INCOMPLETE if there are more entries than capacity. Any thread may call it. Errors:
 * INVALID_ARGUMENT (NULL). */
VOY_API VoyResult VOY_CALL voyEnumerateDevices(uint32_t capacity, VoyDeviceInfo* devices,
                                               uint32_t* count);

/* Creates a device. The host destroys it with voyDestroyDevice.
 * Errors: INCOMPATIBLE_VERSION (rebuild the host, see VOY_API_VERSION), NO_DEVICE (no such backend
 * or UUID; never for AUTO), INVALID_ARGUMENT, OVER_BUDGET (CUDA: the GPU's memory is full). */
VOY_API VoyResult VOY_CALL voyCreateDevice(const VoyDeviceDesc* desc, VoyDevice* device);

/* Destroys the device with its scenes, views and targets. Destroying NULL succeeds and does
 * nothing, here and in every voyDestroy... function. */
VOY_API VoyResult VOY_CALL voyDestroyDevice(VoyDevice device);

/* What a device can do. In the bit masks, bit 1 << e stands for the value e of the enum. */
typedef struct VoyCapabilities {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_CAPABILITIES */
  void* next;         /* NULL or a chain of VoyVulkanCapabilities and VoyExperimentCapabilities */
  VoyBackend backend; /* CPU, CUDA or REFERENCE: with AUTO, the choice made */
  uint32_t workerThreadCount; /* that draw on the host: VoyDeviceDesc's, after the cap */
  char deviceName[256];       /* UTF-8, terminated */
  uint8_t deviceUuid[16];     /* zero for a CPU */
  uint32_t maxInstances;      /* in a view; 64 in this version */
  uint32_t maxEyes;           /* in a view; 2 in this version */
  uint32_t maxWidth,          /* of a target and of a view, pixels; 16384 in this version */
      maxHeight;              /* as maxWidth */
  uint32_t targetKinds;       /* bit mask of VoyTargetKind */
  uint32_t colorFormats;      /* bit mask of VoyColorFormat */
} VoyCapabilities;
#define VOY_CAPABILITIES_INIT \
  { VOY_STRUCTURE_TYPE_CAPABILITIES, NULL, VOY_BACKEND_AUTO, 0, {0}, {0}, 0, 0, 0, 0, 0, 0 }

/* Writes what the device can do. The caller sets `type` and `next`. */
VOY_API VoyResult VOY_CALL voyGetCapabilities(VoyDevice device, VoyCapabilities* capabilities);

/* -------------------------------------------------------------------- scene */

/* A scene file whose bytes the host supplies: from a pak file, an asset bundle or memory. */
typedef struct VoyByteSource {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_BYTE_SOURCE */
  const void* next;
  const char* name; /* how messages call the file; UTF-8, copied; may be NULL */
  uint64_t size;    /* of the file, bytes */
  void* user;       /* passed to `read` as it is; may be NULL */
  /* Copies `size` bytes from `offset` to `into`; the range always lies within the file. Returns
   * VOY_SUCCESS or an error. After an error the same read may be tried again, except after
   * VOY_ERROR_FILE_NOT_FOUND and VOY_ERROR_REFUSED_INPUT. The call in progress reports any error
   * as VOY_ERROR_IO.
   * It may be called from any thread, and from several at once. `read`, `user` and the bytes must
   * stay valid until voyCloseScene or voyDestroyDevice returns. If voyOpenScene fails, they must
   * stay valid until it returns. */
  VoyResult(VOY_CALL* read)(void* user, uint64_t offset, uint64_t size, void* into);
} VoyByteSource;
#define VOY_BYTE_SOURCE_INIT \
  { VOY_STRUCTURE_TYPE_BYTE_SOURCE, NULL, NULL, 0, NULL, NULL }

/* In VoySceneDesc.next: streams a .voy file. Only the chunks that frames need are kept in memory,
 * and they are read while frames are drawn. Files of other formats are still loaded whole.
 * A frame never waits for data: where a node's children are not resident yet, the node is drawn in
 * their place, so that the image has no hole. VoyFrameStreaming makes a frame wait.
 * A view of a streamed scene needs VOY_LOD_AUTO or VOY_LOD_CUT.
 * Reader threads of the library read the bytes, also between calls, until voyCloseScene or
 * voyDestroyDevice returns. docs/streaming.md explains the rest. */
typedef struct VoySceneStreaming {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_SCENE_STREAMING */
  const void* next;
  /* Bytes that the scene may take in the memory that it is drawn from. They are part of
   * VoyDeviceDesc.hostMemoryBudget, or of deviceMemoryBudget on CUDA. 0, or more than is left
   * there: all that is left there.
   * What counts is the memory for chunks, the tables of their subtrees, on the CPU the links
   * between chunks, and what each view keeps of each instance of the scene between frames. From the
   * start there is room for one instance; for more of them voyCreateView and voySetViewInstances
   * leave less to chunks. What a frame makes anew does not count (images, splats, lists of what is
   * drawn), nor what the host keeps of a file beside that, which on CUDA includes the links;
   * docs/streaming.md tells how much that is. */
  uint64_t memoryBudget;
  /* NULL, or where the first frames look from: x, y, z in the scene's own axes, metres, each below
   * 1e18 in magnitude. Like VoySceneInfo.boundsMin, it includes the scene's origin. voyOpenScene
   * then reads what looks large from there as well as the top of the tree, up to 64 MB of the file.
   * Copied. */
  const double* startPosition;
  /* Threads that read and decode: 1 to 64. 0: three quarters of the machine's hardware threads,
   * but at least 4 and at most 12, and 12 for a URL. They sleep while there is nothing to read. */
  uint32_t readerThreadCount;
  uint32_t reserved; /* 0 */
} VoySceneStreaming;
#define VOY_SCENE_STREAMING_INIT \
  { VOY_STRUCTURE_TYPE_SCENE_STREAMING, NULL, 0, NULL, 0, 0 }

/* Set exactly one of path and source. The library recognises the format by the bytes, and .splat,
 * .ksplat and the meta.json of a SOG folder by the name. A .voy file has a level-of-detail tree.
 * Any other file (.ply, .compressed.ply, .spz, .sog, .splat, .ksplat, .glb, .gltf, tileset.json) is
 * a flat scene: every Gaussian is drawn. What refers to files beside it takes a path. */
typedef struct VoySceneDesc {
  VoyStructureType type;       /* VOY_STRUCTURE_TYPE_SCENE_DESC */
  const void* next;            /* NULL or a VoySceneStreaming */
  const char* path;            /* a file, or an http:// or https:// URL; UTF-8, copied */
  const VoyByteSource* source; /* the struct is copied; see there for how long `user` lives */
} VoySceneDesc;
#define VOY_SCENE_DESC_INIT \
  { VOY_STRUCTURE_TYPE_SCENE_DESC, NULL, NULL, NULL }

/* Opens a scene: loads it whole, or prepares streaming and reads the top of the tree. It blocks
 * until that is done. A damaged chunk does not fail the call; frames that need the chunk fail.
 * Errors: FILE_NOT_FOUND, IO, REFUSED_INPUT (a malformed file), OUT_OF_HOST_MEMORY, OVER_BUDGET
 * (the message says how much is needed; of a streamed scene, the top of the tree must fit),
 * DAMAGED_CHUNK (the top of a streamed scene's tree), UNSUPPORTED (a URL or a SOG scene, but
 * libvoyager_http.so or libvoyager_sog.so is missing). */
VOY_API VoyResult VOY_CALL voyOpenScene(VoyDevice device, const VoySceneDesc* desc,
                                        VoyScene* scene);

/* Changes VoySceneStreaming.memoryBudget, in bytes. Everything but the top of the tree is dropped
 * and read again as frames need it. The call waits for frames that draw the scene. On CUDA
 * voyGetViewCut of its views then fails until their next frame.
 * Errors: UNSUPPORTED (a scene that is not streamed), OVER_BUDGET (as voyOpenScene; nothing has
 * changed), TIMEOUT (as voyRenderFrame; nothing has changed). */
VOY_API VoyResult VOY_CALL voySetSceneMemoryBudget(VoyScene scene, uint64_t bytes);

/* Waits for frames that draw the scene, closes it and frees its memory. Closing NULL succeeds and
 * does nothing. From then on every call on a view with an instance of it returns
 * VOY_ERROR_SCENE_CLOSED, until voySetViewInstances gives the view other instances. Only
 * voyDestroyView succeeds before that. */
VOY_API VoyResult VOY_CALL voyCloseScene(VoyScene scene);

/* How a scene's file keeps its Gaussians (docs/voy-format.md). */
typedef enum VoySceneStorage {
  VOY_SCENE_STORAGE_FLAT = 0,     /* not a .voy file: no tree, every Gaussian is drawn */
  VOY_SCENE_STORAGE_LOSSLESS = 1, /* a .voy file with every number as it was baked */
  VOY_SCENE_STORAGE_COMPACT = 2,  /* a .voy file with quantised numbers, a quarter as large */
  VOY_SCENE_STORAGE_MAX_ENUM = 0x7fffffff
} VoySceneStorage;

/* Where VoySceneInfo.nativePixel and pixelFilter are known from. */
typedef enum VoyNativePixelSource {
  VOY_NATIVE_PIXEL_SOURCE_UNKNOWN = 0,   /* nothing is known: drawn as by VOY_ANTIALIAS_OFF */
  VOY_NATIVE_PIXEL_SOURCE_GIVEN = 1,     /* named when the scene was baked */
  VOY_NATIVE_PIXEL_SOURCE_CAMERAS = 2,   /* the training cameras */
  VOY_NATIVE_PIXEL_SOURCE_FILE = 3,      /* the input was trained with a compensated filter */
  VOY_NATIVE_PIXEL_SOURCE_ESTIMATED = 4, /* from the Gaussians: expect it within a factor of 3 */
  VOY_NATIVE_PIXEL_SOURCE_MAX_ENUM = 0x7fffffff
} VoyNativePixelSource;

/* The facts of a scene: its size, its bounds, and what happened to it at import. */
typedef struct VoySceneInfo {
  VoyStructureType type;       /* VOY_STRUCTURE_TYPE_SCENE_INFO */
  void* next;                  /* NULL or a VoySceneProfile */
  uint64_t gaussianCount;      /* of the input; in a tree, its leaves */
  uint64_t nodeCount;          /* 0 for a flat scene */
  uint32_t treeDepth;          /* levels; 0 for a flat scene */
  uint32_t chunkCount;         /* of the file (docs/lod-tree.md); 0 for a flat scene */
  uint32_t damagedChunkCount;  /* of these; voyGetSceneNotes tells the causes */
  uint32_t shDegree;           /* 0 to 3, as kept: top bands that are all zero are left out */
  VoySceneStorage storage;     /* FLAT for every format but .voy */
  uint32_t trainedAntialiased; /* 1: trained with the antialiased low-pass, says the input */
  double origin[3];            /* world position of the zero of scene-local coordinates, metres */
  double boundsMin[3];         /* world metres: the least mean - 3·(largest scale) of a Gaussian */
  double boundsMax[3];         /* world metres: the greatest mean + 3·(largest scale) of one */
  uint64_t residentBytes;      /* of scene data, as VoyDeviceDesc.hostMemoryBudget counts it */
  uint64_t droppedGaussianCount; /* Gaussians left out at import: values no Gaussian can have */
  uint64_t repairCount;          /* repairs at import, counted for each Gaussian and attribute
                                      (scale, rotation, opacity, SH) */
  double maxPositionError;       /* compact storage: largest error of a mean, metres. Else 0 */
  /* The side of a training picture's pixel where the Gaussians are, metres: VOY_ANTIALIAS_ON draws
   * with it (METHOD §12). The largest where blocks of Gaussians have different ones, 0 where they
   * get no footprint. */
  double nativePixel;
  double pixelFilter; /* that VOY_ANTIALIAS_ON adds to a splat, square pixels (METHOD §12) */
  VoyNativePixelSource nativePixelSource; /* of both */
  uint32_t reserved;                      /* 0 */
} VoySceneInfo;
#define VOY_SCENE_INFO_INIT                                                                      \
  {                                                                                              \
    VOY_STRUCTURE_TYPE_SCENE_INFO, NULL, 0, 0, 0, 0, 0, 0, VOY_SCENE_STORAGE_FLAT, 0, {0, 0, 0}, \
        {0, 0, 0}, {0, 0, 0}, 0, 0, 0, 0, 0, 0, VOY_NATIVE_PIXEL_SOURCE_UNKNOWN, 0               \
  }

/* In VoySceneInfo.next: the properties of a scene that decide which work and memory can be left out
 * (docs/omissions.md). The caller sets `type` and `next`; the call writes the rest. */
typedef struct VoySceneProfile {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_SCENE_PROFILE */
  void* next;
  uint32_t inputShDegree; /* of the input: VoySceneInfo.shDegree or more */
  uint32_t merged;        /* 1: a tree has nodes that represent several Gaussians */
  uint32_t interpolated;  /* 1: a cut draws nodes blended with their parents */
  uint32_t streamed;      /* 1: opened with VoySceneStreaming. 0: all in memory */
  /* 1: all Gaussians were examined. 0: the scene is streamed, and the fields below are 0. */
  uint32_t complete;
  uint32_t reserved;            /* 0 */
  uint64_t chunksByShDegree[4]; /* chunks that use SH degree 0, 1, 2, 3 */
  uint64_t opacitiesAboveOne;   /* Gaussians; only merged ones can exceed 1 */
  float minAnisotropy, /* longest axis over shortest: the least of a Gaussian; 0 without any */
      maxAnisotropy;   /* the greatest of these ratios; 0 without Gaussians */
} VoySceneProfile;
#define VOY_SCENE_PROFILE_INIT \
  { VOY_STRUCTURE_TYPE_SCENE_PROFILE, NULL, 0, 0, 0, 0, 0, 0, {0, 0, 0, 0}, 0, 0, 0 }

/* Writes the facts of a scene. The caller sets `type` and `next`. */
VOY_API VoyResult VOY_CALL voyGetSceneInfo(VoyScene scene, VoySceneInfo* info);

/* What a VoySceneNote tells of. */
typedef enum VoySceneNoteKind {
  VOY_SCENE_NOTE_KIND_OMITTED = 0,  /* the scene does not need this, so it costs nothing */
  VOY_SCENE_NOTE_KIND_REPAIRED = 1, /* Gaussians of which one attribute was repaired at import */
  VOY_SCENE_NOTE_KIND_DROPPED = 2,  /* Gaussians left out at import */
  VOY_SCENE_NOTE_KIND_DAMAGED = 3,  /* chunks that cannot be read */
  VOY_SCENE_NOTE_KIND_MAX_ENUM = 0x7fffffff
} VoySceneNoteKind;

/* One thing that was omitted, repaired, dropped or damaged in a scene, and why. It is an element of
 * an array, so its size never changes. */
typedef struct VoySceneNote {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_SCENE_NOTE */
  void* next;
  VoySceneNoteKind kind; /* says what `count` and `bytes` mean */
  uint32_t reserved;     /* 0 */
  uint64_t count;        /* Gaussians (REPAIRED, DROPPED) or chunks (DAMAGED); 0 for OMITTED */
  uint64_t bytes;        /* that OMITTED saves; else 0 */
  char what[64];         /* UTF-8, terminated, as `why` */
  char why[192];         /* the cause, in words */
} VoySceneNote;
#define VOY_SCENE_NOTE_INIT                                                           \
  {                                                                                   \
    VOY_STRUCTURE_TYPE_SCENE_NOTE, NULL, VOY_SCENE_NOTE_KIND_OMITTED, 0, 0, 0, {0}, { \
      0                                                                               \
    }                                                                                 \
  }

/* Lists what was omitted, repaired, dropped or damaged: one note for each kind and cause. A
 * Gaussian with two repaired attributes counts in two notes.
 * With capacity 0 the call only sets *count. Otherwise it writes up to `capacity` notes, their
 * `type` and `next` included, and sets *count to the number of notes. It returns VOY_INCOMPLETE if
 * that is more than `capacity`. */
VOY_API VoyResult VOY_CALL voyGetSceneNotes(VoyScene scene, uint32_t capacity, VoySceneNote* notes,
                                            uint32_t* count);

/* Counters of a streamed scene. They count from the opening of the scene. The fields of chunks
 * that are needed, missing or seen describe the latest frames. docs/streaming.md has the terms. */
typedef struct VoyStreamingStats {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_STREAMING_STATS */
  void* next;
  uint64_t budgetBytes;       /* what VoySceneStreaming.memoryBudget counts; one view at least */
  uint64_t chunkSlots,        /* chunks that fit into the budget at once */
      residentChunks;         /* chunks in memory, which frames can draw */
  uint64_t neededChunks;      /* that the latest frames need, whatever the budget. Where more is
                                 needed than has room, what is far from having room is counted
                                 now and then (docs/streaming.md). So is what the next two have */
  uint64_t missingChunks;     /* needed but not resident */
  uint64_t missingBytes;      /* size of missingChunks in the file */
  uint64_t seenChunks;        /* needed and inside an eye's frustum plus the margin */
  uint64_t seenMissingChunks; /* seen but not resident, as of the last plan. 0: of what was in
                                 sight then, nothing is shown coarser than asked. What came into
                                 sight since is not counted */
  uint64_t requestedChunks,   /* handed to the reader threads; one that comes again counts again */
      arrivedChunks;          /* that became resident */
  uint64_t lateChunks;        /* arrived after a frame had needed them */
  uint64_t evictedChunks;     /* removed to make room */
  uint64_t flushedChunks;     /* requests dropped because nothing needed them any more */
  uint64_t reads,             /* of the file or the VoyByteSource; one may hold several chunks */
      bytesRead;              /* by these reads */
  uint64_t failures; /* failed reads and damaged chunks. Reads that may succeed later are tried
                        again. The log names each cause once (WARNING) */
} VoyStreamingStats;
#define VOY_STREAMING_STATS_INIT \
  { VOY_STRUCTURE_TYPE_STREAMING_STATS, NULL, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 }

/* Writes the counters of a streamed scene. The caller sets `type`.
 * Errors: UNSUPPORTED (a scene that is not streamed). */
VOY_API VoyResult VOY_CALL voyGetStreamingStats(VoyScene scene, VoyStreamingStats* stats);

/* ------------------------------------------------------------------- target */

/* Where the pixels of a target are. */
typedef enum VoyTargetKind {
  VOY_TARGET_KIND_HOST_MEMORY = 0, /* arrays of the host: VoyTargetDesc.color and depth */
  VOY_TARGET_KIND_VULKAN = 1,      /* images of a Vulkan host; see voyager_vulkan.h */
  VOY_TARGET_KIND_MAX_ENUM = 0x7fffffff
} VoyTargetKind;

/* All formats hold display-referred code values, which is what an _SRGB image stores. Copying them
 * to an _SRGB image is correct. Writing them through an _SRGB view would encode them twice. */
typedef enum VoyColorFormat {
  VOY_COLOR_FORMAT_NONE = 0,        /* depth only */
  VOY_COLOR_FORMAT_RGBA8_UNORM = 1, /* clamped to [0, 1], rounded to nearest */
  VOY_COLOR_FORMAT_RGBA32F = 2,     /* not clamped */
  VOY_COLOR_FORMAT_RGBA16F = 3,     /* binary16, rounded to nearest even, clamped to +-65504 and so
                                       always finite */
  VOY_COLOR_FORMAT_MAX_ENUM = 0x7fffffff
} VoyColorFormat;

/* An image that frames are drawn into. Rows run from top to bottom. With T the transmittance of a
 * pixel, rgb is the premultiplied colour plus T times the background, and a is 1 - T.
 * Depth is a binary32 number: the view-space z, in metres, of the first splat after which
 * T <= 0.5, or +inf if there is none.
 * The memory belongs to the host and must stay valid until the target is destroyed. It is written
 * only during voyRenderFrame, and only inside width x height. */
typedef struct VoyTargetDesc {
  VoyStructureType type;      /* VOY_STRUCTURE_TYPE_TARGET_DESC */
  const void* next;           /* NULL, or a VoyVulkanTargetDesc with kind VULKAN */
  VoyTargetKind kind;         /* one of VoyCapabilities.targetKinds */
  VoyColorFormat colorFormat; /* NONE: the target has only depth */
  uint32_t width,             /* pixels, 1 to VoyCapabilities.maxWidth */
      height;                 /* pixels, 1 to VoyCapabilities.maxHeight */
  void* color;                /* aligned to 4 bytes; NULL if and only if colorFormat is NONE */
  uint64_t colorRowPitch;     /* bytes, a multiple of 4; 0: rows follow without a gap */
  float* depth;               /* NULL: no depth; one of color and depth must be set */
  uint64_t depthRowPitch;     /* bytes, a multiple of 4; 0: rows follow without a gap */
} VoyTargetDesc;
#define VOY_TARGET_DESC_INIT                                           \
  {                                                                    \
    VOY_STRUCTURE_TYPE_TARGET_DESC, NULL, VOY_TARGET_KIND_HOST_MEMORY, \
        VOY_COLOR_FORMAT_RGBA8_UNORM, 0, 0, NULL, 0, NULL, 0           \
  }

/* Creates a target. The host destroys it with voyDestroyTarget.
 * Errors: INVALID_ARGUMENT; for Vulkan also those at VoyVulkanTargetDesc. */
VOY_API VoyResult VOY_CALL voyCreateTarget(VoyDevice device, const VoyTargetDesc* desc,
                                           VoyTarget* target);

/* Waits for frames that draw into the target and destroys it. The host's memory is not freed. */
VOY_API VoyResult VOY_CALL voyDestroyTarget(VoyTarget target);

/* --------------------------------------------------------------------- view */

/* Which nodes of a tree are drawn. A flat scene has no tree: every Gaussian of it is drawn,
 * whatever the choice. docs/lod-selection.md explains the cut. */
typedef enum VoyLod {
  VOY_LOD_AUTO = 0, /* the library's choice: CUT in this version */
  VOY_LOD_CUT = 1,  /* the level-of-detail cut at tau */
  VOY_LOD_ALL_LEAVES =
      2, /* every leaf, without search and interpolation; not for streamed scenes */
  VOY_LOD_MAX_ENUM = 0x7fffffff
} VoyLod;

/* How a splat that is about a pixel large, or smaller, is drawn (docs/method.md, METHOD §12). */
typedef enum VoyAntialias {
  VOY_ANTIALIAS_ON = 0,  /* as in the scene's training pictures at any distance: Gaussians get the
                            scene's native footprint (VoySceneInfo.nativePixel), and a splat that
                            the pixel filter widens loses opacity */
  VOY_ANTIALIAS_OFF = 1, /* 3DGS's own picture: 0.3 square pixels are added to every splat. What
                            is smaller than a pixel swells */
  VOY_ANTIALIAS_MAX_ENUM = 0x7fffffff
} VoyAntialias;

/* In VoyViewDesc.next, or passed to voySetViewTimeBudget: the view chooses tau for each frame so
 * that VoyFrameStats.millisecondsTotal stays within the budget. It aims at nine tenths of it. On
 * CUDA this is GPU time, on the CPU the time of voyRenderFrame. What the host draws does not count.
 * While no instance has a tree there is no tau to choose, and it stays as it is.
 * tau starts at VoyViewDesc.tau, clamped to the range below. It then depends only on the times of
 * the view's finished frames: equal times give equal taus. docs/time-budget.md has the rule. */
typedef struct VoyTimeBudget {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_TIME_BUDGET */
  const void* next;
  double milliseconds; /* for a frame, all eyes together; finite, > 0; the host must set it */
  double minTau;       /* pixels, finite, >= 0: the finest tau, even if time is left */
  double maxTau;       /* pixels, finite, >= minTau: the coarsest, even if frames are late */
} VoyTimeBudget;
#define VOY_TIME_BUDGET_INIT \
  { VOY_STRUCTURE_TYPE_TIME_BUDGET, NULL, 0.0, 1.0, 60.0 }

/* A view draws instances of scenes for one or two eyes, and keeps the cut of each instance between
 * frames. One scene may have several instances. voySetViewInstances changes them at any time. The
 * splats of all instances are sorted together, so that overlapping instances hide one another
 * correctly.
 *
 * Two eyes share one cut for each instance. It is the cut for the point midway between the eyes, as
 * fine as the more demanding eye needs. Covariance, colour, order and blending are computed for
 * each eye. So the image of an eye equals, to the bit, what this eye alone gives with that cut. */
typedef struct VoyViewDesc {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VIEW_DESC */
  const void* next; /* NULL or a chain of VoyTimeBudget and VoyExperiment (voyager_experiment.h) */
  uint32_t instanceCount; /* 0 to VoyCapabilities.maxInstances; more is UNSUPPORTED */
  const VoyScene* scenes; /* one for each instance, of the same device; copied. All stand at the
                             identity. NULL if there is none */
  uint32_t eyeCount;      /* of every frame; 1 to VoyCapabilities.maxEyes; more is UNSUPPORTED */
  uint32_t maxWidth, /* of the targets of its frames, pixels, 1 to VoyCapabilities.maxWidth; the
                        host must set it */
      maxHeight;     /* likewise, 1 to VoyCapabilities.maxHeight */
  VoyLod lod;        /* which nodes of a tree are drawn; ignored for flat scenes */
  double tau;        /* granularity in pixels, finite, >= 0: smaller is finer. METHOD §3 */
  VoyAntialias antialias; /* for all instances */
  uint32_t reserved;      /* 0 */
} VoyViewDesc;
#define VOY_VIEW_DESC_INIT \
  { VOY_STRUCTURE_TYPE_VIEW_DESC, NULL, 0, NULL, 1, 0, 0, VOY_LOD_AUTO, 3.0, VOY_ANTIALIAS_ON, 0 }

/* Creates a view. The host destroys it with voyDestroyView. A streamed scene whose budget has no
 * room for what the view keeps first gives up chunks, as voySetSceneMemoryBudget does.
 * Errors: INVALID_ARGUMENT, UNSUPPORTED (more than VoyCapabilities allows; a time budget or a
 * streamed scene for a view of every leaf; lists of 2^32 Gaussians or more), OUT_OF_HOST_MEMORY,
 * OVER_BUDGET (CUDA: the scene does not fit into the GPU's memory; a streamed scene's budget has no
 * room for what the view keeps, and the message says how much it would take), TIMEOUT (as
 * voySetSceneMemoryBudget, where a streamed scene gives up chunks for the view). */
VOY_API VoyResult VOY_CALL voyCreateView(VoyDevice device, const VoyViewDesc* desc, VoyView* view);

/* Waits for the view's frame in progress and destroys the view. */
VOY_API VoyResult VOY_CALL voyDestroyView(VoyView view);

/* Sets tau, in pixels, finite, >= 0, from the next frame on. It ends a time budget. */
VOY_API VoyResult VOY_CALL voySetViewTau(VoyView view, double tau);

/* Sets or changes the time budget from the next frame on. tau continues from its current value. It
 * may be called every frame.
 * Errors: INVALID_ARGUMENT, UNSUPPORTED (as voyCreateView). */
VOY_API VoyResult VOY_CALL voySetViewTimeBudget(VoyView view, const VoyTimeBudget* budget);

/* -------------------------------------------------------------------- frame */

/* XrPosef in double: where an object stands in its parent's space. */
typedef struct VoyPose {
  double position[3]; /* x, y, z in metres, each below 1e18 in magnitude */
  /* A quaternion (x, y, z, w) that rotates the object's axes (x right, y up, -z forward) into the
   * parent's. It need not have unit length, because the call normalises it. A zero or non-finite
   * quaternion is INVALID_ARGUMENT. */
  double orientation[4];
} VoyPose;
/* The identity. */
#define VOY_POSE_INIT \
  {                   \
    {0, 0, 0}, {      \
      0, 0, 0, 1      \
    }                 \
  }

/* Tangents of the half-angles of a field of view, each between -1e4 and 1e4. right - left and
 * up - down are at least 1e-6. */
typedef struct VoyFrustum {
  double left, /* of the left edge, measured from the view axis to the right: normally negative */
      right,   /* of the right edge, measured in the same direction: normally positive */
      up,      /* of the top edge, measured from the view axis upwards: normally positive */
      down;    /* of the bottom edge, measured in the same direction: normally negative */
} VoyFrustum;
/* 90 degrees wide and 90 degrees high. */
#define VOY_FRUSTUM_INIT \
  { -1, 1, 1, -1 }

/* Fills a frustum from angles in radians, as XrFovf has them, each inside ±π/2: the tangents of the
 * angles. Errors: INVALID_ARGUMENT (tangents that VoyFrustum does not allow). */
VOY_API VoyResult VOY_CALL voyFrustumFromAngles(double left, double right, double up, double down,
                                                VoyFrustum* frustum);

/* Fills a frustum from pinhole intrinsics, all in pixels. cx and cy are measured from the top left
 * corner of the image; pixel centres lie at +0.5. left = -cx / fx, right = (width - cx) / fx,
 * up = cy / fy, down = -(height - cy) / fy (docs/conventions.md).
 * Errors: INVALID_ARGUMENT (fx, fy, width or height that is not finite and > 0; tangents that
 * VoyFrustum does not allow). */
VOY_API VoyResult VOY_CALL voyFrustumFromIntrinsics(double fx, double fy, double cx, double cy,
                                                    double width, double height,
                                                    VoyFrustum* frustum);

/* Where the y of clip space points in the picture. */
typedef enum VoyClipY {
  VOY_CLIP_Y_UP = 0,   /* +1 is the top: OpenGL, Direct3D, Metal */
  VOY_CLIP_Y_DOWN = 1, /* +1 is the bottom: Vulkan, without a negative viewport */
  VOY_CLIP_Y_MAX_ENUM = 0x7fffffff
} VoyClipY;

/* Fills a frustum from a perspective projection: `matrix` is 16 numbers, column by column, that
 * take columns (x, y, z, 1) of the camera's space to clip space. A row-major matrix for row
 * vectors has the same layout in memory: pass it as it is. The camera may look along -z or +z (the
 * matrix tells), and its y may point up or down. The third row is not read, so that depth from 0 to
 * 1 or from -1 to 1, reversed or not, with a finite far plane, an infinite one or an oblique near
 * plane give the same frustum. Errors: INVALID_ARGUMENT (a number that is not finite; an
 * orthographic, skewed or mirrored projection or one that moves the eye; tangents that VoyFrustum
 * does not allow). */
VOY_API VoyResult VOY_CALL voyFrustumFromProjection(const double* matrix, VoyClipY clipY,
                                                    VoyFrustum* frustum);

/* The hand of a world: where +z points once the world is turned so that +x is right and +y is up. A
 * right-handed world may have any axis up. Unreal's cameras look along +x and have z up: permute
 * the axes of world and camera first (docs/abi.md). */
typedef enum VoyHand {
  VOY_HAND_RIGHT = 0, /* towards the viewer: OpenXR, glTF, Godot */
  VOY_HAND_LEFT = 1,  /* away from the viewer: Unity, Direct3D by habit */
  VOY_HAND_MAX_ENUM = 0x7fffffff
} VoyHand;

/* Fills a pose from the matrix that takes columns (x, y, z, 1) of the own space of a camera or an
 * object to the world: 16 numbers, column by column. The last column is the position in metres.
 * The point (x, y, z) of a left-handed world is (x, y, -z) in Voyager's, so convert cameras and
 * instances alike. A right-handed world is taken as it is.
 * The own space has the world's hand, or the other one where the matrix mirrors, as Unity's
 * cameraToWorldMatrix does. If that space is left-handed, its z is negated, too. So the pose is
 * right for a camera that looks along +z of left-handed axes or along -z of right-handed ones.
 * Errors: INVALID_ARGUMENT (a number that is not finite; a last row other than 0, 0, 0, 1; axes
 * that are scaled or sheared by more than 1e-4). */
VOY_API VoyResult VOY_CALL voyPoseFromWorldMatrix(const double* matrix, VoyHand worldHand,
                                                  VoyPose* pose);

/* The same from the inverse of that matrix, such as a camera's view matrix, which takes the world
 * to the camera's own space. */
VOY_API VoyResult VOY_CALL voyPoseFromViewMatrix(const double* matrix, VoyHand worldHand,
                                                 VoyPose* pose);

/* What one eye sees. It is an element of an array, so its size never changes. Later additions come
 * through `next`. */
typedef struct VoyFrameEye {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_FRAME_EYE */
  const void* next;      /* NULL or a VoyEyeDepthLimit */
  VoyPose pose;          /* in the world */
  VoyFrustum frustum;    /* its edges are the edges of the target */
  VoyTarget target;  /* of the view's device. Its size is the size of the image. Two eyes need two
                        targets of the same kind, or two layers of one target */
  uint32_t layer;    /* layer of the target (voyager_vulkan.h); 0 for host memory */
  uint32_t reserved; /* 0 */
} VoyFrameEye;
/* At the origin, looking along -z. The host must set frustum and target. */
#define VOY_FRAME_EYE_INIT \
  { VOY_STRUCTURE_TYPE_FRAME_EYE, NULL, {{0, 0, 0}, {0, 0, 0, 1}}, {0, 0, 0, 0}, NULL, 0, 0 }

/* What a value of the host's depth buffer means.
 * METERS: view-space z in metres; +inf means no geometry.
 * STANDARD: projected depth d = a + b / z, 0 at nearZ and 1 at farZ.
 * REVERSED: projected depth d = a + b / z, 1 at nearZ and 0 at farZ.
 * d is clamped to [0, 1]. The d of farZ, which buffers are cleared to, means no geometry. NaN means
 * no geometry in every encoding. */
typedef enum VoyDepthEncoding {
  VOY_DEPTH_ENCODING_METERS = 0,
  VOY_DEPTH_ENCODING_STANDARD = 1,
  VOY_DEPTH_ENCODING_REVERSED = 2,
  VOY_DEPTH_ENCODING_MAX_ENUM = 0x7fffffff
} VoyDepthEncoding;

/* In VoyFrameEye.next: the depth of the host's opaque geometry at each pixel of the eye's target.
 * A splat whose centre has a greater view-space z than that is hidden: it is not blended in the
 * pixel and does not count for its depth. The image then holds what lies in front of the geometry,
 * and the host composites it over its own picture.
 * The memory belongs to the host and is read only during voyRenderFrame. With DEVICE sharing
 * (voyager_vulkan.h) memory is UNSUPPORTED: set depth to NULL and record
 * voyRecordVulkanDepthLimit. */
typedef struct VoyEyeDepthLimit {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_EYE_DEPTH_LIMIT */
  const void* next;
  const float* depth;     /* rows from top to bottom, of the target's size; aligned to 4 bytes.
                             NULL: what voyRecordVulkanDepthLimit copied into the target */
  uint64_t depthRowPitch; /* bytes, a multiple of 4; 0: rows follow without a gap */
  VoyDepthEncoding depthEncoding; /* of the values in `depth`, or of the depth image copied */
  uint32_t reserved;              /* 0 */
  double nearZ, /* near plane of the host's projection, metres, 1e-18 to 1e18; ignored for METERS */
      farZ;     /* its far plane, metres, > nearZ, may be infinite; ignored for METERS */
} VoyEyeDepthLimit;
#define VOY_EYE_DEPTH_LIMIT_INIT \
  { VOY_STRUCTURE_TYPE_EYE_DEPTH_LIMIT, NULL, NULL, 0, VOY_DEPTH_ENCODING_METERS, 0, 0.0, 0.0 }

/* Where an instance stands in the world. A point x of the scene is drawn at
 * position + scale·R·x, where R is the rotation of `orientation` (METHOD §6). x is in the scene's
 * own axes, whatever they are, and includes the scene's origin, as VoySceneInfo.boundsMin does.
 * View-dependent colours turn with the scene.
 * The eye must be less than 1e18 m away from the origin of each instance's scene, measured in the
 * scene's own metres. Otherwise the frame is INVALID_ARGUMENT.
 * It is an element of an array, so its size never changes. */
typedef struct VoyInstancePose {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_INSTANCE_POSE */
  const void* next;
  VoyPose pose; /* of the scene's own axes in the world */
  double scale; /* the same for all axes, 1e-9 to 1e9 */
} VoyInstancePose;
/* The identity. */
#define VOY_INSTANCE_POSE_INIT \
  { VOY_STRUCTURE_TYPE_INSTANCE_POSE, NULL, {{0, 0, 0}, {0, 0, 0, 1}}, 1 }

/* An instance of a view, for voySetViewInstances: a scene, where it stands, and what of it is
 * drawn. It is an element of an array, so its size never changes.
 *
 * The opacity of each Gaussian is multiplied by `opacity` before anything is decided by it. With 1
 * the image keeps every bit, with 0 nothing of the instance is drawn.
 *
 * A Gaussian is drawn if its centre lies inside the clip box or on its boundary. Where a node of a
 * tree is drawn, its centre counts, and where it is blended with its parent, the blended centre.
 * The box is in the scene's own axes and turns with the instance. Like VoySceneInfo.boundsMin it
 * includes the scene's origin. Limits are rounded once to binary32, relative to that origin. A
 * minimum of -1e18 or less and a maximum of 1e18 or more cut off nothing, and infinities may be
 * given. Neither opacity nor box changes the cut, or what a streamed scene reads. */
typedef struct VoyInstance {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_INSTANCE */
  const void* next;
  VoyScene scene;    /* of the view's device */
  VoyPose pose;      /* as in VoyInstancePose, with its limit for the eye's distance */
  double scale;      /* the same for all axes, 1e-9 to 1e9 */
  double clipMin[3], /* low corner of the clip box, metres in the scene; not NaN */
      clipMax[3];    /* high corner, likewise; clipMin <= clipMax */
  float opacity;     /* 0 to 1 */
  uint32_t reserved; /* 0 */
} VoyInstance;
/* At the identity, whole, as opaque as it is stored. The host must set scene. */
#define VOY_INSTANCE_INIT                                                  \
  {                                                                        \
    VOY_STRUCTURE_TYPE_INSTANCE, NULL, NULL, {{0, 0, 0}, {0, 0, 0, 1}}, 1, \
        {-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}, 1, 0              \
  }

/* Sets the instances of a view from the next frame on: the whole list, in the order that breaks
 * ties of depth. `count` is 0 to VoyCapabilities.maxInstances. With 0 the view draws the
 * background, and `instances` may be NULL.
 *
 * If the scenes are the same in the same order, only poses, opacities and boxes change. The call is
 * then cheap, waits for nothing and may be made every frame. Otherwise it waits for the view's
 * frames in flight. The k-th instance of a scene in the new list then takes over the state of the
 * k-th instance of that scene in the old one. The state of the others is freed, and new ones get
 * theirs. New state is made before old state is freed, so a host that is short of memory removes
 * first. No image or cut depends on what an instance takes over, only time does.
 * VoyFrameStats.nodesExited does not count the nodes of instances that are gone.
 *
 * It also revives a view whose scene was closed, with a list without that scene.
 *
 * Errors; the view keeps its instances:
 * - INVALID_ARGUMENT: a value out of range; a scene of another device.
 * - INVALID_HANDLE: also a scene that was closed.
 * - UNSUPPORTED: more than VoyCapabilities allows; a streamed scene in a view of every leaf; lists
 *   of 2^32 Gaussians or more.
 * - OUT_OF_HOST_MEMORY, OVER_BUDGET: as voyCreateView.
 * - TIMEOUT: the host did not signal within 10 s what a frame in flight waits for.
 * - SCENE_CLOSED: closing a scene failed to leave the view usable; destroy it.
 * - BUSY: another thread uses the view.
 * - DEVICE_LOST: the GPU stopped working. */
VOY_API VoyResult VOY_CALL voySetViewInstances(VoyView view, uint32_t count,
                                               const VoyInstance* instances);

/* In VoyFrame.next: for frames that must be complete, such as screenshots, loading screens and cuts
 * to another place. */
typedef struct VoyFrameStreaming {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_FRAME_STREAMING */
  const void* next;
  /* 1: the call waits until everything that the frame sees of its streamed scenes is resident, with
   * a margin (docs/streaming.md). The image then equals, to the bit, that of scenes loaded whole.
   * If a budget is too small, the frame is OVER_BUDGET and the message says how much is needed.
   * It is OVER_BUDGET too if other views take what has come, 64 times in a row.
   * 0: the call does not wait. */
  uint32_t waitResident;
  /* Only for frames that wait. 1: data that is damaged or cannot be read is replaced by its nearest
   * ancestors. 0: such a frame fails with DAMAGED_CHUNK or with the error of the read. */
  uint32_t allowFallback;
} VoyFrameStreaming;
#define VOY_FRAME_STREAMING_INIT \
  { VOY_STRUCTURE_TYPE_FRAME_STREAMING, NULL, 0, 0 }

/* A frame of a view: what each eye sees and where it is drawn. It is valid for one call; the next
 * frame may differ in everything. */
typedef struct VoyFrame {
  VoyStructureType type;   /* VOY_STRUCTURE_TYPE_FRAME */
  const void* next;        /* NULL or a chain of VoyFrameStreaming and VoyVulkanFrame */
  uint32_t eyeCount;       /* VoyViewDesc.eyeCount */
  uint32_t instanceCount;  /* of `instances`: as many as the view has; 0 where that is NULL */
  const VoyFrameEye* eyes; /* eyeCount of them */
  /* One for each instance: in this frame alone they stand in place of the poses and scales of
   * voySetViewInstances, whose opacities and boxes stay. NULL: those poses and scales, which are
   * the identity for the instances of VoyViewDesc. */
  const VoyInstancePose* instances;
  double nearZ; /* world metres, finite, > 0: splats with view-space z <= nearZ are not drawn */
  float background[3]; /* code values behind the scene, finite */
  uint32_t reserved;   /* 0 */
} VoyFrame;
#define VOY_FRAME_INIT \
  { VOY_STRUCTURE_TYPE_FRAME, NULL, 0, 0, NULL, NULL, 0.2, {0, 0, 0}, 0 }

/* Draws a frame. Targets in host memory are complete when the call returns. VoyVulkanFrame says
 * when Vulkan images are. After an error no target has changed.
 * Errors:
 * - INVALID_ARGUMENT: a value out of range.
 * - UNSUPPORTED: a VoyEyeDepthLimit in memory for a Vulkan target with DEVICE sharing.
 * - SCENE_CLOSED: a scene of the view was closed, and voySetViewInstances not called since.
 * - DAMAGED_CHUNK: the frame needs a chunk that is damaged.
 * - IO, FILE_NOT_FOUND, REFUSED_INPUT: the frame waits (VoyFrameStreaming) and a read failed.
 * - OUT_OF_HOST_MEMORY, OVER_BUDGET: the frame does not fit into host memory, into a budget, or
 *   into the GPU's memory.
 * - BUSY: another thread uses the view or a target.
 * - TIMEOUT: the host did not signal within 10 s what this frame waits for, or one in flight that
 *   the call waits for.
 * - DEVICE_LOST: the CUDA or Vulkan device no longer works. */
VOY_API VoyResult VOY_CALL voyRenderFrame(VoyView view, const VoyFrame* frame);

/* Returns the last frame's cut of one instance: node ids in ascending order. `instance` is the
 * index in the view's list. On CUDA the call copies the cut from the GPU and waits for it.
 * With capacity 0 the call only sets *count. Otherwise it writes up to `capacity` ids and sets
 * *count to the size of the cut. It returns VOY_INCOMPLETE if that is more than `capacity`.
 * Errors: INVALID_ARGUMENT (no such instance; no frame yet, or none since voySetViewInstances
 * changed the scenes), UNSUPPORTED (the view draws no cut of this instance; on CUDA also after a
 * frame failed, or a streamed scene gave up chunks for its budget or for another view, until the
 * next frame succeeds), TIMEOUT (as voyRenderFrame). */
VOY_API VoyResult VOY_CALL voyGetViewCut(VoyView view, uint32_t instance, uint32_t capacity,
                                         uint32_t* nodes, uint32_t* count);

/* Work or memory that a view leaves out. It is an element of an array, so its size never changes.
 */
typedef struct VoyOmission {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_OMISSION */
  void* next;
  uint64_t bytes; /* of memory that is not used; 0 if not known */
  /* A lower bound of the time that the last frame saved: the bytes that it did not move, divided by
   * the peak bandwidth of the device's memory. 0 if either is not known. */
  double milliseconds;
  char what[64]; /* UTF-8, terminated, as `why` */
  char why[192]; /* the cause, in words */
} VoyOmission;
#define VOY_OMISSION_INIT                             \
  {                                                   \
    VOY_STRUCTURE_TYPE_OMISSION, NULL, 0, 0.0, {0}, { \
      0                                               \
    }                                                 \
  }

/* Lists what the view leaves out: the VOY_SCENE_NOTE_KIND_OMITTED of its scenes, each scene once,
 * and what the view itself leaves out, judged by its frames so far (docs/omissions.md). `capacity`,
 * `count` and the result work as in voyGetSceneNotes. */
VOY_API VoyResult VOY_CALL voyGetViewOmissions(VoyView view, uint32_t capacity,
                                               VoyOmission* omissions, uint32_t* count);

/* The stages of a frame. CUDA bins before it sorts, the CPU after. */
typedef enum VoyStage {
  VOY_STAGE_SEARCH = 0,    /* finds the cut of each instance */
  VOY_STAGE_PROJECT = 1,   /* makes splats of the cut's Gaussians */
  VOY_STAGE_SORT = 2,      /* orders splats front to back */
  VOY_STAGE_BIN = 3,       /* lists for each tile of the image the splats that touch it */
  VOY_STAGE_RASTERIZE = 4, /* blends the splats of each tile */
  VOY_STAGE_RESOLVE = 5,   /* writes the image into the target's memory */
  VOY_STAGE_MAX_ENUM = 0x7fffffff
} VoyStage;

/* Whether a frame stayed within its view's time budget. */
typedef enum VoyTimeBudgetState {
  VOY_TIME_BUDGET_STATE_NONE = 0,        /* the view has no time budget */
  VOY_TIME_BUDGET_STATE_HELD = 1,        /* millisecondsTotal <= millisecondsBudget */
  VOY_TIME_BUDGET_STATE_LATE = 2,        /* longer than the budget: tau rises if this lasts */
  VOY_TIME_BUDGET_STATE_UNREACHABLE = 3, /* longer than the budget, although tau is maxTau */
  VOY_TIME_BUDGET_STATE_MAX_ENUM = 0x7fffffff
} VoyTimeBudgetState;

/* The room for stages in VoyFrameStats. stageCount says how many the library has. */
#define VOY_MAX_STAGES 16

/* Counters are sums over the view's instances. Those of splats and pairs are sums over the eyes as
 * well. */
typedef struct VoyFrameStats {
  VoyStructureType type;              /* VOY_STRUCTURE_TYPE_FRAME_STATS */
  void* next;                         /* NULL or a VoyExperimentStats (voyager_experiment.h) */
  uint64_t frameIndex;                /* frames of the view, counted from 0 */
  VoyTimeBudgetState timeBudgetState; /* of this frame */
  float tauStar;                      /* of instance 0: the target size of a node, METHOD §3 */
  float cutCenter[3];                 /* of instance 0: scene-local coordinates, metres */
  uint32_t stageCount;                /* entries of `milliseconds` that are in use */
  uint64_t nodesTotal;                /* of all instances */
  uint64_t nodesTested;               /* evaluations of the cut predicate */
  uint64_t subtreesVisited;           /* subtrees (docs/lod-tree.md) whose nodes the search read */
  uint64_t chunksRead;                /* chunks with a subtree that the search visited */
  uint64_t bytesRead;                 /* by the search: records, tables and kept state */
  uint64_t cutSize;                   /* nodes; Gaussians where there is no cut */
  uint64_t nodesEntered;              /* nodes new in the cut since the last frame */
  uint64_t nodesExited;               /* nodes gone from the cut since the last frame */
  uint64_t splats;                    /* that contribute to the image */
  uint64_t pairsBeforeFilter;         /* (tile, splat) pairs by bounding boxes */
  uint64_t pairsAfterFilter; /* (tile, splat) pairs by ellipses at the α threshold; on CUDA without
                          those that the view's last frame showed to be hidden, as are splats */
  uint64_t pairsDropped;     /* pairs, strips and Gaussians that were not drawn because buffers
                                were too small, also in frames before this one whose statistics
                                nobody read; 0: all those images are complete */
  uint64_t bytesStreamed;    /* read for streamed scenes since the view's last frame */
  uint64_t bytesNeeded;      /* size in the file of needed chunks that are not resident */
  uint64_t nodesUnrefined;   /* cut nodes of size >= tau* whose children are not resident */
  double milliseconds[VOY_MAX_STAGES]; /* indexed by VoyStage; 0 from stageCount on */
  /* Of the whole frame. On CUDA it is GPU time, and the time of the copy into host memory. */
  double millisecondsTotal;
  double tau; /* pixels, as used: voySetViewTau with it gives the same image, to the bit */
  double millisecondsBudget; /* the time budget when the frame was drawn; 0: none */
} VoyFrameStats;
#define VOY_FRAME_STATS_INIT                                                                       \
  {                                                                                                \
    VOY_STRUCTURE_TYPE_FRAME_STATS, NULL, 0, VOY_TIME_BUDGET_STATE_NONE, 0, {0, 0, 0}, 0, 0, 0, 0, \
        0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, {0}, 0, 0, 0                                           \
  }

/* Writes the statistics of the view's last successful frame. Frames into Vulkan images may still be
 * in flight; then it is the last frame that has finished, and frameIndex says which. The call waits
 * only for the view's first frame. The caller sets `type` and `next`; the call writes the rest.
 * Errors: INVALID_ARGUMENT (before the first frame), TIMEOUT (as voyRenderFrame). */
VOY_API VoyResult VOY_CALL voyGetFrameStats(VoyView view, VoyFrameStats* stats);

/* Returns the name of a stage, such as "search". NULL for any other number, so for stageCount too.
 */
VOY_API const char* VOY_CALL voyStageName(VoyStage stage);

/* The types of the functions above, for hosts that load the library at run time (docs/abi.md). */
typedef uint32_t(VOY_CALL* PFN_voyGetVersion)(void);
typedef const char*(VOY_CALL* PFN_voyResultName)(VoyResult result);
typedef const char*(VOY_CALL* PFN_voyGetLastErrorMessage)(void);
typedef VoyResult(VOY_CALL* PFN_voyQueryBackend)(VoyBackend backend);
typedef VoyResult(VOY_CALL* PFN_voyEnumerateDevices)(uint32_t capacity, VoyDeviceInfo* devices,
                                                     uint32_t* count);
typedef VoyResult(VOY_CALL* PFN_voyCreateDevice)(const VoyDeviceDesc* desc, VoyDevice* device);
typedef VoyResult(VOY_CALL* PFN_voyDestroyDevice)(VoyDevice device);
typedef VoyResult(VOY_CALL* PFN_voyGetCapabilities)(VoyDevice device,
                                                    VoyCapabilities* capabilities);
typedef VoyResult(VOY_CALL* PFN_voyOpenScene)(VoyDevice device, const VoySceneDesc* desc,
                                              VoyScene* scene);
typedef VoyResult(VOY_CALL* PFN_voySetSceneMemoryBudget)(VoyScene scene, uint64_t bytes);
typedef VoyResult(VOY_CALL* PFN_voyCloseScene)(VoyScene scene);
typedef VoyResult(VOY_CALL* PFN_voyGetSceneInfo)(VoyScene scene, VoySceneInfo* info);
typedef VoyResult(VOY_CALL* PFN_voyGetSceneNotes)(VoyScene scene, uint32_t capacity,
                                                  VoySceneNote* notes, uint32_t* count);
typedef VoyResult(VOY_CALL* PFN_voyGetStreamingStats)(VoyScene scene, VoyStreamingStats* stats);
typedef VoyResult(VOY_CALL* PFN_voyCreateTarget)(VoyDevice device, const VoyTargetDesc* desc,
                                                 VoyTarget* target);
typedef VoyResult(VOY_CALL* PFN_voyDestroyTarget)(VoyTarget target);
typedef VoyResult(VOY_CALL* PFN_voyCreateView)(VoyDevice device, const VoyViewDesc* desc,
                                               VoyView* view);
typedef VoyResult(VOY_CALL* PFN_voyDestroyView)(VoyView view);
typedef VoyResult(VOY_CALL* PFN_voySetViewTau)(VoyView view, double tau);
typedef VoyResult(VOY_CALL* PFN_voySetViewTimeBudget)(VoyView view, const VoyTimeBudget* budget);
typedef VoyResult(VOY_CALL* PFN_voyFrustumFromAngles)(double left, double right, double up,
                                                      double down, VoyFrustum* frustum);
typedef VoyResult(VOY_CALL* PFN_voyFrustumFromIntrinsics)(double fx, double fy, double cx,
                                                          double cy, double width, double height,
                                                          VoyFrustum* frustum);
typedef VoyResult(VOY_CALL* PFN_voyFrustumFromProjection)(const double* matrix, VoyClipY clipY,
                                                          VoyFrustum* frustum);
typedef VoyResult(VOY_CALL* PFN_voyPoseFromWorldMatrix)(const double* matrix, VoyHand worldHand,
                                                        VoyPose* pose);
typedef VoyResult(VOY_CALL* PFN_voyPoseFromViewMatrix)(const double* matrix, VoyHand worldHand,
                                                       VoyPose* pose);
typedef VoyResult(VOY_CALL* PFN_voySetViewInstances)(VoyView view, uint32_t count,
                                                     const VoyInstance* instances);
typedef VoyResult(VOY_CALL* PFN_voyRenderFrame)(VoyView view, const VoyFrame* frame);
typedef VoyResult(VOY_CALL* PFN_voyGetViewCut)(VoyView view, uint32_t instance, uint32_t capacity,
                                               uint32_t* nodes, uint32_t* count);
typedef VoyResult(VOY_CALL* PFN_voyGetViewOmissions)(VoyView view, uint32_t capacity,
                                                     VoyOmission* omissions, uint32_t* count);
typedef VoyResult(VOY_CALL* PFN_voyGetFrameStats)(VoyView view, VoyFrameStats* stats);
typedef const char*(VOY_CALL* PFN_voyStageName)(VoyStage stage);

#ifdef __cplusplus
}
#endif

#endif
