#pragma once
#include <memory>
#include <string>

#include "plugin/call.h"

namespace voyager {

// What a view may draw. Throws ApiError naming the field, what was found and what was expected.
void check_instance_count(uint32_t count, const char* field);
std::shared_ptr<SceneObject> instance_scene(Call& call, VoyScene scene, const DeviceObject& device,
                                            const std::string& field);

}  // namespace voyager
