#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "pack/pack_scene.h"

namespace tachylite {

/// A tiny scene's geometry as specialization constants (shared/baked.h).
struct BakedGeometry {
  std::map<uint32_t, uint32_t> constants;  // by constant id; floats by their bits
  std::vector<glm::vec4> rows;             // kBakedRows a primitive
  uint32_t count = 0;
  std::string kernel;                      // the variant that holds them: "follow_paths_..." of shaders/CMakeLists.txt
};

/// Boxes of four to six parallelograms that do not emit are one primitive each (pack/find_boxes.h).
/// Empty where the scene does not fit: more than kMaxBaked primitives (32 beside rough bsdfs), disks or cylinders, more
/// than two rough types of bsdf or others than smooth ones, plastics and rough conductors and dielectrics, anything that
/// needs uv, tangents or vertex normals, media, hidden emitters, or paths so long that they could exceed the iterations
/// that Mesa 22.3.6 allows one invocation.
std::optional<BakedGeometry> bake_geometry(const PackedScene& scene);

/// The walls that the scene's tree leaves out, for the trace kernels; kWallRows rows a face.
BakedGeometry bake_walls(const PackedScene& scene);

/// The packed scene where bake_geometry finds that it fits, else empty; scenes of more primitives are not packed for it.
std::optional<PackedScene> pack_if_baked(const Scene& scene, int sensor);

}  // namespace tachylite
