#pragma once
// Mutations of JSON, and of the files that hold some.
#include <nlohmann/json.hpp>

#include "tests/fuzz/mutator.h"

namespace voyager::fuzz {

// Changes one to three values.
void mutate_json(nlohmann::json& json, Random& random);

// Of a .glb or a file of JSON: values of its JSON, whose length is right again, or bytes of its
// buffer. False where there is no JSON; the bytes are then as they were.
bool mutate_gltf(Bytes& bytes, Random& random);

}  // namespace voyager::fuzz
