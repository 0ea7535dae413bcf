#pragma once
#include <unistd.h>

#include <filesystem>
#include <string>

// A copy of the library, in a folder with the module that it takes for CUDA's.
struct StuckFolder {
  StuckFolder() {
    std::filesystem::create_directories(path);
    std::filesystem::copy_file(VOYAGER_LIBRARY, library,
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::create_symlink(VOYAGER_STUCK_MODULE, module);
  }
  ~StuckFolder() { std::filesystem::remove_all(path); }
  StuckFolder(const StuckFolder&) = delete;
  StuckFolder& operator=(const StuckFolder&) = delete;

  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("voyager_stuck." + std::to_string(::getpid()));
  const std::filesystem::path library = path / "libvoyager.so",
                              module = path / "libvoyager_cuda.so";
};
