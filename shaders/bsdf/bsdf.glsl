// The bsdf of a material: its leaves (leaf.glsl), weighted, and its null part.
//
// Directions point away from the surface: wo to the viewer, wi to the light (Mitsuba and Cycles swap the names).
// Here they are in world space; in the files of the leaves they are in the leaf's frame, z = shading normal, which
// points to the outside. f is not symmetric in transmission: radiance is scaled by 1/eta^2 (Walter et al. 2007,
// "Microfacet Models for Refraction through Rough Surfaces", section 4.2), as paths come from the camera.
//
// Everything that the material class lacks is compiled out: base/features.glsl, bsdf_types and material_flags. To spare
// drivers the work, a kernel's SPIR-V has code for single leaves (BSDF_SINGLE_LEAF defined) or for mixtures of any
// number of leaves, and only some types (compiled_types.glsl), and none for textured inputs where BSDF_NO_TEXTURES is
// defined. cmake/BsdfVariants.cmake lists the variants.
#ifndef TACHYLITE_BSDF_BSDF_GLSL
#define TACHYLITE_BSDF_BSDF_GLSL
#include "bsdf/leaf.glsl"
#include "bsdf/null_transmission.glsl"

// Whether sample_bsdf ignores u_lobe.
bool only_single_lobes() {
  return max_leaves <= 1u && (bsdf_types & ~kSingleLobeBsdfs) == 0u && !has_material(kMaterialHasWeights);
}

BsdfSample sample_null(vec3 wo) {
  return BsdfSample(-wo, vec3(1.0), 0.0, kLobeDelta | kLobeTransmission | kLobeNull, 1.0);
}

#ifdef BSDF_SINGLE_LEAF
#include "bsdf/single_leaf.glsl"
#else
#include "bsdf/mixture.glsl"
#endif

#endif
