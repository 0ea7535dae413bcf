#pragma once
// One gzip member as plain bytes, in steps: with ISA-L where the build has it, which takes a third
// of zlib's time, else with zlib.
#include <cstddef>
#include <memory>
#include <span>

namespace voyager {

class Inflate {
 public:
  Inflate();
  // Goes on where `other` stands.
  Inflate(const Inflate& other);
  ~Inflate();
  Inflate& operator=(const Inflate&) = delete;

  struct Step {
    size_t taken, made;   // bytes of `in` and of `out`
    bool ended;           // the member is whole, and fits its checksum and its length
    const char* problem;  // null where there is none
  };
  // Neither taken nor made: it needs more input. At the end no byte after the member is taken.
  Step step(std::span<const std::byte> in, std::span<std::byte> out);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace voyager
