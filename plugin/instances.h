#pragma once
#include <memory>

#include "plugin/call.h"
#include "plugin/field_name.h"

namespace voyager {

// What a view may draw. Throws ApiError naming the field, what was found and what was expected.
void check_instance_count(uint32_t count, const FieldName& field);
std::shared_ptr<SceneObject> instance_scene(Call& call, VoyScene scene, const DeviceObject& device,
                                            const FieldName& field);

}  // namespace voyager
