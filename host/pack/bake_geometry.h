#pragma once

#include <map>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "pack/pack_scene.h"

namespace tachylite {

/// A tiny scene's geometry as specialization constants (shared/baked.h).
struct BakedGeometry {
  std::map<uint32_t, uint32_t> constants;  // by constant id; floats by their bits
  std::vector<glm::vec4> rows;             // kBakedRows a primitive
  uint32_t count = 0;
};

/// Which variant of the kernel that follows whole paths (shaders/CMakeLists.txt) has the bsdfs of the class: "diffuse",
/// "smooth" or "rough"; nullptr: none.
const char* fused_bsdf_variant(const MaterialClass& c);

/// Empty where the scene does not fit: more than kMaxBaked primitives, disks or cylinders, bsdfs beyond those of
/// fused_bsdf_variant, anything that needs uv, tangents or vertex normals, media, hidden emitters, or paths so long that
/// they could exceed the iterations that Mesa 22.3.6 allows one invocation.
std::optional<BakedGeometry> bake_geometry(const PackedScene& scene);

}  // namespace tachylite
