// The bsdf of a material with at most one leaf (on each side), and a null part: loaded once, no loops.
#ifndef TACHYLITE_BSDF_SINGLE_LEAF_GLSL
#define TACHYLITE_BSDF_SINGLE_LEAF_GLSL

struct SurfaceBsdf {
  Leaf leaf;
  float weight;       // of the leaf
  float null_weight;
  vec3 wo;
};

SurfaceBsdf load_bsdf(Interaction it, vec3 wo) {
  SurfaceBsdf b;
  b.wo = wo;
  b.weight = max_leaves == 0u ? 0.0 : 1.0;
  b.null_weight = 1.0 - b.weight;
  if (max_leaves == 0u) return b;
  uint row = it.material + 1u;
  bool empty = false;
  if (has_material(kMaterialSides)) {
    uvec4 material = load_material_row(it.material);
    bool front = dot(it.n_s, wo) > 0.0;
    row = front ? material.z : material.w;
    empty = ((front ? material.x : material.x >> 8u) & 0xffu) == 0u;
  }
  uvec4 header = has_leaf_headers() ? load_material_row(row) : uvec4(0u);
  b.leaf = load_leaf(row, header, it, wo);
  if (has_material(kMaterialHasWeights)) b.weight = load_leaf_weight(row, header, it.point);
  if (has_material(kMaterialSides) && empty) b.weight = 0.0;
  if (has_bsdf(kBsdfNull)) b.null_weight = null_weight_of(b.weight);
  return b;
}

BsdfEval eval_bsdf(SurfaceBsdf b, vec3 wi) {
  if (max_leaves == 0u) return kNoEval;
  BsdfEval eval = eval_leaf(b.leaf, wi);
  return BsdfEval(b.weight * eval.f, b.weight * eval.pdf);
}

// Null is chosen with its weight as probability; u_lobe is stretched and used again.
BsdfSample sample_bsdf(SurfaceBsdf b, vec2 u, float u_lobe) {
  if (max_leaves == 0u) return sample_null(b.wo);
  bool is_null = has_bsdf(kBsdfNull) && u_lobe < b.null_weight;
  float u_leaf = has_bsdf(kBsdfNull) ? (u_lobe - b.null_weight) / (1.0 - b.null_weight) : u_lobe;
  BsdfSample s = sample_leaf(b.leaf, u, is_null ? 0.0 : u_leaf);
  s.pdf *= b.weight;
  if (has_material(kMaterialSides) && b.weight == 0.0) s = absorbed();
  if (is_null) s = sample_null(b.wo);
  return s;
}

#endif
