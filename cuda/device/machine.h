#pragma once
// What the module needs of a machine, and what it finds there.
#include <string>
#include <vector>

#include "runtime/frame/backend_module.h"

struct cudaDeviceProp;

namespace voyager::cuda {

// Throws Error(no_device) where there is no NVIDIA driver, an older one than this module needs, or
// no device; the message says what to do.
void require_driver_and_device();

// Why the module cannot draw on such a device, and what to do; "" where it can.
std::string missing_from(const cudaDeviceProp& properties);

// In the driver's order; starts no work on any. Throws as require_driver_and_device() does.
std::vector<BackendDevice> list_devices();

}  // namespace voyager::cuda
