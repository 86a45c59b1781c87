// What passes a surface in a straight line: all that shadow rays need of materials.
#ifndef TACHYLITE_BSDF_NULL_TRANSMISSION_GLSL
#define TACHYLITE_BSDF_NULL_TRANSMISSION_GLSL
#include "bsdf/input.glsl"
#include "bsdf/thin_dielectric.glsl"

// Weights of leaves sum to 1 but for rounding where nothing is null.
const float kNegligibleWeight = 2.5e-7;
float null_weight_of(float sum) { return 1.0 - sum < kNegligibleWeight ? 0.0 : 1.0 - sum; }

// Share of the light that goes straight through a surface, for shadow rays: the null part and thin dielectrics.
vec3 null_transmission_bsdf(uint material, TexturePoint point, vec3 n_s, vec3 wo) {
  uvec4 head = load_material_row(material);
  bool front = dot(n_s, wo) > 0.0;
  uint row = front ? head.z : head.w;
  uint count = (front ? head.x : head.x >> 8u) & 0xffu;
  bool passes = (head.y & kMaterialNull) != 0u;
  float sum = 0.0;
  vec3 panes = vec3(0.0);
  for (uint i = 0u; i < (passes ? count : 0u); ++i) {
    uvec4 header = load_material_row(row);
    float weight = load_leaf_weight(row, header, point);
    // Of the leaves of two sides inside a map, those in front weigh as much as those behind.
    if (has_material(kMaterialMapSides) &&
        (header.x & ((kSideBackInner | kSideBackInnermost) << kSideShift)) != 0u) weight = 0.0;
    sum += weight;
    if (has_bsdf(kBsdfThinDielectric) && (header.x & 0xffu) == kBsdfThinDielectric)
      panes += weight * null_transmission_thin_dielectric(load_thin_dielectric(row, point), dot(n_s, wo));
    row += header.w;
  }
  return passes ? vec3(null_weight_of(sum)) + panes : vec3(0.0);
}

#endif
