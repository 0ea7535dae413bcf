// What libvoyager_sog.so exports.
#include "runtime/base/module.h"
#include "runtime/scene/export/sog/writer.h"
#include "runtime/scene/import/sog/lod_scene.h"
#include "runtime/scene/import/sog/scene.h"
#include "runtime/scene/sog_module.h"

namespace voyager::sog {
namespace {

const char* stamp() {
  static const std::string text = module_stamp(sizeof(SogModule));
  return text.c_str();
}

}  // namespace
}  // namespace voyager::sog

extern "C" __attribute__((visibility("default"))) const voyager::SogModule voyager_sog_module = {
    voyager::sog::stamp(), voyager::sog::open, voyager::sog::open_streamed,
    voyager::sog_export::write};
