// voyEnumerateDevices: what this machine has, and what it lacks.
#include <unistd.h>

#include <algorithm>

#include "plugin/call.h"
#include "plugin/structs.h"
#include "plugin/text.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/backend_module.h"
#include "runtime/reference/reference_backend.h"

using namespace voyager;

namespace {

VoyDeviceInfo device_info(VoyBackend backend, const std::string& needs) {
  VoyDeviceInfo info = {};
  info.type = VOY_STRUCTURE_TYPE_DEVICE_INFO;
  info.backend = backend;
  put_text(needs, info.needs);
  return info;
}

VoyDeviceInfo host_info(VoyBackend kind, const Backend& backend) {
  VoyDeviceInfo info = device_info(kind, "nothing beyond the library");
  info.usable = 1;
  info.memoryBytes = static_cast<uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                     static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
  info.workerThreadCount = static_cast<uint32_t>(Workers().count());
  put_text(backend.device_name(), info.deviceName);
  return info;
}

std::string cuda_needs() {
  return "libvoyager_cuda.so beside libvoyager.so, an NVIDIA GPU of compute capability " +
         std::to_string(kLeastComputeCapability) + ".0 or newer, and its driver";
}

VoyDeviceInfo cuda_info(const BackendDevice& device) {
  VoyDeviceInfo info = device_info(VOY_BACKEND_CUDA, cuda_needs());
  info.usable = device.missing.empty() ? 1 : 0;
  std::copy(device.uuid.begin(), device.uuid.end(), info.deviceUuid);
  info.memoryBytes = device.memory_bytes;
  std::copy_n(device.capability, 2, info.computeCapability);
  info.cudaVersion = device.cuda_version;
  put_text(device.driver, info.driver);
  put_text(device.name, info.deviceName);
  put_text(device.missing, info.why);
  return info;
}

// Of CUDA: its devices, or why there are none.
void add_cuda(std::vector<VoyDeviceInfo>& all) {
  try {
    for (const BackendDevice& device : list_backend("cuda")) all.push_back(cuda_info(device));
  } catch (const Error& error) {
    VoyDeviceInfo info = device_info(VOY_BACKEND_CUDA, cuda_needs());
    put_text(error.what(), info.why);
    all.push_back(info);
  }
}

}  // namespace

VoyResult VOY_CALL voyEnumerateDevices(uint32_t capacity, VoyDeviceInfo* devices, uint32_t* count) {
  return guarded("voyEnumerateDevices", [&](Call&) {
    check_pointer(count, "count");
    if (capacity > 0) check_pointer(devices, "devices");
    std::vector<VoyDeviceInfo> found;
    add_cuda(found);
    found.push_back(host_info(VOY_BACKEND_CPU, *create_cpu_backend()));
    found.push_back(host_info(VOY_BACKEND_REFERENCE, *create_reference_backend()));
    const size_t written = std::min<size_t>(capacity, found.size());
    std::copy_n(found.begin(), written, devices);
    *count = static_cast<uint32_t>(found.size());
    return written < found.size() && capacity > 0 ? VOY_INCOMPLETE : VOY_SUCCESS;
  });
}
