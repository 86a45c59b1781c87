// The bsdf of a material: its leaves (leaf.glsl), weighted, and its null part.
//
// Directions point away from the surface: wo to the viewer, wi to the light (Mitsuba and Cycles swap the names).
// Here they are in world space; in the files of the leaves they are in the leaf's frame, z = shading normal, which
// points to the outside. f is not symmetric in transmission: radiance is scaled by 1/eta^2 (Walter et al. 2007,
// "Microfacet Models for Refraction through Rough Surfaces", section 4.2), as paths come from the camera.
//
// Everything that the material class lacks is compiled out: base/features.glsl, bsdf_types and material_flags.
#ifndef TACHYLITE_BSDF_BSDF_GLSL
#define TACHYLITE_BSDF_BSDF_GLSL
#include "bsdf/leaf.glsl"

struct SurfaceBsdf {
  Leaf leaf;          // where the class has a single leaf: loaded once
  float weight;       // of that leaf
  float null_weight;
  // Where the class has more leaves: what it takes to load them.
  float weights[kMaterialMaxLeaves];
  uint first, count;
  vec3 wo;
  Interaction it;
};

const float kLargestUniform = 0.99999994;  // below 1

// Weights of leaves sum to 1 but for rounding where nothing is null.
const float kNegligibleWeight = 2.5e-7;
float null_weight_of(float sum) { return 1.0 - sum < kNegligibleWeight ? 0.0 : 1.0 - sum; }

// Whether sample_bsdf ignores u_lobe.
bool only_single_lobes() {
  const uint single_lobe = (1u << kBsdfNull) | (1u << kBsdfDiffuse);
  return (bsdf_types & ~single_lobe) == 0u && !has_material(kMaterialHasWeights);
}

SurfaceBsdf load_bsdf(Interaction it, vec3 wo) {
  SurfaceBsdf b;
  b.wo = wo;
  b.weight = 1.0;
  b.null_weight = max_leaves == 0u ? 1.0 : 0.0;
  if (max_leaves == 0u) return b;
  b.first = it.material + 1u;
  b.count = 1u;
  if (max_leaves > 1u || has_material(kMaterialSides)) {
    uvec4 material = load_material_row(it.material);
    bool front = dot(it.n_s, wo) > 0.0;
    b.first = front ? material.z : material.w;
    b.count = (front ? material.x : material.x >> 8u) & 0xffu;
  }
  if (max_leaves == 1u) {
    uvec4 header = has_leaf_headers() ? load_material_row(b.first) : uvec4(0u);
    b.leaf = load_leaf(b.first, header, it, wo);
    if (has_material(kMaterialHasWeights)) b.weight = b.count > 0u ? load_leaf_weight(b.first, header, it.point) : 0.0;
    if (has_material(kMaterialNull)) b.null_weight = null_weight_of(b.weight);
    return b;
  }
  b.it = it;
  uint row = b.first;
  float sum = 0.0;
  for (uint i = 0u; i < max_leaves; ++i) {  // as many turns for all lanes
    uvec4 header = load_material_row(row);
    b.weights[i] = i < b.count ? load_leaf_weight(row, header, it.point) : 0.0;
    sum += b.weights[i];
    row += i + 1u < b.count ? header.w : 0u;
  }
  if (has_material(kMaterialNull)) b.null_weight = null_weight_of(sum);
  return b;
}

BsdfEval eval_bsdf(SurfaceBsdf b, vec3 wi) {
  if (max_leaves == 0u) return kNoEval;
  if (max_leaves == 1u) {
    BsdfEval eval = eval_leaf(b.leaf, wi);
    return BsdfEval(b.weight * eval.f, b.weight * eval.pdf);
  }
  BsdfEval sum = kNoEval;
  uint row = b.first;
  for (uint i = 0u; i < max_leaves; ++i) {
    uvec4 header = load_material_row(row);
    BsdfEval eval = eval_leaf(load_leaf(row, header, b.it, b.wo), wi);
    sum.f += b.weights[i] * eval.f;
    sum.pdf += b.weights[i] * eval.pdf;
    row += i + 1u < b.count ? header.w : 0u;
  }
  return sum;
}

BsdfSample sample_null(vec3 wo) {
  return BsdfSample(-wo, vec3(1.0), 0.0, kLobeDelta | kLobeTransmission | kLobeNull, 1.0);
}

// A leaf is chosen with its weight as probability, null with the rest; u_lobe is stretched and used again.
BsdfSample sample_bsdf(SurfaceBsdf b, vec2 u, float u_lobe) {
  if (max_leaves == 0u) return sample_null(b.wo);
  float u_leaf = u_lobe;
  bool is_null = false;
  if (has_material(kMaterialNull)) {
    is_null = u_lobe < b.null_weight;
    u_leaf = is_null ? u_lobe : (u_lobe - b.null_weight) / (1.0 - b.null_weight);
  }

  BsdfSample s;
  if (max_leaves == 1u) {
    s = sample_leaf(b.leaf, u, u_leaf);
    s.pdf *= b.weight;
  } else {
    // Choose a leaf: the one in whose part of [0, sum of the weights) u falls.
    float leaf_sum = 0.0;
    for (uint i = 0u; i < max_leaves; ++i) leaf_sum += b.weights[i];
    float target = u_leaf * leaf_sum;
    uint row = b.first, chosen = b.first;
    float begin = 0.0, below = 0.0, weight = b.weights[0];
    for (uint i = 0u; i < max_leaves; ++i) {
      bool inside = target >= begin && b.weights[i] > 0.0;
      chosen = inside ? row : chosen;
      below = inside ? begin : below;
      weight = inside ? b.weights[i] : weight;
      begin += b.weights[i];
      uint next = load_material_row(row).w;
      row += i + 1u < b.count ? next : 0u;
    }
    float u_inner = clamp((target - below) / weight, 0.0, kLargestUniform);
    s = sample_leaf(load_leaf(chosen, load_material_row(chosen), b.it, b.wo), u, u_inner);
    if ((s.flags & kLobeDelta) == 0u) {
      BsdfEval mixture = eval_bsdf(b, s.wi);
      bool alone = weight >= 1.0;  // then its own weight is exact
      if (!alone && s.pdf > 0.0) s.weight = mixture.f / mixture.pdf;
      s.pdf = s.pdf > 0.0 ? mixture.pdf : 0.0;
    }
  }
  if (is_null) s = sample_null(b.wo);
  return s;
}

// Share of the light that goes straight through a surface, for shadow rays: the weight of the null part.
vec3 null_transmission_bsdf(uint material, TexturePoint point, vec3 n_s, vec3 wo) {
  uvec4 head = load_material_row(material);
  bool front = dot(n_s, wo) > 0.0;
  uint row = front ? head.z : head.w;
  uint count = (front ? head.x : head.x >> 8u) & 0xffu;
  bool passes = (head.y & kMaterialNull) != 0u;
  float sum = 0.0;
  for (uint i = 0u; i < (passes ? count : 0u); ++i) {
    uvec4 header = load_material_row(row);
    sum += load_leaf_weight(row, header, point);
    row += header.w;
  }
  return vec3(passes ? null_weight_of(sum) : 0.0);
}

#endif
