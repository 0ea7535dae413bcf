#pragma once
// What a frame has shown of a scene's chunks: what tells which requests may come last.
#include <cstdint>
#include <vector>

namespace voyager {

// Of what a frame drew of a chunk: nothing is known where it drew none of its nodes; hidden, where
// light reached none of them; shown, where it reached one. Of several frames the greatest counts.
enum class Shown : uint8_t { unknown, no, yes };

// By slot. Slots behind its end are unknown.
using ShownChunks = std::vector<Shown>;

}  // namespace voyager
