#pragma once
// Files whole, and images to files: each appears under its name only when complete.
#include <cstdint>
#include <span>
#include <string>

namespace host {

// All of it. Throws Failure(kRefusedInput) with the path, also for what is no file: nothing waits
// for the other end of a pipe.
std::string read_file(const std::string& path);

// Before the work: throws Failure(kMachine) where write_file() would fail.
void require_writable(const std::string& path);
// Where `path` is a symbolic link, to what it leads to. Throws Failure(kMachine).
void write_file(const std::string& path, std::span<const std::byte> bytes);
// RGB from rows of RGBA.
void write_png(const std::string& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgba);
// `Pf`: little-endian, bottom row first.
void write_pfm(const std::string& path, uint32_t width, uint32_t height,
               std::span<const float> values);

}  // namespace host
