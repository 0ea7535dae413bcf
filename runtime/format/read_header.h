#pragma once
#include <span>

#include "runtime/format/layout.h"
#include "runtime/format/refusal.h"

namespace voyager {

bool has_scene_magic(std::span<const std::byte> first_bytes);

// The header with its fields in range; its sections are not looked at. Throws
// Error(refused_input).
FileHeader read_header(const ByteSource& source, const Check& check);

}  // namespace voyager
