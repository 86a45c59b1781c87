// One leaf of a material: the switch over all types of bsdf. Adding a type adds a line to each function here.
#ifndef TACHYLITE_BSDF_LEAF_GLSL
#define TACHYLITE_BSDF_LEAF_GLSL
#include "bsdf/diffuse.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"
#include "geometry/interaction.glsl"

// Members of types that the class does not have are never written or read, and vanish.
struct Leaf {
  uint type;     // kBsdf...
  vec3 s, t, n;  // world-space axes of the leaf's frame; mirrors are folded in, so it may be left-handed
  vec3 wo;       // in that frame
  DiffuseBsdf diffuse;
};

// In a class with one type of leaf the type is not looked at.
bool is_leaf(Leaf leaf, uint type) {
  uint others = bsdf_types & ~(1u << kBsdfNull);
  return others == (1u << type) || (has_bsdf(type) && leaf.type == type);
}

bool has_leaf_headers() {
  uint others = bsdf_types & ~(1u << kBsdfNull);
  return (others & (others - 1u)) != 0u || has_material(kMaterialHasWeights | kMaterialHasFrames | kMaterialSides);
}

vec3 to_leaf(Leaf leaf, vec3 w) { return vec3(dot(leaf.s, w), dot(leaf.t, w), dot(leaf.n, w)); }
vec3 from_leaf(Leaf leaf, vec3 w) { return w.x * leaf.s + w.y * leaf.t + w.z * leaf.n; }

// The leaf that begins at row `row` and whose first row is `header` (undefined where has_leaf_headers() is false).
Leaf load_leaf(uint row, uvec4 header, Interaction it, vec3 wo) {
  Leaf leaf;
  leaf.type = header.x & 0xffu;
  leaf.s = it.s;
  leaf.t = it.t;
  leaf.n = it.n_s;
  bool mirror = has_material(kMaterialTwoSided) ||
                (has_material(kMaterialSides) && (header.x & (kMirrorOuter << 8u)) != 0u);
  if (mirror && dot(it.n_s, wo) < 0.0) leaf.n = -it.n_s;
  leaf.wo = to_leaf(leaf, wo);
  if (is_leaf(leaf, kBsdfDiffuse)) leaf.diffuse = load_diffuse(row, it.point);
  return leaf;
}

BsdfEval eval_leaf(Leaf leaf, vec3 wi_world) {
  vec3 wi = to_leaf(leaf, wi_world);
  BsdfEval eval = kNoEval;
  if (is_leaf(leaf, kBsdfDiffuse)) eval = eval_diffuse(leaf.diffuse, leaf.wo, wi);
  return eval;
}

BsdfSample sample_leaf(Leaf leaf, vec2 u, float u_lobe) {
  BsdfSample s = absorbed();
  if (is_leaf(leaf, kBsdfDiffuse)) s = sample_diffuse(leaf.diffuse, leaf.wo, u);
  s.wi = from_leaf(leaf, s.wi);
  return s;
}

#endif
