#pragma once
// The .spz files that lie in buffer views of a glTF.
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "runtime/scene/import/gltf/file.h"
#include "runtime/scene/import/left_out.h"
#include "runtime/scene/import/spz_blocks.h"

namespace voyager::gltf {

struct Spz {
  std::shared_ptr<const ByteSource> source;  // a whole file
  spz::Header header;
  bool says_axes = false;             // in an extension of its own
  std::optional<spz::Bounds> bounds;  // where somebody asked
};

// Each is opened once, however many primitives and views name it.
class SpzViews {
 public:
  // `view`: a JSON number; `place`: of the primitive. Valid as long as this. Throws
  // Error(refused_input) as the reader of a .spz does, and for views of different lengths that
  // begin at the same byte: it would be opened for each of them.
  Spz& open(File& file, const JsonValue& view, const std::string& place);

  const LeftOut& left_out() const { return left_out_; }

 private:
  std::map<std::pair<const ByteSource*, uint64_t>, Spz> known_;  // by where they begin
  LeftOut left_out_;
};

// How the numbers of `spz` become INRIA's; nothing where it says its axes itself. Files have them
// in glTF's axes, as CesiumJS reads them, in those of a .spz or in those of a .ply: `position`, the
// accessor of POSITION or null, has bounds that tell which. Where they fit none, or more than one
// as well, glTF's.
std::optional<HalfTurn> axes_of(Spz& spz, const JsonValue* position);

}  // namespace voyager::gltf
