#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "base/bulk_vector.h"
#include "scene/scene.h"

namespace tachylite {

/// The media of a scene as rows of shared/medium.h.
struct PackedMedia {
  std::vector<glm::vec4> rows;
  PageVector<float> grids;
  std::vector<uint32_t> index_of_medium;  // for each of Scene::media; kNoMedium: not used, or nothing there
  uint32_t kinds = 0;                     // set of kMedia... but for kMediaPaths

  uint32_t index(MediumIndex medium) const;  // of kNone: kNoMedium
};

/// Only media that a shape or the sensor names; one that neither absorbs nor scatters is left out. centre: of device
/// space. Throws InputError for grids and phase functions that are too large for the records.
PackedMedia pack_media(const Scene& scene, const Sensor& sensor, const glm::dvec3& centre);

}  // namespace tachylite
