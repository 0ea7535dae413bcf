#include <algorithm>

#include "plugin/call.h"
#include "plugin/structs.h"
#include "plugin/version.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/reference/reference_backend.h"

using namespace voyager;

namespace {

constexpr uint32_t kMaxWorkerThreads = 1024;

std::string version_text(uint32_t version) {
  return std::to_string(major_version(version)) + "." + std::to_string(minor_version(version)) +
         "." + std::to_string(version & 0xfff);
}

void check_version(uint32_t host) {
  if (serves(VOY_API_VERSION, host)) return;
  throw ApiError(VOY_ERROR_INCOMPATIBLE_VERSION,
                 "desc.apiVersion: found " + version_text(host) +
                     ", expected the major version of " + version_text(VOY_API_VERSION) +
                     " and its minor version, or a lower one where the major version is not 0");
}

// The backend that will run; throws where this machine lacks it.
VoyBackend choose(const VoyBackend& wanted) {
  check_enum(wanted, VOY_BACKEND_REFERENCE, "backend");
  if (wanted == VOY_BACKEND_CUDA)
    throw ApiError(VOY_ERROR_NO_DEVICE,
                   "backend CUDA: found a request to draw, this version only searches with CUDA");
  return wanted == VOY_BACKEND_AUTO ? VOY_BACKEND_CPU : wanted;
}

// CPUs have the UUID zero (VoyCapabilities.deviceUuid).
void check_uuid(const uint8_t* uuid) {
  if (uuid != nullptr && std::any_of(uuid, uuid + 16, [](uint8_t byte) { return byte != 0; }))
    throw ApiError(VOY_ERROR_NO_DEVICE,
                   "desc.deviceUuid: found a UUID that no device of this backend has, "
                   "expected NULL or the sixteen zeros of a CPU");
}

void check_allocator(const VoyAllocator* allocator) {
  if (allocator == nullptr) return;
  check_structure(allocator, VOY_STRUCTURE_TYPE_ALLOCATOR, "VoyAllocator");
  if (allocator->allocate == nullptr || allocator->release == nullptr)
    refuse("desc.allocator: found NULL, expected both allocate and release");
}

}  // namespace

voyager::DeviceObject::DeviceObject(const VoyDeviceDesc& desc, VoyBackend chosen)
    : Object(kKind),
      log{desc.log, desc.logUser, number(desc.logLevel)},
      memory(std::pmr::new_delete_resource()),
      budget(desc.memoryBudget),
      workers(desc.workerThreads),
      backend_kind(chosen),
      backend(chosen == VOY_BACKEND_REFERENCE ? create_reference_backend() : create_cpu_backend()) {
  if (desc.allocator != nullptr) memory = &host_memory.emplace(*desc.allocator);
}

VoyResult voyQueryBackend(VoyBackend backend) {
  return guarded("voyQueryBackend", [&](Call&) {
    choose(backend);
    return VOY_SUCCESS;
  });
}

VoyResult voyCreateDevice(const VoyDeviceDesc* desc, VoyDevice* device) {
  return guarded("voyCreateDevice", [&](Call&) {
    check_structure(desc, VOY_STRUCTURE_TYPE_DEVICE_DESC, "VoyDeviceDesc");
    check_pointer(device, "device");
    check_version(desc->apiVersion);
    const VoyBackend chosen = choose(desc->backend);
    check_uuid(desc->deviceUuid);
    check_count(desc->workerThreads, 0, kMaxWorkerThreads, "desc.workerThreads");
    check_enum(desc->logLevel, VOY_LOG_INFO, "desc.logLevel");
    check_allocator(desc->allocator);
    const auto object = std::make_shared<DeviceObject>(*desc, chosen);
    *device = static_cast<VoyDevice>(HandleTable::instance().insert(object));
    object->log.write(VOY_LOG_INFO, ("voyCreateDevice: " + object->backend->device_name()).c_str());
    return VOY_SUCCESS;
  });
}

VoyResult voyDestroyDevice(VoyDevice device) {
  return guarded("voyDestroyDevice", [&](Call& call) {
    call.remove<DeviceObject>(device);
    return VOY_SUCCESS;
  });
}

VoyResult voyGetCapabilities(VoyDevice device, VoyCapabilities* capabilities) {
  return guarded("voyGetCapabilities", [&](Call& call) {
    const auto object = call.use<DeviceObject>(device);
    check_structure(capabilities, VOY_STRUCTURE_TYPE_CAPABILITIES, "VoyCapabilities");
    VoyCapabilities found = VOY_CAPABILITIES_INIT;
    found.backend = object->backend_kind;
    found.workerThreads = static_cast<uint32_t>(object->workers.count());
    object->backend->device_name().copy(found.deviceName, sizeof found.deviceName - 1);
    found.maxInstances = 1;
    found.maxEyes = 1;
    found.maxWidth = found.maxHeight = kMaxImageSide;
    found.searches = 1u << VOY_SEARCH_AUTO | 1u << VOY_SEARCH_EXHAUSTIVE |
                     1u << VOY_SEARCH_STREAMING | 1u << VOY_SEARCH_TEMPORAL |
                     1u << VOY_SEARCH_TEMPORAL_VISIT;
    found.exponentials = 1u << VOY_EXPONENTIAL_AUTO | 1u << VOY_EXPONENTIAL_EXACT;
    if (object->backend_kind == VOY_BACKEND_CPU)
      found.exponentials |= 1u << VOY_EXPONENTIAL_EX2 | 1u << VOY_EXPONENTIAL_LUT;
    found.targetKinds = 1u << VOY_TARGET_KIND_HOST_MEMORY;
    found.colorFormats = 1u << VOY_COLOR_FORMAT_NONE | 1u << VOY_COLOR_FORMAT_RGBA8_UNORM |
                         1u << VOY_COLOR_FORMAT_RGBA32F;
    *capabilities = found;
    return VOY_SUCCESS;
  });
}
