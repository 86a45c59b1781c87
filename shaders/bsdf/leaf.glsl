// One leaf of a material: the switch over all types of bsdf. Adding a type adds a line to each switch here, and a block
// to compiled_types.glsl.
#ifndef TACHYLITE_BSDF_LEAF_GLSL
#define TACHYLITE_BSDF_LEAF_GLSL
#include "bsdf/compiled_types.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"
#include "bsdf/shading_map.glsl"
#include "geometry/interaction.glsl"

// Maps inside maps are in the kernel that has everything, and cost no other any time to compile.
#if BSDF_TYPES != 0xffff || defined(BSDF_SINGLE_LEAF) || defined(BSDF_NO_TEXTURES)
#define IF_NESTED_MAPS(code)
#else
#define IF_NESTED_MAPS(code) code
#endif

// Members of types that the class does not have are never written or read, and vanish.
struct Leaf {
  uint type;        // kBsdf...
  vec3 s, t, n;     // world-space axes of the leaf's frame; mirrors are folded in, so it may be left-handed
  vec3 wo;          // in that frame
  vec3 wo_world;
  vec3 n_shading;   // shading normal, mirrored as the leaf asks; that of the outer map where there are two
  float n_side;     // -1: n is mirrored after the normal or bump map
  float alpha2;     // of that map's shadowing
  IF_NESTED_MAPS(vec3 n_outer; float outer_side; float outer_alpha2;)  // the same three of the map around that one
  IF_DIFFUSE(DiffuseBsdf diffuse;)
  IF_ROUGH_DIFFUSE(RoughDiffuseBsdf rough_diffuse;)
  IF_CONDUCTOR(ConductorBsdf conductor;)
  IF_ROUGH_CONDUCTOR(RoughConductorBsdf rough_conductor;)
  IF_DIELECTRIC(DielectricBsdf dielectric;)
  IF_THIN_DIELECTRIC(ThinDielectricBsdf thin_dielectric;)
  IF_ROUGH_DIELECTRIC(RoughDielectricBsdf rough_dielectric;)
  IF_PLASTIC(PlasticBsdf plastic;)
  IF_ROUGH_PLASTIC(RoughPlasticBsdf rough_plastic;)
  IF_PRINCIPLED(PrincipledBsdf principled;)
  IF_PRINCIPLED_THIN(PrincipledThinBsdf principled_thin;)
  IF_BLINN_PHONG(BlinnPhongBsdf blinn_phong;)
  IF_MICROFACET(NoriMicrofacetBsdf nori_microfacet;)
};

const uint kSingleLobeBsdfs = (1u << kBsdfNull) | (1u << kBsdfDiffuse) | (1u << kBsdfRoughDiffuse) |
                              (1u << kBsdfConductor) | (1u << kBsdfRoughConductor);

// In a class with one type of leaf the type is not looked at.
uint leaf_types() { return bsdf_types & ~(1u << kBsdfNull); }
bool is_leaf(uint leaf_type, uint type) {
  return leaf_types() == (1u << type) || (has_bsdf(type) && leaf_type == type);
}

// Whether anything in the class depends on the headers of leaves.
bool has_leaf_headers() {
  return (leaf_types() & (leaf_types() - 1u)) != 0u ||
         has_material(kMaterialHasWeights | kMaterialHasFrames | kMaterialSides) ||
         (has_material(kMaterialBeckmann) && has_material(kMaterialGgx));
}

vec3 to_leaf(Leaf leaf, vec3 w) { return vec3(dot(leaf.s, w), dot(leaf.t, w), dot(leaf.n, w)); }
vec3 from_leaf(Leaf leaf, vec3 w) { return w.x * leaf.s + w.y * leaf.t + w.z * leaf.n; }

// Turns the frame by the map of the given kind and options whose row is `row`, and mirrors what is inside as asked.
// The shading frame of `it` is that of the map, not mirrored.
ShadingMap turn_leaf_frame(inout Leaf leaf, uint map, uint row, Interaction it, bool mirror) {
  ShadingMap turn = load_shading_map(map, row, it, to_leaf(leaf, leaf.wo_world));
  vec3 s = from_leaf(leaf, turn.s), t = from_leaf(leaf, turn.t), n = from_leaf(leaf, turn.n);
  leaf.n_side = mirror && dot(n, leaf.wo_world) < 0.0 ? -1.0 : 1.0;
  leaf.s = s;
  leaf.t = t;
  leaf.n = leaf.n_side * n;
  leaf.alpha2 = turn.alpha2;
  return turn;
}

void set_leaf_frame(inout Leaf leaf, uint row, uvec4 header, Interaction it, vec3 wo) {
  leaf.s = it.s;
  leaf.t = it.t;
  leaf.n = it.n_s;
  leaf.wo_world = wo;
  bool mirror = has_material(kMaterialTwoSided) ||
                (has_material(kMaterialSides) && (header.x & (kMirrorOuter << 8u)) != 0u);
  if (mirror && dot(it.n_s, wo) < 0.0) leaf.n = -it.n_s;
  leaf.n_shading = leaf.n;
  leaf.n_side = 1.0;
  leaf.alpha2 = 0.0;
  uint map = header.z, mirror_inside = kMirrorInner << 8u;
  uint frame_row = row + (header.y >> 16u) - 1u;  // the one before the weights
  IF_NESTED_MAPS(leaf.n_outer = leaf.n; leaf.outer_side = 1.0; leaf.outer_alpha2 = 0.0;)
  IF_NESTED_MAPS(if (has_material(kMaterialNestedFrames) && (header.z >> 16u) != kFrameNone) {
    bool between = (header.x & mirror_inside) != 0u;
    ShadingMap turn = turn_leaf_frame(leaf, header.z & 0xffffu, frame_row - 1u, it, between);
    vec3 s = it.s * turn.s.x + it.t * turn.s.y + it.n_s * turn.s.z;
    vec3 t = it.s * turn.t.x + it.t * turn.t.y + it.n_s * turn.t.z;
    vec3 n = it.s * turn.n.x + it.t * turn.n.y + it.n_s * turn.n.z;
    it.s = s;
    it.t = t;
    it.n_s = n;
    leaf.n_shading = leaf.n;
    leaf.outer_side = leaf.n_side;
    leaf.outer_alpha2 = leaf.alpha2;
    map = header.z >> 16u;
    mirror_inside = kMirrorInnermost << 8u;
  })
  if (has_material(kMaterialHasFrames) && (header.z & 0xffu) != kFrameNone)
    turn_leaf_frame(leaf, map, frame_row, it, (header.x & mirror_inside) != 0u);
  leaf.wo = to_leaf(leaf, wo);
}

// Whether the viewer is on the side of the frames inside the maps that the leaf is for.
bool is_leaf_on_side(uint row, uvec4 header, Interaction it, vec3 wo) {
  uint sides = (header.x >> kSideShift) & 0xfu;
  Leaf leaf;
  set_leaf_frame(leaf, row, header, it, wo);
  float innermost = leaf.n_side * leaf.wo.z, inner = innermost;
  IF_NESTED_MAPS(if (has_material(kMaterialNestedFrames) && (header.z >> 16u) != kFrameNone)
                   inner = leaf.outer_side * dot(leaf.n_shading, wo);)
  uint others = (inner > 0.0 ? kSideBackInner : kSideFrontInner) |
                (innermost > 0.0 ? kSideBackInnermost : kSideFrontInnermost);
  return (sides & others) == 0u;
}

// The leaf that begins at row `row` and whose first row is `header` (undefined where has_leaf_headers() is false).
Leaf load_leaf(uint row, uvec4 header, Interaction it, vec3 wo_world) {
  Leaf leaf;
  leaf.type = header.x & 0xffu;
  uint options = header.x >> 16u;
  set_leaf_frame(leaf, row, header, it, wo_world);
  vec3 wo = leaf.wo;
  TexturePoint at = it.point;
  IF_DIFFUSE(if (is_leaf(leaf.type, kBsdfDiffuse)) leaf.diffuse = load_diffuse(row, at);)
  IF_ROUGH_DIFFUSE(if (is_leaf(leaf.type, kBsdfRoughDiffuse)) leaf.rough_diffuse = load_rough_diffuse(row, at);)
  IF_CONDUCTOR(if (is_leaf(leaf.type, kBsdfConductor)) leaf.conductor = load_conductor(row, at);)
  IF_ROUGH_CONDUCTOR(if (is_leaf(leaf.type, kBsdfRoughConductor)) leaf.rough_conductor = load_rough_conductor(row, options, at);)
  IF_DIELECTRIC(if (is_leaf(leaf.type, kBsdfDielectric)) leaf.dielectric = load_dielectric(row, wo, at);)
  IF_THIN_DIELECTRIC(if (is_leaf(leaf.type, kBsdfThinDielectric)) leaf.thin_dielectric = load_thin_dielectric(row, at);)
  IF_ROUGH_DIELECTRIC(if (is_leaf(leaf.type, kBsdfRoughDielectric)) leaf.rough_dielectric = load_rough_dielectric(row, options, wo, at);)
  IF_PLASTIC(if (is_leaf(leaf.type, kBsdfPlastic)) leaf.plastic = load_plastic(row, at);)
  IF_ROUGH_PLASTIC(if (is_leaf(leaf.type, kBsdfRoughPlastic)) leaf.rough_plastic = load_rough_plastic(row, options, wo, at);)
  IF_PRINCIPLED(if (is_leaf(leaf.type, kBsdfPrincipled)) leaf.principled = load_principled(row, wo, at);)
  IF_PRINCIPLED_THIN(if (is_leaf(leaf.type, kBsdfPrincipledThin)) leaf.principled_thin = load_principled_thin(row, wo, at);)
  IF_BLINN_PHONG(if (is_leaf(leaf.type, kBsdfBlinnPhong)) leaf.blinn_phong = load_blinn_phong(row, at);)
  IF_MICROFACET(if (is_leaf(leaf.type, kBsdfMicrofacet)) leaf.nori_microfacet = load_nori_microfacet(row, wo, at);)
  return leaf;
}

// Share of light from wi that the leaf's maps let through; 0 where one of them and what is around it have wi on
// different sides. z: of wi in the leaf's frame.
float leaf_map_shadowing(Leaf leaf, vec3 wi_world, float z) {
  float cos_shading = dot(leaf.n_shading, wi_world);
  float share = shading_map_shadowing(leaf.alpha2, cos_shading);
  if (!(cos_shading * leaf.n_side * z > 0.0)) share = 0.0;
  IF_NESTED_MAPS(if (has_material(kMaterialNestedFrames)) {
    float cos_outer = dot(leaf.n_outer, wi_world);
    share *= shading_map_shadowing(leaf.outer_alpha2, cos_outer);
    if (!(cos_outer * leaf.outer_side * cos_shading > 0.0)) share = 0.0;
  })
  return share;
}

BsdfEval eval_leaf(Leaf leaf, vec3 wi_world) {
  vec3 wo = leaf.wo, wi = to_leaf(leaf, wi_world);
  BsdfEval eval = kNoEval;
  IF_DIFFUSE(if (is_leaf(leaf.type, kBsdfDiffuse)) eval = eval_diffuse(leaf.diffuse, wo, wi);)
  IF_ROUGH_DIFFUSE(if (is_leaf(leaf.type, kBsdfRoughDiffuse)) eval = eval_rough_diffuse(leaf.rough_diffuse, wo, wi);)
  IF_ROUGH_CONDUCTOR(if (is_leaf(leaf.type, kBsdfRoughConductor)) eval = eval_rough_conductor(leaf.rough_conductor, wo, wi);)
  IF_ROUGH_DIELECTRIC(if (is_leaf(leaf.type, kBsdfRoughDielectric)) eval = eval_rough_dielectric(leaf.rough_dielectric, wo, wi);)
  IF_PLASTIC(if (is_leaf(leaf.type, kBsdfPlastic)) eval = eval_plastic(leaf.plastic, wo, wi);)
  IF_ROUGH_PLASTIC(if (is_leaf(leaf.type, kBsdfRoughPlastic)) eval = eval_rough_plastic(leaf.rough_plastic, wo, wi);)
  IF_PRINCIPLED(if (is_leaf(leaf.type, kBsdfPrincipled)) eval = eval_principled(leaf.principled, wo, wi);)
  IF_PRINCIPLED_THIN(if (is_leaf(leaf.type, kBsdfPrincipledThin)) eval = eval_principled_thin(leaf.principled_thin, wo, wi);)
  IF_BLINN_PHONG(if (is_leaf(leaf.type, kBsdfBlinnPhong)) eval = eval_blinn_phong(leaf.blinn_phong, wo, wi);)
  IF_MICROFACET(if (is_leaf(leaf.type, kBsdfMicrofacet)) eval = eval_nori_microfacet(leaf.nori_microfacet, wo, wi);)
  if (has_material(kMaterialHasFrames)) {
    float share = leaf_map_shadowing(leaf, wi_world, wi.z);
    eval.f *= share;
    if (!(share > 0.0)) eval = kNoEval;
  }
  return eval;
}

BsdfSample sample_leaf(Leaf leaf, vec2 u, float u_lobe) {
  vec3 wo = leaf.wo;
  BsdfSample s = absorbed();
  IF_DIFFUSE(if (is_leaf(leaf.type, kBsdfDiffuse)) s = sample_diffuse(leaf.diffuse, wo, u);)
  IF_ROUGH_DIFFUSE(if (is_leaf(leaf.type, kBsdfRoughDiffuse)) s = sample_rough_diffuse(leaf.rough_diffuse, wo, u);)
  IF_CONDUCTOR(if (is_leaf(leaf.type, kBsdfConductor)) s = sample_conductor(leaf.conductor, wo);)
  IF_ROUGH_CONDUCTOR(if (is_leaf(leaf.type, kBsdfRoughConductor)) s = sample_rough_conductor(leaf.rough_conductor, wo, u);)
  IF_DIELECTRIC(if (is_leaf(leaf.type, kBsdfDielectric)) s = sample_dielectric(leaf.dielectric, wo, u_lobe);)
  IF_THIN_DIELECTRIC(if (is_leaf(leaf.type, kBsdfThinDielectric)) s = sample_thin_dielectric(leaf.thin_dielectric, wo, u_lobe);)
  IF_ROUGH_DIELECTRIC(if (is_leaf(leaf.type, kBsdfRoughDielectric)) s = sample_rough_dielectric(leaf.rough_dielectric, wo, u, u_lobe);)
  IF_PLASTIC(if (is_leaf(leaf.type, kBsdfPlastic)) s = sample_plastic(leaf.plastic, wo, u, u_lobe);)
  IF_ROUGH_PLASTIC(if (is_leaf(leaf.type, kBsdfRoughPlastic)) s = sample_rough_plastic(leaf.rough_plastic, wo, u, u_lobe);)
  IF_PRINCIPLED(if (is_leaf(leaf.type, kBsdfPrincipled)) s = sample_principled(leaf.principled, wo, u, u_lobe);)
  IF_PRINCIPLED_THIN(if (is_leaf(leaf.type, kBsdfPrincipledThin)) s = sample_principled_thin(leaf.principled_thin, wo, u, u_lobe);)
  IF_BLINN_PHONG(if (is_leaf(leaf.type, kBsdfBlinnPhong)) s = sample_blinn_phong(leaf.blinn_phong, wo, u, u_lobe);)
  IF_MICROFACET(if (is_leaf(leaf.type, kBsdfMicrofacet)) s = sample_nori_microfacet(leaf.nori_microfacet, wo, u, u_lobe);)
  float z = s.wi.z;
  s.wi = from_leaf(leaf, s.wi);
  if (has_bsdf(kBsdfThinDielectric) && (s.flags & kLobeNull) != 0u) s.wi = -leaf.wo_world;
  if (has_material(kMaterialHasFrames)) {
    float share = leaf_map_shadowing(leaf, s.wi, z);
    s.weight *= share;
    if (!(share > 0.0)) s = absorbed();
  }
  return s;
}

#endif
