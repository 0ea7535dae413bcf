#include <algorithm>
#include <optional>

#include "plugin/backend_choice.h"
#include "plugin/call.h"
#include "plugin/experiment.h"
#include "plugin/structs.h"
#include "plugin/text.h"
#include "plugin/version.h"
#include "plugin/vulkan_device.h"

using namespace voyager;

namespace {

constexpr uint32_t kMaxWorkerThreads = 1024;

std::string version_text(uint32_t version) {
  return std::to_string(major_version(version)) + "." + std::to_string(minor_version(version)) +
         "." + std::to_string(version & 0xfff);
}

void check_version(uint32_t host) {
  if (serves(VOY_API_VERSION, host)) return;
  throw ApiError(VOY_ERROR_INCOMPATIBLE_VERSION, "desc.apiVersion: found " + version_text(host) +
                                                     ", expected the major version of " +
                                                     version_text(VOY_API_VERSION) +
                                                     " and its minor version or a lower one");
}

void check_backend(const VoyBackend& wanted) {
  check_enum(wanted, VOY_BACKEND_REFERENCE, "backend");
}

void check_allocator(const VoyAllocator* allocator) {
  if (allocator == nullptr) return;
  check_structure(allocator, VOY_STRUCTURE_TYPE_ALLOCATOR, "VoyAllocator");
  if (allocator->allocate == nullptr || allocator->deallocate == nullptr)
    refuse("desc.allocator: found NULL, expected both allocate and deallocate");
}

// A bit for each enumerant from 0 to last.
template <class Enum>
constexpr uint32_t bits_up_to(Enum last) {
  return (2u << last) - 1;
}

void log_creation(const DeviceObject& device, const std::string& cuda_left_out) {
  const auto write = [&](VoyLogLevel level, const std::string& what) {
    device.log.write(level, ("voyCreateDevice: " + what).c_str());
  };
  if (!cuda_left_out.empty()) write(VOY_LOG_LEVEL_WARNING, "AUTO chose the CPU: " + cuda_left_out);
  write(VOY_LOG_LEVEL_INFO, device.backend->device_name());
}

// The UUID that the backend must have; NULL for any.
const uint8_t* checked_uuid(const VoyDeviceDesc& desc, const vulkan::PhysicalDevice* physical,
                            vulkan::Sharing sharing) {
  if (physical == nullptr || sharing == vulkan::Sharing::host) return desc.deviceUuid;
  const uint8_t* uuid = physical->uuid().data();
  if (desc.deviceUuid != nullptr && !std::equal(uuid, uuid + 16, desc.deviceUuid))
    refuse(
        "desc.deviceUuid: found another UUID than the Vulkan device's, expected NULL or the same");
  const bool on_cpu = desc.backend == VOY_BACKEND_CPU || desc.backend == VOY_BACKEND_REFERENCE;
  return on_cpu ? nullptr : uuid;
}

std::shared_ptr<DeviceObject> make_device(const VoyDeviceDesc& desc,
                                          const VoyVulkanDeviceDesc* host) {
  std::optional<vulkan::DeviceDesc> wanted;
  std::optional<vulkan::PhysicalDevice> physical;
  if (host != nullptr) {
    wanted = vulkan_device_desc(*host);
    physical.emplace(wanted->get, wanted->instance, wanted->physical_device);
  }
  const uint8_t* uuid = checked_uuid(desc, physical ? &*physical : nullptr,
                                     wanted ? wanted->sharing : vulkan::Sharing::automatic);
  BackendChoice choice = choose_backend(desc.backend, uuid);
  auto object = std::make_shared<DeviceObject>(desc, choice.kind, std::move(choice.backend));
  if (wanted) {
    ExternalSupport support = object->backend->external_support();
    support.images &= object->backend->device_uuid() == physical->uuid();
    object->vulkan = std::make_shared<vulkan::Device>(*wanted, support);
  }
  log_creation(*object, choice.cuda_left_out);
  return object;
}

}  // namespace

voyager::DeviceObject::DeviceObject(const VoyDeviceDesc& desc, VoyBackend kind,
                                    std::unique_ptr<Backend> chosen)
    : Object(kKind),
      log{desc.log, desc.logUser, number(desc.logLevel)},
      memory(std::pmr::new_delete_resource()),
      budget(desc.hostMemoryBudget),
      device_budget(desc.deviceMemoryBudget),
      workers(desc.workerThreadCount),
      backend_kind(kind),
      backend(std::move(chosen)) {
  if (desc.allocator != nullptr) memory = &host_memory.emplace(*desc.allocator);
}

VoyResult VOY_CALL voyQueryBackend(VoyBackend backend) {
  return guarded("voyQueryBackend", [&](Call&) {
    check_backend(backend);
    if (backend != VOY_BACKEND_AUTO) choose_backend(backend, nullptr);
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyCreateDevice(const VoyDeviceDesc* desc, VoyDevice* device) {
  return guarded("voyCreateDevice", [&](Call&) {
    const VoyVulkanDeviceDesc* host = nullptr;
    check_structure(desc, VOY_STRUCTURE_TYPE_DEVICE_DESC, "VoyDeviceDesc",
                    Extension{VOY_STRUCTURE_TYPE_VULKAN_DEVICE_DESC, host});
    check_pointer(device, "device");
    check_version(desc->apiVersion);
    check_backend(desc->backend);
    check_count(desc->workerThreadCount, 0, kMaxWorkerThreads, "desc.workerThreadCount");
    check_enum(desc->logLevel, VOY_LOG_LEVEL_INFO, "desc.logLevel");
    check_allocator(desc->allocator);
    *device = static_cast<VoyDevice>(HandleTable::instance().insert(make_device(*desc, host)));
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyDestroyDevice(VoyDevice device) {
  return guarded("voyDestroyDevice", [&](Call& call) {
    call.remove<DeviceObject>(device);
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyGetCapabilities(VoyDevice device, VoyCapabilities* capabilities) {
  return guarded("voyGetCapabilities", [&](Call& call) {
    const auto object = call.use<DeviceObject>(device);
    VoyVulkanCapabilities* vulkan = nullptr;
    VoyExperimentCapabilities* experiment = nullptr;
    check_structure(capabilities, VOY_STRUCTURE_TYPE_CAPABILITIES, "VoyCapabilities",
                    Extension{VOY_STRUCTURE_TYPE_VULKAN_CAPABILITIES, vulkan},
                    Extension{VOY_STRUCTURE_TYPE_EXPERIMENT_CAPABILITIES, experiment});
    if (vulkan != nullptr && object->vulkan == nullptr)
      throw ApiError(VOY_ERROR_UNSUPPORTED,
                     "capabilities.next: found a VoyVulkanCapabilities for a device without a "
                     "VoyVulkanDeviceDesc, expected none");
    VoyCapabilities found = VOY_CAPABILITIES_INIT;
    found.next = capabilities->next;
    found.backend = object->backend_kind;
    found.workerThreadCount = static_cast<uint32_t>(object->workers.count());
    put_text(object->backend->device_name(), found.deviceName);
    const auto uuid = object->backend->device_uuid();
    std::copy(uuid.begin(), uuid.end(), found.deviceUuid);
    found.maxInstances = kMaxInstances;
    found.maxEyes = kMaxEyes;
    found.maxWidth = found.maxHeight = kMaxImageSide;
    found.targetKinds =
        bits_up_to(object->vulkan ? VOY_TARGET_KIND_VULKAN : VOY_TARGET_KIND_HOST_MEMORY);
    found.colorFormats = bits_up_to(VOY_COLOR_FORMAT_RGBA16F);
    *capabilities = found;
    if (vulkan != nullptr) fill(*vulkan, *object->vulkan);
    if (experiment != nullptr) fill(*experiment, object->backend_kind);
    return VOY_SUCCESS;
  });
}
