#pragma once
// Runs a built program and keeps what it said.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace voyager::test {

struct Outcome {
  int exit_code;
  std::string output;  // both streams
};

// A built program with its arguments, as a shell takes it.
inline std::string program(const std::string& command_line) {
  // AddressSanitizer's dlopen does not look where the program's RUNPATH says.
  return "env LD_LIBRARY_PATH=" VOYAGER_BIN_DIR "/../lib " VOYAGER_BIN_DIR "/" + command_line;
}

inline Outcome run_shell(const std::string& shell_command) {
  const std::string command = "( " + shell_command + " ) 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  Outcome result{-1, ""};
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer;
  for (size_t got = 0; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    result.output.append(buffer.data(), got);
  const int status = ::pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

inline Outcome run(const std::string& command_line) {
  return run_shell(program(command_line));
}

// Runs them until one fails: that one and what it said, "" where none does. For what a suite sets
// up: to be asserted in SetUp, for tests of a suite that fails to set up count as skipped.
inline std::string failure_of(const std::vector<std::string>& steps) {
  for (const std::string& step : steps) {
    const Outcome result = run(step);
    if (result.exit_code != 0) return step + "\n" + result.output;
  }
  return "";
}

inline std::string file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace voyager::test
