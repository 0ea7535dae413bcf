#include "plugin/backend_choice.h"

#include <algorithm>

#include "runtime/base/error.h"
#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/backend_module.h"
#include "runtime/reference/reference_backend.h"

namespace voyager {
namespace {

bool is_of_a_cpu(const uint8_t* uuid) {
  return std::all_of(uuid, uuid + 16, [](uint8_t byte) { return byte == 0; });
}

void check_uuid_of_a_cpu(const uint8_t* uuid) {
  if (uuid != nullptr && !is_of_a_cpu(uuid))
    throw Error(ErrorCode::no_device,
                "desc.deviceUuid: found a UUID that no device of this backend has, "
                "expected NULL or the sixteen zeros of a CPU");
}

BackendChoice load_cuda(const uint8_t* uuid) {
  BackendModuleOptions options;
  options.uuid = uuid;
  return {VOY_BACKEND_CUDA, load_backend("cuda", options)};
}

// AUTO never fails because of a device: the CPU is its fallback.
BackendChoice choose_fastest(const uint8_t* uuid) {
  if (uuid != nullptr && is_of_a_cpu(uuid)) return {VOY_BACKEND_CPU, create_cpu_backend()};
  try {
    return load_cuda(uuid);
  } catch (const Error& error) {
    return {VOY_BACKEND_CPU, create_cpu_backend(), error.what()};
  }
}

}  // namespace

BackendChoice choose_backend(VoyBackend wanted, const uint8_t* uuid) {
  if (wanted == VOY_BACKEND_AUTO) return choose_fastest(uuid);
  if (wanted == VOY_BACKEND_CUDA) return load_cuda(uuid);
  check_uuid_of_a_cpu(uuid);
  if (wanted == VOY_BACKEND_REFERENCE) return {wanted, create_reference_backend()};
  return {VOY_BACKEND_CPU, create_cpu_backend()};
}

}  // namespace voyager
