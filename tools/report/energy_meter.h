#pragma once
// What a machine says of the energy that it takes.
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace voyager::tools {

class EnergyMeter {
 public:
  virtual ~EnergyMeter() = default;
  // Since some point in the past; none where the sensor does not answer.
  virtual std::optional<double> joules() = 0;
  // "NVML, of the whole GPU", "VDD_GPU_SOC".
  virtual const std::string& name() const = 0;
};

// As NVML names a GPU: "GPU-" and 8-4-4-4-12 digits.
std::string nvml_uuid(const std::array<uint8_t, 16>& uuid);

// A Jetson's rail of the GPU, whose power is summed over time by a thread of the meter's own. Null
// where no sensor of the folder has one.
std::unique_ptr<EnergyMeter> find_gpu_rail(const std::filesystem::path& sensors);

// The first that answers of: the GPU with this UUID (Backend::device_uuid) by NVML; the machine's
// GPU rail. Null where none does, and of a UUID of zeros, which a CPU has.
std::unique_ptr<EnergyMeter> find_energy_meter(const std::array<uint8_t, 16>& device_uuid);

}  // namespace voyager::tools
