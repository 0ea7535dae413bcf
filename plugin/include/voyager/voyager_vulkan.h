/* Voyager in a Vulkan host, in C99: the extensions that the host enables, images that Voyager draws
 * into, the semaphores between host and library, and commands that Voyager records into the host's
 * command buffers. docs/vulkan.md shows the life of a frame.
 *
 * Voyager creates no instance, no device and no queue. It submits nothing and links no Vulkan
 * library: every entry point comes from the host's vkGetInstanceProcAddr. Instance and device must
 * be Vulkan 1.1 or newer.
 *
 * Pixels reach the host in one of two ways. VoyVulkanCapabilities says which one a device has; the
 * functions are the same.
 * - DEVICE sharing: the CUDA device is the Vulkan device (same UUID). The two share the images
 *   through external handles. CUDA writes into them and voyRenderFrame does not wait.
 * - HOST sharing: the CPU or another device draws into host-visible memory. The commands of
 *   voyRecordVulkanAcquire copy it into the image.
 *
 * OWNERSHIP. File descriptors that the host passes belong to the library once the call succeeds.
 * If the call fails, all of them still belong to the host. Descriptors that the library creates
 * never leave it. Vulkan handles that the host passes still belong to the host. They must outlive
 * what was created with them, so destroy the VoyDevice before the VkDevice. If a VoyDevice still
 * exists when the library is unloaded, its Vulkan objects are leaked and Vulkan is not called.
 *
 * ERRORS. Besides the errors that a function lists, it may return INVALID_HANDLE and
 * INVALID_STRUCTURE (voyager.h). If a Vulkan call inside it fails, it returns OUT_OF_HOST_MEMORY,
 * OVER_BUDGET (no device memory), DEVICE_LOST, or INTERNAL with the VkResult in the message.
 *
 * THREAD-SAFETY. As in voyager.h. The host's command buffers must be externally synchronised, as
 * Vulkan requires. Destroying a target or a composite calls vkDestroy... and vkFree... for its
 * objects, so the device must have finished all submitted commands that use them. */
#ifndef VOYAGER_VOYAGER_VULKAN_H_
#define VOYAGER_VOYAGER_VULKAN_H_

#include <voyager/voyager.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------- before the host makes its device */

/* How pixels get from what draws them into the host's images. */
typedef enum VoyVulkanSharing {
  VOY_VULKAN_SHARING_AUTO = 0,   /* DEVICE if possible, else HOST */
  VOY_VULKAN_SHARING_DEVICE = 1, /* CUDA writes into the Vulkan images */
  VOY_VULKAN_SHARING_HOST = 2,   /* frames are copied from host-visible memory */
  VOY_VULKAN_SHARING_MAX_ENUM = 0x7fffffff
} VoyVulkanSharing;

/* How the host's queue and Voyager wait for each other. */
typedef enum VoyVulkanSync {
  VOY_VULKAN_SYNC_AUTO = 0,     /* the first of these that is possible */
  VOY_VULKAN_SYNC_TIMELINE = 1, /* two timeline semaphores for each target */
  VOY_VULKAN_SYNC_BINARY = 2,   /* two binary semaphores for each image of a target; DEVICE sharing
                                   only */
  VOY_VULKAN_SYNC_HOST = 3,     /* no semaphores: voyRenderFrame returns when the image is written,
                                   and the host calls it after its queue has finished with the
                                   image */
  VOY_VULKAN_SYNC_MAX_ENUM = 0x7fffffff
} VoyVulkanSync;

/* A physical device to ask about. */
typedef struct VoyVulkanPhysicalDevice {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_PHYSICAL_DEVICE */
  const void* next;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr; /* the loader's; not NULL */
  VkInstance instance;                           /* of Vulkan 1.1 or newer */
  VkPhysicalDevice physicalDevice;               /* of this instance */
} VoyVulkanPhysicalDevice;
#define VOY_VULKAN_PHYSICAL_DEVICE_INIT \
  { VOY_STRUCTURE_TYPE_VULKAN_PHYSICAL_DEVICE, NULL, NULL, VK_NULL_HANDLE, VK_NULL_HANDLE }

/* What the host should enable to get the best mode of a device. The arrays and strings have static
 * storage. */
typedef struct VoyVulkanRequirements {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_REQUIREMENTS */
  void* next;
  uint32_t vulkanVersion;                /* the lowest VkApplicationInfo.apiVersion */
  uint32_t instanceExtensionCount;       /* 0 in this version: Vulkan 1.1 is enough */
  const char* const* instanceExtensions; /* instanceExtensionCount names, or NULL */
  uint32_t deviceExtensionCount;         /* 0 if the device has none that Voyager uses */
  const char* const* deviceExtensions;   /* deviceExtensionCount names for VkDeviceCreateInfo */
  VkBool32 timelineSemaphore;            /* VK_TRUE: enable this feature */
} VoyVulkanRequirements;
#define VOY_VULKAN_REQUIREMENTS_INIT \
  { VOY_STRUCTURE_TYPE_VULKAN_REQUIREMENTS, NULL, 0, 0, NULL, 0, NULL, VK_FALSE }

/* Tells what to enable. Call it with physicalDevice NULL before creating the instance: it then
 * fills vulkanVersion and the instance extensions, and all device extensions and the feature that
 * Voyager can use of any device. A host that must name its device extensions before it has a
 * physical device enables those of them that its device has. Call it with a physical device before
 * creating the VkDevice: it then lists what Voyager can use of what this device has. Nothing in the
 * lists is mandatory. What the host does not enable may cost a mode (VoyVulkanCapabilities).
 * Errors: INVALID_ARGUMENT (NULL; getInstanceProcAddr lacks functions of Vulkan 1.1), UNSUPPORTED
 * (a physical device older than Vulkan 1.1). */
VOY_API VoyResult VOY_CALL voyGetVulkanRequirements(const VoyVulkanPhysicalDevice* physicalDevice,
                                                    VoyVulkanRequirements* requirements);

/* ------------------------------------------------------------------- device */

/* In VoyDeviceDesc.next: the Vulkan device that the host draws with. All handles must outlive the
 * VoyDevice.
 * The library takes the UUID from it, so VoyDeviceDesc.deviceUuid must be NULL or the same UUID.
 * The backend AUTO is CUDA if the CUDA device is this device, else the CPU. With `sharing` HOST any
 * device may draw: deviceUuid and AUTO then mean what they mean without Vulkan.
 * Further errors of voyCreateDevice: UNSUPPORTED (a sharing or sync that is not possible here; a
 * device or vulkanVersion older than 1.1; the message explains), DEVICE_LOST. */
typedef struct VoyVulkanDeviceDesc {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_DEVICE_DESC */
  const void* next;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr; /* the loader's; not NULL */
  VkInstance instance;                           /* of Vulkan 1.1 or newer */
  VkPhysicalDevice physicalDevice;               /* that `device` was created from */
  VkDevice device;                               /* the host's; not NULL */
  uint32_t vulkanVersion;                        /* VkApplicationInfo.apiVersion of the instance */
  uint32_t deviceExtensionCount;                 /* of `deviceExtensions`, 0 to 4096 */
  const char* const* deviceExtensions;           /* all that the host enabled */
  VkBool32 timelineSemaphore;                    /* VK_TRUE: the host enabled the feature */
  VoyVulkanSharing sharing;                      /* AUTO, or a choice that fails if not possible */
  VoyVulkanSync sync;                            /* AUTO, or a choice that fails if not possible */
} VoyVulkanDeviceDesc;
#define VOY_VULKAN_DEVICE_DESC_INIT                                                         \
  {                                                                                         \
    VOY_STRUCTURE_TYPE_VULKAN_DEVICE_DESC, NULL, NULL, VK_NULL_HANDLE, VK_NULL_HANDLE,      \
        VK_NULL_HANDLE, 0, 0, NULL, VK_FALSE, VOY_VULKAN_SHARING_AUTO, VOY_VULKAN_SYNC_AUTO \
  }

/* In VoyCapabilities.next: the modes of a device. voyGetCapabilities returns VOY_ERROR_UNSUPPORTED
 * for a device without a VoyVulkanDeviceDesc. */
typedef struct VoyVulkanCapabilities {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_CAPABILITIES */
  void* next;
  VoyVulkanSharing sharing;  /* DEVICE or HOST */
  VoyVulkanSync sync;        /* TIMELINE, BINARY or HOST */
  VkBool32 hostMemoryImport; /* HOST sharing: VK_TRUE if Vulkan imports the memory that frames are
                                drawn into (VK_EXT_external_memory_host; tested with one page).
                                VK_FALSE if frames are drawn into mapped Vulkan memory */
  char why[192];             /* why not DEVICE, and why not TIMELINE; "" if both. UTF-8 */
} VoyVulkanCapabilities;
#define VOY_VULKAN_CAPABILITIES_INIT                                                             \
  {                                                                                              \
    VOY_STRUCTURE_TYPE_VULKAN_CAPABILITIES, NULL, VOY_VULKAN_SHARING_AUTO, VOY_VULKAN_SYNC_AUTO, \
        VK_FALSE, {                                                                              \
      0                                                                                          \
    }                                                                                            \
  }

/* ------------------------------------------------------------------- target */

/* A handle of the operating system to memory or to a semaphore. The `handleType` beside it says
 * which member is set. This version runs on POSIX systems only, where it is fd. That member is the
 * first, because an initialiser sets the first. */
typedef union VoyExternalHandle {
#if defined(_WIN32)
  void* win32; /* a HANDLE; NULL is none */
  int fd;      /* not used */
#else
  int fd;      /* a file descriptor; -1 is none */
  void* win32; /* not used */
#endif
} VoyExternalHandle;
#if defined(_WIN32)
#define VOY_EXTERNAL_HANDLE_NONE \
  { 0 }
#define VOY_VULKAN_MEMORY_HANDLE_TYPE VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_WIN32_BIT
#define VOY_VULKAN_SEMAPHORE_HANDLE_TYPE VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_WIN32_BIT
#else

/* No handle. */
#define VOY_EXTERNAL_HANDLE_NONE \
  { -1 }
/* The handle type of exported memory: VoyVulkanMemory.handleType. */
#define VOY_VULKAN_MEMORY_HANDLE_TYPE VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT
/* The handle type of exported semaphores: VoyVulkanImportedSemaphores.handleType. */
#define VOY_VULKAN_SEMAPHORE_HANDLE_TYPE VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT
#endif

/* Memory that the host exported, and the place of an image in it. */
typedef struct VoyVulkanMemory {
  VoyExternalHandle handle; /* open. With HOST sharing it is not used and may be none */
  VkExternalMemoryHandleTypeFlagBits handleType; /* VOY_VULKAN_MEMORY_HANDLE_TYPE */
  VkBool32 dedicated;                            /* VK_TRUE: a dedicated allocation of this image */
  uint64_t size;                                 /* of the VkDeviceMemory, bytes, > 0 */
  uint64_t offset; /* of the image in it, bytes, < size, aligned as Vulkan requires */
} VoyVulkanMemory;
#define VOY_VULKAN_MEMORY_INIT \
  { VOY_EXTERNAL_HANDLE_NONE, VOY_VULKAN_MEMORY_HANDLE_TYPE, VK_FALSE, 0, 0 }

/* An image of a ring, created by the host. It is 2D with optimal tiling, one sample, one mip level,
 * exclusive sharing mode, and the format and layers of the target. With HOST sharing its usage
 * includes VK_IMAGE_USAGE_TRANSFER_DST_BIT. */
typedef struct VoyVulkanImportedImage {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_IMAGE */
  const void* next;
  VkImage color;                /* VK_NULL_HANDLE if and only if colorFormat is NONE. Each image is
                                   passed once */
  VoyVulkanMemory colorMemory;  /* that `color` is bound to; ignored without it */
  VkImageUsageFlags colorUsage; /* as the image was created */
  VkImage depth; /* VK_FORMAT_R32_SFLOAT; VK_NULL_HANDLE if and only if the target has no depth */
  VoyVulkanMemory depthMemory;  /* that `depth` is bound to; ignored without it */
  VkImageUsageFlags depthUsage; /* as the image was created */
} VoyVulkanImportedImage;
#define VOY_VULKAN_IMPORTED_IMAGE_INIT                                                         \
  {                                                                                            \
    VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_IMAGE, NULL, VK_NULL_HANDLE, VOY_VULKAN_MEMORY_INIT, 0, \
        VK_NULL_HANDLE, VOY_VULKAN_MEMORY_INIT, 0                                              \
  }

/* Semaphores that the host created and exported: timeline semaphores for TIMELINE, binary ones for
 * BINARY. With HOST sharing the handles are not used and may be none. */
typedef struct VoyVulkanImportedSemaphores {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_SEMAPHORES */
  const void* next;
  VkSemaphore released;             /* the host signals it, Voyager waits */
  VoyExternalHandle releasedHandle; /* of `released`, open; another one than renderedHandle */
  VkSemaphore rendered;             /* Voyager signals it, the host waits */
  VoyExternalHandle renderedHandle; /* of `rendered`, open */
  VkExternalSemaphoreHandleTypeFlagBits handleType; /* of both; VOY_VULKAN_SEMAPHORE_HANDLE_TYPE */
  uint32_t reserved;                                /* 0 */
} VoyVulkanImportedSemaphores;
#define VOY_VULKAN_IMPORTED_SEMAPHORES_INIT                                                        \
  {                                                                                                \
    VOY_STRUCTURE_TYPE_VULKAN_IMPORTED_SEMAPHORES, NULL, VK_NULL_HANDLE, VOY_EXTERNAL_HANDLE_NONE, \
        VK_NULL_HANDLE, VOY_EXTERNAL_HANDLE_NONE, VOY_VULKAN_SEMAPHORE_HANDLE_TYPE, 0              \
  }

/* The most images of a ring. */
#define VOY_MAX_VULKAN_IMAGES 8
/* The most layers of an image. */
#define VOY_MAX_VULKAN_LAYERS 8

/* In VoyTargetDesc.next, with kind VULKAN and without host memory (color and depth NULL, pitches
 * 0): a ring of images, one for each frame in flight. Each image may have a layer for each eye.
 * Formats: RGBA8_UNORM is VK_FORMAT_R8G8B8A8_UNORM, RGBA16F is VK_FORMAT_R16G16B16A16_SFLOAT and
 * RGBA32F is VK_FORMAT_R32G32B32A32_SFLOAT. Depth is VK_FORMAT_R32_SFLOAT in metres.
 * Images that Voyager creates can be sampled and copied from.
 * Errors of voyCreateTarget: INVALID_ARGUMENT (a count out of range; an image or a semaphore that
 * does not fit the mode; a handle that is not open or of another type), UNSUPPORTED (a device
 * without a VoyVulkanDeviceDesc), INTERNAL (CUDA cannot import an image), and those of Vulkan. */
typedef struct VoyVulkanTargetDesc {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_TARGET_DESC */
  const void* next;
  uint32_t imageCount;                  /* 1 to VOY_MAX_VULKAN_IMAGES */
  uint32_t layerCount;                  /* 1 to VOY_MAX_VULKAN_LAYERS */
  VkBool32 hasDepth;                    /* VK_TRUE: Voyager writes depth */
  VkBool32 hasDepthLimit;               /* VK_TRUE: voyRecordVulkanDepthLimit will be used */
  const VoyVulkanImportedImage* images; /* imageCount of them; NULL: Voyager creates them */
  uint32_t semaphoreCount;              /* 0: Voyager creates them. Else 1 for TIMELINE and
                                           imageCount for BINARY */
  const VoyVulkanImportedSemaphores* semaphores; /* semaphoreCount of them; NULL if that is 0 */
} VoyVulkanTargetDesc;
#define VOY_VULKAN_TARGET_DESC_INIT \
  { VOY_STRUCTURE_TYPE_VULKAN_TARGET_DESC, NULL, 2, 1, VK_FALSE, VK_FALSE, NULL, 0, NULL }

/* The Vulkan objects of an image of the ring: created by Voyager, or passed by the host. They
 * belong to the target and stay the same for its life. Image views are VK_IMAGE_VIEW_TYPE_2D_ARRAY
 * over all layers. They are VK_NULL_HANDLE for host images without VK_IMAGE_USAGE_SAMPLED_BIT. */
typedef struct VoyVulkanImage {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_IMAGE */
  void* next;
  VkImage color;         /* VK_NULL_HANDLE if colorFormat is NONE */
  VkImageView colorView; /* VK_NULL_HANDLE also without `color` */
  VkImage depth;         /* what Voyager writes; VK_NULL_HANDLE without hasDepth */
  VkImageView depthView; /* VK_NULL_HANDLE also without `depth` */
  /* The host signals it, Voyager waits. TIMELINE: the same for all images. Sync HOST:
   * VK_NULL_HANDLE. */
  VkSemaphore released;
  VkSemaphore rendered; /* Voyager signals it, the host waits; else as `released` */
} VoyVulkanImage;
#define VOY_VULKAN_IMAGE_INIT                                                              \
  {                                                                                        \
    VOY_STRUCTURE_TYPE_VULKAN_IMAGE, NULL, VK_NULL_HANDLE, VK_NULL_HANDLE, VK_NULL_HANDLE, \
        VK_NULL_HANDLE, VK_NULL_HANDLE, VK_NULL_HANDLE                                     \
  }

/* Lists the images of a target. With capacity 0 the call only sets *count. Otherwise it writes up
 * to `capacity` images, their `type` and `next` included, and sets *count to the number of images.
 * It returns VOY_INCOMPLETE if that is more than `capacity`. Errors: INVALID_ARGUMENT (NULL; a
 * target of kind HOST_MEMORY). */
VOY_API VoyResult VOY_CALL voyGetVulkanImages(VoyTarget target, uint32_t capacity,
                                              VoyVulkanImage* images, uint32_t* count);

/* -------------------------------------------------------------------- frame */

/* In VoyFrame.next, for Vulkan targets: the image of the ring to draw into, and what the frame
 * waits for and signals.
 * - TIMELINE: drawing begins when `released` has reached waitValue (0: at once). When the image is
 *   written, `rendered` becomes signalValue, which must be greater than in the target's last frame.
 *   In the first frame it must be greater than the current value of an imported semaphore.
 * - BINARY: waitValue 1 waits for the image's `released`, 0 does not. signalValue 1 signals its
 *   `rendered`, 0 does not. If layers are drawn by separate frames, the last one signals.
 * - HOST: both values are 0.
 *
 * Submit the signal that the frame waits for before calling voyRenderFrame. With HOST sharing the
 * call itself waits, and returns VOY_ERROR_TIMEOUT after 10 s. If voyRenderFrame fails with
 * anything but DEVICE_LOST, it signals nothing and consumes no wait.
 *
 * With DEVICE sharing the call returns while the frame is in flight; it takes about 0.1 ms of host
 * time. It waits for the device in the first frame of a view and of a list of scenes
 * (voySetViewInstances), after a failure, when buffers must grow, when 16 frames of the view are in
 * flight, when these and the new one have more than 24 instances together, and when 3 frames of a
 * scene with damaged chunks are in flight. If a frame that it waits for is one that the host does
 * not let go on, it returns VOY_ERROR_TIMEOUT after 10 s. A frame in flight cannot be drawn again
 * with larger buffers. So if the view turns to far more splats at once, frames may lack some of
 * them. VoyFrameStats.pairsDropped counts them, and the frames that are drawn after the first of
 * these has ended have larger buffers.
 *
 * Two eyes draw into two layers of one image, or into one image of two targets each. imageIndex and
 * the values then apply to both targets. A target has a fixed size: to resize, create another. */
typedef struct VoyVulkanFrame {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_FRAME */
  const void* next;
  uint32_t imageIndex;  /* an image that was released and not acquired since */
  uint32_t reserved;    /* 0 */
  uint64_t waitValue;   /* for `released`, by the sync as above; 0: the frame waits for nothing */
  uint64_t signalValue; /* for `rendered`, by the sync as above */
} VoyVulkanFrame;
#define VOY_VULKAN_FRAME_INIT \
  { VOY_STRUCTURE_TYPE_VULKAN_FRAME, NULL, 0, 0, 0, 0 }

/* ---------------------------------------------------------------- recording */

/* How the host's commands use an image of a ring. */
typedef struct VoyVulkanUse {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_USE */
  const void* next;
  VkCommandBuffer commandBuffer; /* recording, outside a render pass. Its queue has graphics;
                                    compute is enough for `stages` of compute and transfer */
  uint32_t queueFamily;          /* of the queue that it will be submitted to */
  uint32_t imageIndex;           /* in the ring: 0 to imageCount - 1, as in voyGetVulkanImages */
  VkImageLayout layout;          /* SHADER_READ_ONLY_OPTIMAL, TRANSFER_SRC_OPTIMAL or GENERAL. A
                                    release names the layout of the acquire before it */
  VkPipelineStageFlags stages;   /* of the host's commands that use the image. An acquire needs at
                                    least one that reads images: a shader, TRANSFER or ALL_... */
} VoyVulkanUse;
#define VOY_VULKAN_USE_INIT                                                             \
  {                                                                                     \
    VOY_STRUCTURE_TYPE_VULKAN_USE, NULL, VK_NULL_HANDLE, 0, 0,                          \
        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT \
  }

/* RELEASE gives an image to Voyager: once for each image of a new ring, and after each use.
 * ACQUIRE takes it back for the host when a frame has been drawn into it.
 * For each image the two alternate, and the commands of each call are submitted exactly once, in
 * the order of the calls.
 *
 * A second release in a row has no effect. An acquire of an image that was not released is
 * INVALID_ARGUMENT, and so is a layout or a queue family that the image cannot have. A call that
 * fails records nothing. */

/* Records the release of an image, with its depth. The submission signals `released`.
 * Errors: INVALID_ARGUMENT (values out of range; a target of kind HOST_MEMORY), BUSY (another
 * thread draws into the target or records one of these two). */
VOY_API VoyResult VOY_CALL voyRecordVulkanRelease(VoyTarget target, const VoyVulkanUse* use);

/* Records the acquire of an image, with its depth. The submission waits for `rendered` at
 * VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, or at TRANSFER and use.stages. After it the image is in
 * use.layout. Errors: as voyRecordVulkanRelease. */
VOY_API VoyResult VOY_CALL voyRecordVulkanAcquire(VoyTarget target, const VoyVulkanUse* use);

/* A copy of one layer of an acquired image into an image of the host. */
typedef struct VoyVulkanCopy {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_COPY */
  const void* next;
  VkCommandBuffer commandBuffer; /* recording, outside a render pass */
  uint32_t imageIndex;           /* acquired in TRANSFER_SRC_OPTIMAL or GENERAL */
  VkImageLayout layout;          /* the layout it was acquired in */
  uint32_t layer;                /* of the target's image, 0 to layerCount - 1 */
  VkImage into;                  /* the host's: 2D, one sample, usage TRANSFER_DST */
  VkFormat intoFormat;           /* see voyRecordVulkanCopy */
  VkImageLayout intoLayout;      /* TRANSFER_DST_OPTIMAL or GENERAL */
  uint32_t intoLayer;            /* array layer of `into` */
  VkOffset2D intoOffset;         /* >= 0; the whole layer must fit */
} VoyVulkanCopy;
#define VOY_VULKAN_COPY_INIT                                                                       \
  {                                                                                                \
    VOY_STRUCTURE_TYPE_VULKAN_COPY, NULL, VK_NULL_HANDLE, 0, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, \
        0, VK_NULL_HANDLE, VK_FORMAT_R8G8B8A8_SRGB, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0, {     \
      0, 0                                                                                         \
    }                                                                                              \
  }

/* Records a copy of code values without conversion. RGBA8_UNORM goes into R8G8B8A8 UNORM or SRGB on
 * any queue. It goes into B8G8R8A8 UNORM by a blit, which needs a queue with graphics. RGBA16F and
 * RGBA32F go into their own format. The host synchronises the access to its image.
 * Errors: INVALID_ARGUMENT (values out of range; a target of kind HOST_MEMORY), UNSUPPORTED
 * (another format: use a composite; a target without colour). Never BUSY. */
VOY_API VoyResult VOY_CALL voyRecordVulkanCopy(VoyTarget target, const VoyVulkanCopy* copy);

/* A copy of the host's depth into the target, which hides splats behind it. Record and submit it
 * before the frame that uses it; its submission signals the `released` that the frame waits for.
 * The eye of that frame has a VoyEyeDepthLimit with `depth` NULL. */
typedef struct VoyVulkanDepthLimit {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_DEPTH_LIMIT */
  const void* next;
  VkCommandBuffer commandBuffer; /* recording, outside a render pass */
  uint32_t queueFamily;          /* of the queue that it will be submitted to */
  uint32_t imageIndex;           /* of the ring, which the frame will be drawn into */
  uint32_t layer;                /* of the target's image, which the frame will be drawn into */
  VkImage depth; /* the host's: 2D, one sample, usage TRANSFER_SRC, no smaller than the target */
  VkFormat depthFormat;      /* D32_SFLOAT, D32_SFLOAT_S8_UINT or R32_SFLOAT */
  VkImageLayout depthLayout; /* TRANSFER_SRC_OPTIMAL or GENERAL */
  uint32_t depthLayer;       /* array layer of `depth` */
  VkOffset2D depthOffset;    /* where the target's rectangle lies in it */
} VoyVulkanDepthLimit;
#define VOY_VULKAN_DEPTH_LIMIT_INIT                                                       \
  {                                                                                       \
    VOY_STRUCTURE_TYPE_VULKAN_DEPTH_LIMIT, NULL, VK_NULL_HANDLE, 0, 0, 0, VK_NULL_HANDLE, \
        VK_FORMAT_D32_SFLOAT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, 0, {                  \
      0, 0                                                                                \
    }                                                                                     \
  }

/* Records the copy. Errors: INVALID_ARGUMENT (values out of range; a target without hasDepthLimit),
 * UNSUPPORTED (another format). Never BUSY. */
VOY_API VoyResult VOY_CALL voyRecordVulkanDepthLimit(VoyTarget target,
                                                     const VoyVulkanDepthLimit* limit);

/* ---------------------------------------------------------------- composite */

/* A handle, as those of voyager.h: a pipeline that VoyVulkanCompositeDesc describes. */
typedef struct VoyVulkanComposite_T* VoyVulkanComposite;

/* A pipeline that draws a target's image over the host's image, with one sample. It draws inside
 * the host's render pass. With renderPass NULL it draws inside dynamic rendering with the formats
 * below and no stencil attachment. Then the host has enabled the feature dynamicRendering of
 * Vulkan 1.3 or of VK_KHR_dynamic_rendering. For an _SRGB colorFormat the pipeline decodes the
 * colours first, because the attachment encodes them again. Opaque pixels keep their code values.
 * Blending is then linear. */
typedef struct VoyVulkanCompositeDesc {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DESC */
  const void* next;
  VkRenderPass renderPass; /* compatible with the one drawn in; NULL: dynamic rendering */
  uint32_t subpass;        /* index in renderPass; ignored without one */
  VkFormat colorFormat; /* of the first colour attachment of the subpass. UNSUPPORTED if the device
                           cannot blend it */
  VkFormat depthFormat; /* a depth format, or UNDEFINED without a depth attachment */
} VoyVulkanCompositeDesc;
#define VOY_VULKAN_COMPOSITE_DESC_INIT                                                      \
  {                                                                                         \
    VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DESC, NULL, VK_NULL_HANDLE, 0, VK_FORMAT_UNDEFINED, \
        VK_FORMAT_UNDEFINED                                                                 \
  }

/* Creates a composite. The host destroys it with voyDestroyVulkanComposite.
 * Errors: INVALID_ARGUMENT (no colorFormat), UNSUPPORTED (a device without a VoyVulkanDeviceDesc; a
 * format; renderPass NULL without dynamic rendering), and those of Vulkan. */
VOY_API VoyResult VOY_CALL voyCreateVulkanComposite(VoyDevice device,
                                                    const VoyVulkanCompositeDesc* desc,
                                                    VoyVulkanComposite* composite);

/* Destroys a composite. The device must have finished all commands that use it. */
VOY_API VoyResult VOY_CALL voyDestroyVulkanComposite(VoyVulkanComposite composite);

/* What a composite does with depth. */
typedef enum VoyVulkanDepthUse {
  /* Draws colour without a depth test and writes no depth. */
  VOY_VULKAN_DEPTH_USE_NONE = 0,
  /* Draws colour and depth where the image's depth passes the test against the attachment's. Where
   * the image has no depth (its transmittance stays above 0.5), it counts as the far plane. */
  VOY_VULKAN_DEPTH_USE_TEST = 1,
  /* Draws colour without a depth test, and depth where it passes the test. For images that were
   * drawn with the host's depth as a limit. */
  VOY_VULKAN_DEPTH_USE_WRITE = 2,
  VOY_VULKAN_DEPTH_USE_MAX_ENUM = 0x7fffffff
} VoyVulkanDepthUse;

/* In VoyVulkanCompositeDraw.next: draws the image as another eye sees it, for a frame that the host
 * shows before Voyager has drawn it. Each pixel is taken from where the image shows what the eye
 * sees there, by the image's own depth. What was not in the image, or behind something, is not
 * known: it gets what is beside it, and beyond the image's edges their last pixels. Needs a target
 * with depth. docs/vulkan.md has the error by the speed of the head. */
typedef struct VoyVulkanReprojection {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_VULKAN_REPROJECTION */
  const void* next;
  VoyPose drawnPose;       /* of the VoyFrameEye that the layer was drawn for */
  VoyFrustum drawnFrustum; /* of the same VoyFrameEye */
  VoyPose pose;            /* of the eye that sees it now */
  VoyFrustum frustum;      /* of the eye that sees it now, over the whole layer, as drawnFrustum */
} VoyVulkanReprojection;
#define VOY_VULKAN_REPROJECTION_INIT                                                       \
  {                                                                                        \
    VOY_STRUCTURE_TYPE_VULKAN_REPROJECTION, NULL, {{0, 0, 0}, {0, 0, 0, 1}}, {0, 0, 0, 0}, \
        {{0, 0, 0}, {0, 0, 0, 1}}, {                                                       \
      0, 0, 0, 0                                                                           \
    }                                                                                      \
  }

/* One draw of a composite. */
typedef struct VoyVulkanCompositeDraw {
  VoyStructureType type;         /* VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DRAW */
  const void* next;              /* NULL or a VoyVulkanReprojection */
  VkCommandBuffer commandBuffer; /* recording, inside the render pass or dynamic rendering */
  VoyTarget target;              /* of the composite's device */
  uint32_t imageIndex;           /* acquired in SHADER_READ_ONLY_OPTIMAL for FRAGMENT_SHADER */
  uint32_t layer;                /* of the target's image, 0 to layerCount - 1 */
  /* Of the attachment, where the layer goes, pixel by pixel: offset 0 or more, extent 1 to the
   * target's size. A smaller extent shows the picture's top left part. */
  VkRect2D area;
  VkBool32 upsideDown; /* VK_TRUE: the attachment's first row is the bottom of the picture, so
                          the layer's first row goes to the last row of `area` */
  VoyVulkanDepthUse depthUse;     /* TEST and WRITE need a target with depth and a depthFormat */
  VoyDepthEncoding depthEncoding; /* of the attachment; STANDARD or REVERSED */
  uint32_t reserved;              /* 0 */
  double nearZ, /* near plane of the host's projection, metres, as VoyEyeDepthLimit.nearZ */
      farZ;     /* its far plane, as VoyEyeDepthLimit.farZ. Both are ignored with depthUse NONE */
} VoyVulkanCompositeDraw;
#define VOY_VULKAN_COMPOSITE_DRAW_INIT                                                            \
  {                                                                                               \
    VOY_STRUCTURE_TYPE_VULKAN_COMPOSITE_DRAW, NULL, VK_NULL_HANDLE, NULL, 0, 0, {{0, 0}, {0, 0}}, \
        VK_FALSE, VOY_VULKAN_DEPTH_USE_NONE, VOY_DEPTH_ENCODING_STANDARD, 0, 0.1, 1000.0          \
  }

/* Records a draw. It changes the command buffer's pipeline, descriptor set 0, push constants,
 * viewport and scissor.
 * Errors: INVALID_ARGUMENT (values out of range; a target of another device or one that cannot be
 * sampled; depth that the target or the composite lacks). Never BUSY. */
VOY_API VoyResult VOY_CALL voyRecordVulkanComposite(VoyVulkanComposite composite,
                                                    const VoyVulkanCompositeDraw* draw);

/* The types of the functions above, for hosts that load the library at run time (docs/abi.md). */
typedef VoyResult(VOY_CALL* PFN_voyGetVulkanRequirements)(
    const VoyVulkanPhysicalDevice* physicalDevice, VoyVulkanRequirements* requirements);
typedef VoyResult(VOY_CALL* PFN_voyGetVulkanImages)(VoyTarget target, uint32_t capacity,
                                                    VoyVulkanImage* images, uint32_t* count);
typedef VoyResult(VOY_CALL* PFN_voyRecordVulkanRelease)(VoyTarget target, const VoyVulkanUse* use);
typedef VoyResult(VOY_CALL* PFN_voyRecordVulkanAcquire)(VoyTarget target, const VoyVulkanUse* use);
typedef VoyResult(VOY_CALL* PFN_voyRecordVulkanCopy)(VoyTarget target, const VoyVulkanCopy* copy);
typedef VoyResult(VOY_CALL* PFN_voyRecordVulkanDepthLimit)(VoyTarget target,
                                                           const VoyVulkanDepthLimit* limit);
typedef VoyResult(VOY_CALL* PFN_voyCreateVulkanComposite)(VoyDevice device,
                                                          const VoyVulkanCompositeDesc* desc,
                                                          VoyVulkanComposite* composite);
typedef VoyResult(VOY_CALL* PFN_voyDestroyVulkanComposite)(VoyVulkanComposite composite);
typedef VoyResult(VOY_CALL* PFN_voyRecordVulkanComposite)(VoyVulkanComposite composite,
                                                          const VoyVulkanCompositeDraw* draw);

#ifdef __cplusplus
}
#endif

#endif
