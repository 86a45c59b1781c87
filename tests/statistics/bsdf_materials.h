#pragma once

// Every material of shaders/bsdf, as a row of the tests in this folder. A new material adds a row.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace tachylite::test {

struct MaterialCase {
  std::string name;
  BsdfKind kind;
  double alpha = 1;         // width of the narrowest lobe that is no delta
  double eta = 1;           // inside over outside, where light passes
  bool two_sided = false;   // seen from behind, too
  bool conserves = true;    // no albedo above 1
  bool reciprocal = true;
};

/// One of each type and variant, at middling parameters.
std::vector<MaterialCase> all_materials();

/// Rough coats and interfaces on or beside other lobes, narrow and wide.
std::vector<MaterialCase> coated_materials();

/// The rough ones over distribution, roughness and eta.
std::vector<MaterialCase> rough_materials();

/// Adds to the scene, and returns the index there.
BsdfIndex add_bsdf(Scene& scene, const BsdfKind& kind);
TextureIndex add_constant_texture(Scene& scene, const dvec3& value);

}  // namespace tachylite::test
