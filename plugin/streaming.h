#pragma once
#include "plugin/objects.h"

namespace voyager {

// Refuses what is out of range.
void check_streaming(const VoySceneStreaming& streaming);

// Fills the object's scene. Throws as runtime/frame/open_streamed.h.
void open_streamed(SceneObject& object, const std::shared_ptr<const ByteSource>& source,
                   const VoySceneStreaming& streaming);

// What went wrong since the last call, to the device's log.
void log_streaming(const DeviceObject& device, const Scene& scene);

}  // namespace voyager
