// The bsdf of a material with any number of weighted leaves and a null part. Leaves are loaded where they are needed:
// an array of them would lie in memory, which lavapipe compiles for minutes. Loops take as many turns for all lanes.
#ifndef TACHYLITE_BSDF_MIXTURE_GLSL
#define TACHYLITE_BSDF_MIXTURE_GLSL

struct SurfaceBsdf {
  float weights[kMaterialMaxLeaves];
  float null_weight;
  uint first, count;  // leaves on the side of wo
  vec3 wo;
  Interaction it;
};

const float kLargestUniform = 0.99999994;  // below 1

// Beyond the end of the list stands the last leaf again, with weight 0.
uint next_leaf(SurfaceBsdf b, uint i, uint row, uvec4 header) { return row + (i + 1u < b.count ? header.w : 0u); }

SurfaceBsdf load_bsdf(Interaction it, vec3 wo) {
  SurfaceBsdf b;
  b.wo = wo;
  b.it = it;
  uvec4 material = load_material_row(it.material);
  bool front = dot(it.n_s, wo) > 0.0;
  b.first = front ? material.z : material.w;
  b.count = (front ? material.x : material.x >> 8u) & 0xffu;
  uint row = b.first;
  float sum = 0.0;
  for (uint i = 0u; i < max_leaves; ++i) {
    uvec4 header = load_material_row(row);
    b.weights[i] = i < b.count ? load_leaf_weight(row, header, it.point) : 0.0;
    if (has_material(kMaterialMapSides) && !is_leaf_on_side(row, header, it, wo)) b.weights[i] = 0.0;
    sum += b.weights[i];
    row = next_leaf(b, i, row, header);
  }
  b.null_weight = has_bsdf(kBsdfNull) ? null_weight_of(sum) : 0.0;
  return b;
}

BsdfEval eval_bsdf(SurfaceBsdf b, vec3 wi) {
  BsdfEval sum = kNoEval;
  uint row = b.first;
  for (uint i = 0u; i < max_leaves; ++i) {
    uvec4 header = load_material_row(row);
    BsdfEval eval = eval_leaf(load_leaf(row, header, b.it, b.wo), wi);
    sum.f += b.weights[i] * eval.f;
    sum.pdf += b.weights[i] * eval.pdf;
    row = next_leaf(b, i, row, header);
  }
  return sum;
}

// A leaf is chosen with its weight as probability, null with the rest; u_lobe is stretched and used again. The weight
// of a sample is that of the sum of all leaves, its density that of the whole mixture.
BsdfSample sample_bsdf(SurfaceBsdf b, vec2 u, float u_lobe) {
  bool is_null = u_lobe < b.null_weight;
  float u_leaf = is_null ? 0.0 : (u_lobe - b.null_weight) / (1.0 - b.null_weight);

  // Choose the leaf in whose part of [0, sum of the weights) u_leaf falls.
  float sum = 0.0;
  for (uint i = 0u; i < max_leaves; ++i) sum += b.weights[i];
  float target = u_leaf * sum, begin = 0.0, below = 0.0, weight = b.weights[0];
  uint row = b.first, chosen = b.first;
  for (uint i = 0u; i < max_leaves; ++i) {
    bool inside = target >= begin && b.weights[i] > 0.0;
    chosen = inside ? row : chosen;
    below = inside ? begin : below;
    weight = inside ? b.weights[i] : weight;
    begin += b.weights[i];
    row = next_leaf(b, i, row, load_material_row(row));
  }
  float u_inner = clamp((target - below) / weight, 0.0, kLargestUniform);
  BsdfSample s = sample_leaf(load_leaf(chosen, load_material_row(chosen), b.it, b.wo), u, u_inner);
  if (!(weight > 0.0)) s = absorbed();

  if ((s.flags & kLobeDelta) == 0u) {
    BsdfEval mixture = eval_bsdf(b, s.wi);
    // Alone, its own weight is exact, also where the density rounds to 0: what the ray finds there counts in full
    // (path/mis.glsl), as light sampling evaluates 0 there.
    bool alone = weight >= 1.0;
    if (!alone && s.pdf > 0.0) s.weight = mixture.f / mixture.pdf;
    s.pdf = s.pdf > 0.0 ? mixture.pdf : 0.0;
    // What a leaf has drawn at the edge of its domain may, rounded, lie outside of it.
    if (!alone && !(mixture.pdf > 0.0)) s = absorbed();
  }
  if (is_null) s = sample_null(b.wo);
  return s;
}

#endif
