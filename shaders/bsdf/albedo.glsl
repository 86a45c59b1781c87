// The albedo of a material, for denoisers: a colour in [0, 1] without noise of its own. Diffuse reflectance or base
// colour; of metals the reflectance at normal incidence, of glass 1 (as the documentation of Intel Open Image Denoise
// advises); weighted over the leaves on the viewer's side. Needs no code of the bsdfs: the colour is input 0 of all other leaves.
#ifndef TACHYLITE_BSDF_ALBEDO_GLSL
#define TACHYLITE_BSDF_ALBEDO_GLSL
#include "bsdf/fresnel.glsl"
#include "bsdf/input.glsl"
#include "geometry/interaction.glsl"

bool is_type(uint type, uint wanted) { return has_bsdf(wanted) && type == wanted; }

// leaf: first row.
vec3 albedo_of_leaf(uint leaf, uint type, TexturePoint point) {
  vec3 color = load_color(leaf, 0u, point);
  if (is_type(type, kBsdfConductor) || is_type(type, kBsdfRoughConductor))
    color = load_color(leaf, 2u, point) * fresnel_conductor(1.0, color, load_color(leaf, 1u, point));
  if (is_type(type, kBsdfDielectric) || is_type(type, kBsdfThinDielectric) || is_type(type, kBsdfRoughDielectric))
    color = vec3(1.0);
  if (is_type(type, kBsdfBlinnPhong) && load_constants(leaf, 3u).x != 0.0)
    color *= 1.0 - clamp(load_scalar_pair(leaf, 2u, point).y, 0.0, 1.0);
  return color;
}

// Whether the leaf is for viewers on that side of the surface: here maps do not count.
bool is_leaf_on_side(uint header, bool front) {
  uint mirrors = header >> 8u, sides = header >> kSideShift;
  bool inner = front || (mirrors & kMirrorOuter) != 0u, innermost = inner || (mirrors & kMirrorInner) != 0u;
  uint others = (inner ? kSideBackInner : kSideFrontInner) | (innermost ? kSideBackInnermost : kSideFrontInnermost);
  return (sides & others) == 0u;
}

vec3 material_albedo(Interaction it, vec3 wo) {
  vec3 sum = vec3(0.0);
  uvec4 material = load_material_row(it.material);
  bool front = dot(it.n_s, wo) > 0.0;
  uint leaf = front ? material.z : material.w, count = (front ? material.x : material.x >> 8u) & 0xffu;
  for (uint i = 0u; i < max_leaves; ++i) {
    if (i < count) {
      uvec4 header = load_material_row(leaf);
      vec3 part = load_leaf_weight(leaf, header, it.point) * albedo_of_leaf(leaf, header.x & 0xffu, it.point);
      if (!has_material(kMaterialMapSides) || is_leaf_on_side(header.x, front)) sum += part;
      leaf += header.w;
    }
  }
  return clamp(sum, 0.0, 1.0);
}

#endif
