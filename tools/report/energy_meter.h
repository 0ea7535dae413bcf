#pragma once
// What a machine says of the energy that it takes.
#include <memory>
#include <optional>
#include <string>

namespace voyager::tools {

class EnergyMeter {
 public:
  virtual ~EnergyMeter() = default;
  // Since some point in the past; none where the sensor does not answer.
  virtual std::optional<double> joules() = 0;
  // Of what: "NVML, device 0", "VDD_GPU_SOC".
  virtual const std::string& name() const = 0;
};

// The first that answers of: the GPU by NVML, where `on_gpu`; a Jetson's rail of the GPU, whose
// power is summed over time by a thread of the meter's own; none.
std::unique_ptr<EnergyMeter> find_energy_meter(bool on_gpu);

}  // namespace voyager::tools
