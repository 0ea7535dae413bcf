#pragma once
// .spz codes to INRIA words, block by block; the inverse of
// runtime/scene/export/spz_quantise.h.
#include "runtime/scene/gaussian_cloud.h"
#include "runtime/scene/import/spz_header.h"

namespace voyager::spz {

// Decodes `codes`, the bytes of Gaussians [first, first + n) of one attribute,
// into the cloud, whose arrays for it already hold first + n Gaussians.
void decode(const Header& header, Attribute attribute, std::span<const std::byte> codes,
            size_t first, GaussianCloud& cloud);

}  // namespace voyager::spz
