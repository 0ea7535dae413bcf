#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "tools/backend_name.h"
#include "tools/byte_size.h"
#include "tools/commands/commands.h"
#include "tools/options.h"
#include "tools/progress_bar.h"
#include "voyager/voyager.hpp"

namespace voyager::tools {
namespace {

using Json = nlohmann::ordered_json;

// What the driver lists may still not start: its memory may be full, or another process may have
// it for itself. Only making a device on it tells.
void try_device(VoyDeviceInfo& info) {
  if (info.usable == 0) return;
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.backend = info.backend;
  desc.deviceUuid = info.deviceUuid;
  VoyDevice device = nullptr;
  if (voyCreateDevice(&desc, &device) != VOY_SUCCESS) {
    info.usable = 0;
    std::string(voyGetLastErrorMessage()).copy(info.why, sizeof info.why - 1);
  }
  voyDestroyDevice(device);
}

// As nvidia-smi writes it, without its "GPU-".
std::string uuid_text(const uint8_t* uuid) {
  std::string text;
  for (int i = 0; i < 16; ++i)
    text += fmt::format("{}{:02x}", i == 4 || i == 6 || i == 8 || i == 10 ? "-" : "", uuid[i]);
  return text;
}

std::string capability_text(const VoyDeviceInfo& info) {
  return fmt::format("{}.{}", info.computeCapability[0], info.computeCapability[1]);
}

std::string cuda_text(const VoyDeviceInfo& info) {
  return fmt::format("{}.{}", info.cudaVersion / 1000, info.cudaVersion % 1000 / 10);
}

// What AUTO takes, which is not always the first that can be used.
VoyBackend automatic() {
  const VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  return voy::Device::create(desc).capabilities().backend;
}

void print_row(const char* name, const std::string& value) {
  fmt::print("  {:<20}{}\n", name, value);
}

void print_device(const VoyDeviceInfo& info) {
  fmt::print("{}: {}\n", backend_name(info.backend),
             info.deviceName[0] != '\0' ? info.deviceName : "no device");
  print_row("usable", info.usable != 0 ? "yes" : "no");
  if (info.why[0] != '\0') print_row("missing", info.why);
  print_row("needs", info.needs);
  if (info.deviceName[0] == '\0') return;
  if (info.backend == VOY_BACKEND_CUDA) {
    print_row("UUID", uuid_text(info.deviceUuid));
    print_row("compute capability", capability_text(info));
    print_row("driver", fmt::format("{}{}for CUDA {}", info.driver,
                                    info.driver[0] != '\0' ? ", " : "", cuda_text(info)));
  } else {
    print_row("threads", std::to_string(info.workerThreadCount));
  }
  print_row("memory", size_text(info.memoryBytes));
}

Json to_json(const VoyDeviceInfo& info) {
  const auto text = [](const std::string& value) { return value.empty() ? Json() : Json(value); };
  const bool cuda = info.backend == VOY_BACKEND_CUDA && info.deviceName[0] != '\0';
  return {{"backend", backend_name(info.backend)},
          {"name", text(info.deviceName)},
          {"usable", info.usable != 0},
          {"needs", info.needs},
          {"missing", text(info.why)},
          {"uuid", cuda ? Json(uuid_text(info.deviceUuid)) : Json()},
          {"compute_capability", cuda ? Json(capability_text(info)) : Json()},
          {"driver", text(info.driver)},
          {"driver_cuda", info.cudaVersion != 0 ? Json(cuda_text(info)) : Json()},
          {"threads", info.workerThreadCount != 0 ? Json(info.workerThreadCount) : Json()},
          {"memory_bytes", info.memoryBytes != 0 ? Json(info.memoryBytes) : Json()}};
}

void print_devices_json(const std::vector<VoyDeviceInfo>& devices) {
  Json json = {{"auto", backend_name(automatic())}, {"devices", nlohmann::json::array()}};
  for (const VoyDeviceInfo& info : devices) json["devices"].push_back(to_json(info));
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_devices_text(const std::vector<VoyDeviceInfo>& devices) {
  for (const VoyDeviceInfo& info : devices) print_device(info);
  fmt::print("--backend auto is {} here\n", backend_name(automatic()));
}

}  // namespace

void add_devices(CLI::App& app) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("devices", "List what can draw on this machine, and what is missing");
  command->add_flag("--json", *json, "Print JSON, for programs; sizes are in bytes");
  name_group(*command, kCommonOptions);
  command->footer("Example: voyager devices");
  command->callback([json] {
    std::vector<VoyDeviceInfo> devices = voy::devices();
    const Progress progress = progress_bar();
    for (size_t i = 0; i < devices.size(); ++i) {
      progress("trying devices", i, devices.size());
      try_device(devices[i]);
    }
    progress("trying devices", devices.size(), devices.size());
    (*json ? print_devices_json : print_devices_text)(devices);
  });
}

}  // namespace voyager::tools
