/* Voyager in a Vulkan host: which extensions the host enables, images that Voyager fills on
 * the device, the semaphores between the two, and commands that Voyager records into the
 * host's command buffers. docs/vulkan.md has the life of a frame. C99.
 *
 * Voyager makes no instance, no device and no queue, submits nothing, and calls no Vulkan
 * library: every entry point comes from the host's vkGetInstanceProcAddr. Vulkan 1.1 at
 * least, for the instance and the device.
 *
 * Two ways to the pixels, behind one API; VoyVulkanCapabilities says which a device has:
 * - DEVICE: the CUDA device is the Vulkan device (by UUID). Images are shared by file
 *   descriptor and written where they are. voyRenderFrame waits for nothing.
 * - HOST: the CPU draws (no CUDA, another maker's device), or another device does, into
 *   host-visible memory; voyRecordVulkanAcquire records its copy to the image.
 *
 * File descriptors: those that the host passes become the library's where a call succeeds,
 * and stay the host's where it fails, all of them. Those that the library makes never
 * leave it. Vulkan handles that the host passes stay the host's; they must outlive what
 * was made with them: the VoyDevice is destroyed before the VkDevice. One that is still there
 * when the library is unloaded stays as it is, with what is on it, and no Vulkan is called.
 *
 * Errors: besides those that a function lists, INVALID_HANDLE and INVALID_STRUCTURE
 * (voyager.h) and, where a Vulkan call of ours failed, OUT_OF_HOST_MEMORY, OVER_BUDGET (device
 * memory), DEVICE_LOST and INTERNAL (any other VkResult, which the message has).
 *
 * Thread-safety: as voyager.h says. Recording uses the host's command buffer, which must be
 * externally synchronised as Vulkan asks. vkDestroy... and vkFree... of what a target or a
 * composite holds run in the call that destroys it: as in Vulkan, the device must have
 * finished all submitted commands that use it. */
#ifndef VOYAGER_VOYAGER_VULKAN_H_
#define VOYAGER_VOYAGER_VULKAN_H_

#include <voyager/voyager.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------- before the host makes its device */

typedef enum VoyVulkanSharing {
  VOY_VULKAN_SHARING_AUTO = 0,   /* DEVICE where it is to be had, else HOST */
  VOY_VULKAN_SHARING_DEVICE = 1, /* images that CUDA writes where they are */
  VOY_VULKAN_SHARING_HOST = 2,   /* through host-visible memory */
  VOY_VULKAN_SHARING_MAX_ENUM = 0x7fffffff
} VoyVulkanSharing;

/* How the host's queue and Voyager wait for one another. */
typedef enum VoyVulkanSync {
  VOY_VULKAN_SYNC_AUTO = 0,     /* the first of these that is to be had */
  VOY_VULKAN_SYNC_TIMELINE = 1, /* two timeline semaphores a target */
  VOY_VULKAN_SYNC_BINARY = 2,   /* two binary semaphores for each image of a target's ring; DEVICE
                                   sharing only */
  VOY_VULKAN_SYNC_HOST = 3,     /* none: voyRenderFrame returns once the image is written, and the
                                   host calls it only once its queue is done with the image */
  VOY_VULKAN_SYNC_MAX_ENUM = 0x7fffffff
} VoyVulkanSync;

typedef struct VoyVulkanPhysicalDevice {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_PHYSICAL_DEVICE */
  const void* next;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
} VoyVulkanPhysicalDevice;
#define VOY_VULKAN_PHYSICAL_DEVICE_INIT \
  { VOY_STRUCTURE_TYPE_VULKAN_PHYSICAL_DEVICE, NULL, NULL, VK_NULL_HANDLE, VK_NULL_HANDLE }

/* What to enable for the best that the device can do. Static storage. */
typedef struct VoyVulkanRequirements {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_REQUIREMENTS */
  void* next;
  uint32_t apiVersion;             /* VkApplicationInfo.apiVersion, at least */
  uint32_t instanceExtensionCount; /* 0 in this version: Vulkan 1.1 has what is needed */
  const char* const* instanceExtensions;
  uint32_t deviceExtensionCount;
  const char* const* deviceExtensions;
  VkBool32 timelineSemaphore; /* VkPhysicalDeviceTimelineSemaphoreFeatures */
} VoyVulkanRequirements;
#define VOY_VULKAN_REQUIREMENTS_INIT \
  { VOY_STRUCTURE_TYPE_VULKAN_REQUIREMENTS, NULL, 0, 0, NULL, 0, NULL, VK_FALSE }

/* physicalDevice NULL, before there is an instance: apiVersion and instanceExtensions, and
 * no device extensions. Else: what this physical device has of what Voyager can use. None
 * of it is a must: what the host leaves out costs a mode (VoyVulkanCapabilities).
 * Errors: INVALID_ARGUMENT (NULL, or a getInstanceProcAddr that lacks what Vulkan 1.1 has),
 * UNSUPPORTED (a device older than Vulkan 1.1). */
VOY_API VoyResult voyGetVulkanRequirements(const VoyVulkanPhysicalDevice* physicalDevice,
                                           VoyVulkanRequirements* requirements);

/* ------------------------------------------------------------------- device */

/* Chained to VoyDeviceDesc: the Vulkan device that the host draws with. The UUID comes from
 * it; VoyDeviceDesc.deviceUuid must be NULL or the same, and the backend AUTO is CUDA where the
 * CUDA device is this one, the CPU elsewhere. With sharing HOST any device may draw: there
 * deviceUuid and AUTO are what they are without Vulkan. All handles must outlive the VoyDevice.
 * voyCreateDevice's errors are then also UNSUPPORTED (a sharing or sync that cannot be, which the
 * message explains; a device or apiVersion older than 1.1) and DEVICE_LOST. */
typedef struct VoyVulkanDeviceDesc {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_DEVICE_DESC */
  const void* next;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
  VkDevice device;
  uint32_t apiVersion; /* VkApplicationInfo.apiVersion of the instance */
  uint32_t deviceExtensionCount;
  const char* const* deviceExtensions; /* that the host enabled, all of them */
  VkBool32 timelineSemaphore;          /* the host enabled the feature */
  VoyVulkanSharing sharing;            /* AUTO, or the one to take; refused where it cannot be */
  VoyVulkanSync sync;                  /* the same */
} VoyVulkanDeviceDesc;
#define VOY_VULKAN_DEVICE_DESC_INIT                                                         \
  {                                                                                         \
    VOY_STRUCTURE_TYPE_VULKAN_DEVICE_DESC, NULL, NULL, VK_NULL_HANDLE, VK_NULL_HANDLE,      \
        VK_NULL_HANDLE, 0, 0, NULL, VK_FALSE, VOY_VULKAN_SHARING_AUTO, VOY_VULKAN_SYNC_AUTO \
  }

/* Chained to VoyCapabilities; VOY_ERROR_UNSUPPORTED for a device made without Vulkan. */
typedef struct VoyVulkanCapabilities {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_CAPABILITIES */
  void* next;
  VoyVulkanSharing sharing;  /* DEVICE or HOST */
  VoyVulkanSync sync;        /* TIMELINE, BINARY or HOST */
  VkBool32 hostMemoryImport; /* HOST sharing: frames are drawn into memory that Vulkan imports,
                                where it takes it (VK_EXT_external_memory_host; a page was tried),
                                not into memory that it maps */
  char why[192];             /* what keeps it from DEVICE and from TIMELINE, both; "" if nothing */
} VoyVulkanCapabilities;
#define VOY_VULKAN_CAPABILITIES_INIT                                                             \
  {                                                                                              \
    VOY_STRUCTURE_TYPE_VULKAN_CAPABILITIES, NULL, VOY_VULKAN_SHARING_AUTO, VOY_VULKAN_SYNC_AUTO, \
        VK_FALSE, {                                                                              \
      0                                                                                          \
    }                                                                                            \
  }

/* ------------------------------------------------------------------- target */

/* Memory that the host exported as an opaque file descriptor, and where in it the image is. */
typedef struct VoyVulkanMemory {
  int fd;             /* open; or -1 with HOST sharing, which has no use for it */
  VkBool32 dedicated; /* the memory was allocated for this image alone */
  uint64_t size;      /* of the VkDeviceMemory, bytes */
  uint64_t offset;    /* of the image in it, bytes: vkGetImageMemoryRequirements must hold there */
} VoyVulkanMemory;

/* An image of a ring that the host made: 2D, optimal tiling, one sample, one mip level, as
 * many layers as the target has, in the target's format, with VK_IMAGE_USAGE_TRANSFER_DST
 * for HOST sharing. colorUsage and depthUsage are those it was made with. */
typedef struct VoyVulkanImportedImage {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_IMAGE */
  const void* next;
  VkImage color; /* VK_NULL_HANDLE exactly where colorFormat is NONE. Images are
                    VK_SHARING_MODE_EXCLUSIVE, and each is passed once */
  VoyVulkanMemory colorMemory;
  VkImageUsageFlags colorUsage;
  VkImage depth; /* VK_FORMAT_R32_SFLOAT; VK_NULL_HANDLE exactly where the target has no depth */
  VoyVulkanMemory depthMemory;
  VkImageUsageFlags depthUsage;
} VoyVulkanImportedImage;
#define VOY_VULKAN_IMPORTED_IMAGE_INIT                                                \
  {                                                                                   \
    VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_IMAGE, NULL, VK_NULL_HANDLE, {-1, 0, 0, 0}, 0, \
        VK_NULL_HANDLE, {-1, 0, 0, 0}, 0                                              \
  }

/* Semaphores that the host made: timeline ones for TIMELINE, else binary, exported as opaque
 * file descriptors (-1 is allowed with HOST sharing). */
typedef struct VoyVulkanImportedSemaphores {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_SEMAPHORES */
  const void* next;
  VkSemaphore released; /* the host signals it, Voyager waits */
  int releasedFd;
  VkSemaphore rendered; /* Voyager signals it, the host waits */
  int renderedFd;
} VoyVulkanImportedSemaphores;
#define VOY_VULKAN_IMPORTED_SEMAPHORES_INIT \
  { VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_SEMAPHORES, NULL, VK_NULL_HANDLE, -1, VK_NULL_HANDLE, -1 }

#define VOY_MAX_VULKAN_IMAGES 8 /* in a ring */
#define VOY_MAX_VULKAN_LAYERS 8

/* Chained to a VoyTargetDesc whose kind is VULKAN and which has no memory of its own (color
 * and depth NULL, pitches 0): a ring of images, one for each frame in flight, each with a
 * layer for each eye. RGBA8 is VK_FORMAT_R8G8B8A8_UNORM, RGBA16F and RGBA32F are
 * VK_FORMAT_R16G16B16A16_SFLOAT and VK_FORMAT_R32G32B32A32_SFLOAT, depth is
 * VK_FORMAT_R32_SFLOAT, metres.
 * Images that Voyager makes can be sampled and copied from.
 * voyCreateTarget's errors are then INVALID_ARGUMENT (a count, an image or a semaphore that the
 * mode does not have, a descriptor that is not open), UNSUPPORTED (a device made without
 * VoyVulkanDeviceDesc), INTERNAL (what CUDA cannot import) and those of Vulkan. */
typedef struct VoyVulkanTargetDesc {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_TARGET_DESC */
  const void* next;
  uint32_t imageCount;                  /* 1 to VOY_MAX_VULKAN_IMAGES */
  uint32_t layerCount;                  /* 1 to VOY_MAX_VULKAN_LAYERS */
  VkBool32 depth;                       /* Voyager writes depth */
  VkBool32 depthLimit;                  /* the host's depth comes in (voyRecordVulkanDepthLimit) */
  const VoyVulkanImportedImage* images; /* imageCount of them, or NULL: Voyager makes them */
  uint32_t semaphoreCount;              /* 0: Voyager makes them; else 1 for TIMELINE, imageCount
                                           for BINARY */
  const VoyVulkanImportedSemaphores* semaphores;
} VoyVulkanTargetDesc;
#define VOY_VULKAN_TARGET_DESC_INIT \
  { VOY_STRUCTURE_TYPE_VULKAN_TARGET_DESC, NULL, 2, 1, VK_FALSE, VK_FALSE, NULL, 0, NULL }

/* What stands behind an image of the ring: Voyager's handles, or those that were passed.
 * Views are VK_IMAGE_VIEW_TYPE_2D_ARRAY over all layers; NULL for images that were passed
 * without VK_IMAGE_USAGE_SAMPLED. */
typedef struct VoyVulkanImage {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_IMAGE */
  void* next;
  VkImage color;
  VkImageView colorView;
  VkImage depth;
  VkImageView depthView;
  VkSemaphore released; /* TIMELINE: the same for the whole ring; HOST sync: NULL */
  VkSemaphore rendered;
} VoyVulkanImage;

/* capacity 0: only *count is set. Otherwise up to capacity images are written (their type
 * and next are set by the call), *count is how many there are, and the result is
 * VOY_INCOMPLETE if that is more. They stay the same for the target's life.
 * Errors: INVALID_ARGUMENT (NULL, a target of HOST_MEMORY). */
VOY_API VoyResult voyGetVulkanImages(VoyTarget target, uint32_t capacity, VoyVulkanImage* images,
                                     uint32_t* count);

/* -------------------------------------------------------------------- frame */

/* Chained to VoyFrame where its targets are Vulkan's: the image of the ring, and what this
 * frame waits for and signals.
 * TIMELINE: drawing into the image begins once `released` has reached waitValue (0: at
 * once), and `rendered` becomes signalValue, which must be greater than in the target's
 * frame before, in its first than what an imported semaphore has reached. BINARY: waitValue 1
 * waits for the image's `released`, 0 does not; signalValue 1 signals its `rendered`, 0 does
 * not: of layers that are drawn by frames of their own, the last one does. HOST: both are 0.
 * The host has submitted the signal of what is waited for before the call (with HOST sharing
 * it is the call that waits, VOY_ERROR_TIMEOUT after 10 s). Where voyRenderFrame fails, nothing
 * is signalled and no wait is consumed, but for DEVICE_LOST. A view of VOY_SPLATTING_3DGS draws
 * with HOST sharing only: UNSUPPORTED.
 * With DEVICE sharing the call returns while the frame is under way, after 0.1 ms or so of
 * the host's time; the first of a view, one after a failure, and one that needs larger
 * buffers wait once for the device; with a scene of which chunks are damaged every one does.
 * Such a frame cannot be drawn again: where the view turned to far more splats than before, it
 * may lack some, and VoyFrameStats.pairsDropped says so; the next has the room.
 * The eyes of one frame are layers of one image, or go to a target each: the image and the values
 * then are those of either target.
 * A target has one size: a resize is a new target. */
typedef struct VoyVulkanFrame {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_FRAME */
  const void* next;
  uint32_t imageIndex; /* released, and not acquired since; else INVALID_ARGUMENT */
  uint32_t reserved;   /* 0 */
  uint64_t waitValue;
  uint64_t signalValue;
} VoyVulkanFrame;
#define VOY_VULKAN_FRAME_INIT \
  { VOY_STRUCTURE_TYPE_VULKAN_FRAME, NULL, 0, 0, 0, 0 }

/* ---------------------------------------------------------------- recording */

/* An image of a ring as the host's commands use it. */
typedef struct VoyVulkanUse {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_USE */
  const void* next;
  VkCommandBuffer commandBuffer; /* recording, outside a render pass; its queue has graphics,
                                    or compute where use.stages are compute's and transfer's */
  uint32_t queueFamily;          /* of the queue that it will be submitted to */
  uint32_t imageIndex;
  VkImageLayout layout;        /* the host's: SHADER_READ_ONLY_OPTIMAL, TRANSFER_SRC_OPTIMAL or
                                  GENERAL; a release's is that of the acquire before it */
  VkPipelineStageFlags stages; /* of the host's commands that use the image; an acquire's have
                                  one that reads images: a shader's, TRANSFER, ALL_... */
} VoyVulkanUse;
#define VOY_VULKAN_USE_INIT                                                             \
  {                                                                                     \
    VOY_STRUCTURE_TYPE_VULKAN_USE, NULL, VK_NULL_HANDLE, 0, 0,                          \
        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT \
  }

/* The two take turns: a release of what is not acquired says nothing new, an acquire of what is
 * not released is INVALID_ARGUMENT, and so is a layout or a family that the image cannot have.
 * What is refused records nothing. */

/* The image goes from the host to Voyager: once for each image of a new ring before its
 * first frame, and after each use; use.layout is that of its last acquisition. The submission
 * signals `released`. What is recorded here and in voyRecordVulkanAcquire is submitted exactly
 * once, in the order of the calls: each call counts as the hand-over, and the next one is recorded
 * for what it left.
 * Errors: INVALID_ARGUMENT (values out of range, a target of HOST_MEMORY), BUSY (another thread
 * draws into the target, or records one of these two). */
VOY_API VoyResult voyRecordVulkanRelease(VoyTarget target, const VoyVulkanUse* use);

/* The image, with its depth, goes from Voyager to the host: before its first use in a frame.
 * The submission waits for `rendered`, at VK_PIPELINE_STAGE_ALL_COMMANDS or at TRANSFER
 * and use.stages. The image is then in use.layout. Errors: as voyRecordVulkanRelease. */
VOY_API VoyResult voyRecordVulkanAcquire(VoyTarget target, const VoyVulkanUse* use);

typedef struct VoyVulkanCopy {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_COPY */
  const void* next;
  VkCommandBuffer commandBuffer; /* recording, outside a render pass */
  uint32_t imageIndex;           /* acquired in TRANSFER_SRC_OPTIMAL or GENERAL */
  VkImageLayout layout;          /* that one */
  uint32_t layer;
  VkImage into;             /* the host's: 2D, one sample, usage TRANSFER_DST */
  VkFormat intoFormat;      /* see voyRecordVulkanCopy */
  VkImageLayout intoLayout; /* TRANSFER_DST_OPTIMAL or GENERAL */
  uint32_t intoLayer;
  VkOffset2D intoOffset; /* not below 0; the whole layer must fit there */
} VoyVulkanCopy;
#define VOY_VULKAN_COPY_INIT                                                                       \
  {                                                                                                \
    VOY_STRUCTURE_TYPE_VULKAN_COPY, NULL, VK_NULL_HANDLE, 0, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, \
        0, VK_NULL_HANDLE, VK_FORMAT_R8G8B8A8_SRGB, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0, {     \
      0, 0                                                                                         \
    }                                                                                              \
  }

/* Code values as they are: RGBA8 into R8G8B8A8 UNORM or SRGB and (swizzled, by a blit, so on a
 * queue with graphics; the others on any) B8G8R8A8 UNORM, 16F and 32F into their like. The host
 * synchronises its image.
 * Errors: INVALID_ARGUMENT (values out of range, a target of HOST_MEMORY), UNSUPPORTED (another
 * format: composite into that; a target without colour). Never BUSY. */
VOY_API VoyResult voyRecordVulkanCopy(VoyTarget target, const VoyVulkanCopy* copy);

/* The host's depth, to hide splats before they are blended: recorded and submitted before
 * the frame whose `released` it then signals. The frame's eye chains a VoyEyeDepthLimit
 * whose depth is NULL: the target's own. */
typedef struct VoyVulkanDepthLimit {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_DEPTH_LIMIT */
  const void* next;
  VkCommandBuffer commandBuffer; /* recording, outside a render pass */
  uint32_t queueFamily;          /* of the queue that it will be submitted to */
  uint32_t imageIndex;
  uint32_t layer; /* of the target */
  VkImage depth; /* the host's: 2D, one sample, usage TRANSFER_SRC, of the target's size at least */
  VkFormat format;      /* D32_SFLOAT, D32_SFLOAT_S8_UINT or R32_SFLOAT */
  VkImageLayout layout; /* TRANSFER_SRC_OPTIMAL or GENERAL */
  uint32_t depthLayer;
  VkOffset2D offset; /* of the target's rectangle in it */
} VoyVulkanDepthLimit;
#define VOY_VULKAN_DEPTH_LIMIT_INIT                                                       \
  {                                                                                       \
    VOY_STRUCTURE_TYPE_VULKAN_DEPTH_LIMIT, NULL, VK_NULL_HANDLE, 0, 0, 0, VK_NULL_HANDLE, \
        VK_FORMAT_D32_SFLOAT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, 0, {                  \
      0, 0                                                                                \
    }                                                                                     \
  }
/* Errors: INVALID_ARGUMENT (values out of range, a target without depthLimit), UNSUPPORTED
 * (another format). Never BUSY. */
VOY_API VoyResult voyRecordVulkanDepthLimit(VoyTarget target, const VoyVulkanDepthLimit* limit);

/* ---------------------------------------------------------------- composite */

typedef struct VoyComposite_T* VoyComposite;

/* A pipeline that draws a target's image over the host's. Into the host's render pass, or,
 * where renderPass is NULL, into dynamic rendering with these formats and no stencil attachment:
 * the host has enabled VK_KHR_dynamic_rendering, or has Vulkan 1.3, and in both cases the feature
 * dynamicRendering. One sample. Into an _SRGB format the colours are
 * decoded first, so that code values come out where the image is opaque; there the blend is linear.
 */
typedef struct VoyVulkanCompositeDesc {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DESC */
  const void* next;
  VkRenderPass renderPass;
  uint32_t subpass;
  VkFormat colorFormat; /* of the attachment that is drawn to, the first of the subpass; the device
                           can blend it, else UNSUPPORTED */
  VkFormat depthFormat; /* with depth, or UNDEFINED: no depth attachment; else UNSUPPORTED */
} VoyVulkanCompositeDesc;
#define VOY_VULKAN_COMPOSITE_DESC_INIT                                                      \
  {                                                                                         \
    VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DESC, NULL, VK_NULL_HANDLE, 0, VK_FORMAT_UNDEFINED, \
        VK_FORMAT_UNDEFINED                                                                 \
  }
/* Errors: INVALID_ARGUMENT (no colorFormat), UNSUPPORTED (a device made without Vulkan; no render
 * pass where there is no dynamic rendering) and those of Vulkan. */
VOY_API VoyResult voyCreateVulkanComposite(VoyDevice device, const VoyVulkanCompositeDesc* desc,
                                           VoyComposite* composite);
/* NULL is a no-op. The device must have finished all commands with it. */
VOY_API VoyResult voyDestroyVulkanComposite(VoyComposite composite);

typedef enum VoyVulkanDepthUse {
  /* Colour over the attachment's, whatever its depth; depth is left alone. */
  VOY_VULKAN_DEPTH_USE_NONE = 0,
  /* Colour and depth where the image's depth passes the test against the attachment's; where
   * the image has no depth (it stays half transparent), it counts as the far plane. */
  VOY_VULKAN_DEPTH_USE_TEST = 1,
  /* Colour over the attachment's, for images that the host's depth was a limit of; depth
   * where it passes the test. */
  VOY_VULKAN_DEPTH_USE_WRITE = 2,
  VOY_VULKAN_DEPTH_USE_MAX_ENUM = 0x7fffffff
} VoyVulkanDepthUse;

typedef struct VoyVulkanCompositeDraw {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DRAW */
  const void* next;
  VkCommandBuffer commandBuffer; /* recording, inside the render pass */
  VoyTarget target;              /* of the composite's device */
  uint32_t imageIndex;           /* acquired in SHADER_READ_ONLY_OPTIMAL for FRAGMENT_SHADER */
  uint32_t layer;
  VkRect2D area;              /* of the attachment: where the layer goes, pixel by pixel */
  VoyVulkanDepthUse depthUse; /* other than NONE asks for a target with depth and a depthFormat */
  VoyDepthEncoding encoding;  /* of the attachment: STANDARD or REVERSED */
  double nearZ, farZ;         /* of the host's projection, metres; farZ may be infinite */
} VoyVulkanCompositeDraw;
#define VOY_VULKAN_COMPOSITE_DRAW_INIT                                                            \
  {                                                                                               \
    VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DRAW, NULL, VK_NULL_HANDLE, NULL, 0, 0, {{0, 0}, {0, 0}}, \
        VOY_VULKAN_DEPTH_USE_NONE, VOY_DEPTH_ENCODING_STANDARD, 0.1, 1000.0                       \
  }

/* Sets pipeline, descriptor set 0, push constants, viewport and scissor.
 * Errors: INVALID_ARGUMENT (values out of range, a target of another device, one that cannot be
 * sampled, depth where target or composite has none). Never BUSY. */
VOY_API VoyResult voyRecordVulkanComposite(VoyComposite composite,
                                           const VoyVulkanCompositeDraw* draw);

#ifdef __cplusplus
}
#endif

#endif
