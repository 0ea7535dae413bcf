#include "tools/report/energy_meter.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

namespace voyager::tools {
namespace {

// NVML is loaded where there is one: a driver brings it.
class Nvml final : public EnergyMeter {
 public:
  explicit Nvml(const std::string& uuid)
      : library_(dlopen("libnvidia-ml.so.1", RTLD_NOW | RTLD_LOCAL)) {
    if (library_ == nullptr) return;
    const auto init = find<int (*)()>("nvmlInit_v2");
    const auto device = find<int (*)(const char*, void**)>("nvmlDeviceGetHandleByUUID");
    energy_ = find<int (*)(void*, unsigned long long*)>("nvmlDeviceGetTotalEnergyConsumption");
    if (init == nullptr || device == nullptr || init() != 0 || device(uuid.c_str(), &device_) != 0)
      energy_ = nullptr;
  }
  ~Nvml() override {
    if (library_ == nullptr) return;
    if (const auto shutdown = find<int (*)()>("nvmlShutdown")) shutdown();
    dlclose(library_);
  }
  std::optional<double> joules() override {
    unsigned long long millijoules = 0;
    if (energy_ == nullptr || energy_(device_, &millijoules) != 0) return std::nullopt;
    return static_cast<double>(millijoules) / 1000;
  }
  const std::string& name() const override { return name_; }

 private:
  template <class Function>
  Function find(const char* symbol) {
    return reinterpret_cast<Function>(dlsym(library_, symbol));
  }

  const std::string name_ = "NVML, of the whole GPU";
  void* library_;
  void* device_ = nullptr;
  int (*energy_)(void*, unsigned long long*) = nullptr;
};

std::string first_line(const std::filesystem::path& path) {
  std::string line;
  std::ifstream file(path);
  std::getline(file, line);
  return line;
}

// An INA3221's channel N: inN_label, inN_input in millivolts, currN_input in milliamperes.
class Rail final : public EnergyMeter {
 public:
  Rail(std::string name, std::filesystem::path volts, std::filesystem::path amperes)
      : name_(std::move(name)),
        volts_(std::move(volts)),
        amperes_(std::move(amperes)),
        thread_([this] { sum(); }) {}
  ~Rail() override {
    ended_ = true;
    thread_.join();
  }
  std::optional<double> joules() override { return joules_.load(); }
  const std::string& name() const override { return name_; }

 private:
  void sum() {
    using Clock = std::chrono::steady_clock;
    for (auto before = Clock::now(); !ended_;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      const auto now = Clock::now();
      const double watts =
          std::atof(first_line(volts_).c_str()) * std::atof(first_line(amperes_).c_str()) / 1e6;
      joules_ = joules_ + watts * std::chrono::duration<double>(now - before).count();
      before = now;
    }
  }

  const std::string name_;
  const std::filesystem::path volts_, amperes_;
  std::atomic<double> joules_{0};
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace

std::string nvml_uuid(const std::array<uint8_t, 16>& uuid) {
  std::string text = "GPU";
  for (size_t i = 0; i < uuid.size(); ++i)
    text += fmt::format("{}{:02x}", i == 0 || i == 4 || i == 6 || i == 8 || i == 10 ? "-" : "",
                        uuid[i]);
  return text;
}

std::unique_ptr<EnergyMeter> find_gpu_rail(const std::filesystem::path& sensors) {
  std::error_code none;
  for (const auto& sensor : std::filesystem::directory_iterator(sensors, none))
    for (const char* channel : {"1", "2", "3"}) {
      const auto file = [&](const std::string& name) { return sensor.path() / name; };
      const std::string label = first_line(file(std::string("in") + channel + "_label"));
      if (label.find("GPU") != std::string::npos)
        return std::make_unique<Rail>(label, file(std::string("in") + channel + "_input"),
                                      file(std::string("curr") + channel + "_input"));
    }
  return nullptr;
}

std::unique_ptr<EnergyMeter> find_energy_meter(const std::array<uint8_t, 16>& device_uuid) {
  if (device_uuid == std::array<uint8_t, 16>{}) return nullptr;
  auto nvml = std::make_unique<Nvml>(nvml_uuid(device_uuid));
  if (nvml->joules()) return nvml;
  return find_gpu_rail("/sys/class/hwmon");
}

}  // namespace voyager::tools
