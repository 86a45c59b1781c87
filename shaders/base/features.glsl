// The specialization constants of every kernel; what they mean stands in shared/features.h.
#ifndef TACHYLITE_BASE_FEATURES_GLSL
#define TACHYLITE_BASE_FEATURES_GLSL
#include "shared/features.h"
#include "shared/material.h"
#include "shared/texture.h"

layout(constant_id = kFeatureCurved) const bool has_curved = true;
layout(constant_id = kFeatureVertexNormals) const bool has_vertex_normals = true;
layout(constant_id = kFeatureVertexUv) const bool has_vertex_uv = true;
layout(constant_id = kFeatureClassCount) const uint class_count = 1u;
layout(constant_id = kFeatureCamera) const uint camera_kind = kCameraPerspective;
layout(constant_id = kFeatureFilter) const uint filter_kind = kFilterBox;
layout(constant_id = kFeatureSampler) const uint sampler_kind = kSamplerSobol;
layout(constant_id = kFeatureLog2Samples) const uint log2_samples = 16u;
layout(constant_id = kFeatureMaxDepth) const uint max_depth = 0xffffffffu;
layout(constant_id = kFeatureRouletteDepth) const uint roulette_depth = 5u;
layout(constant_id = kFeatureHideEmitters) const bool hide_emitters = false;
layout(constant_id = kFeatureStrategy) const uint strategy = kStrategyMis;
layout(constant_id = kFeatureLights) const uint light_kinds = 0xffffffffu;
layout(constant_id = kFeatureSelection) const uint light_selection = kSelectLoop;
layout(constant_id = kFeatureLightTextures) const bool has_light_textures = true;
layout(constant_id = kFeatureTextures) const uint texture_kinds = 0xffffffffu;
layout(constant_id = kFeatureBsdfs) const uint bsdf_types = 0xffffffffu;
layout(constant_id = kFeatureMaterial) const uint material_flags = 0xffffffffu;
layout(constant_id = kFeatureMaxLeaves) const uint max_leaves = 4u;
layout(constant_id = kFeatureTexturedInputs) const uint textured_inputs = 0xffffffffu;
layout(constant_id = kFeatureClass) const uint material_class = 0u;
layout(constant_id = kFeatureMedia) const uint media_kinds = 0u;
layout(constant_id = kFeatureShadowNull) const bool shadow_passes_null = false;
layout(constant_id = kFeatureAov) const uint aov_kinds = 0u;
layout(constant_id = kFeatureCameraMedium) const uint camera_medium = 0xffffu;
layout(constant_id = kFeatureTriangles) const bool has_triangles = true;
layout(constant_id = kFeaturePixelList) const bool has_pixel_list = false;
layout(constant_id = kFeatureGuide) const bool has_guide = false;
layout(constant_id = kFeatureWalls) const bool has_walls = false;
layout(constant_id = kFeatureFocusers) const uint focuser_count = 0u;
layout(constant_id = kFeaturePhotons) const bool is_photon_pass = false;
layout(constant_id = kFeatureStorageReads) const bool reads_storage = false;

bool has_bsdf(uint type) { return (bsdf_types & (1u << type)) != 0u; }
bool has_light(uint kind) { return (light_kinds & (1u << kind)) != 0u; }
bool has_texture(uint feature) { return (texture_kinds & feature) != 0u; }
bool has_textured_input(uint inputs) { return (textured_inputs & inputs) != 0u; }
bool has_material(uint flag) { return (material_flags & flag) != 0u; }

// Whether rays that escape find light, and whether rays that hit something may.
bool has_escaped_light() { return has_light(kLightConstant) || has_light(kLightEnvironment); }
bool has_area_light() {
  return has_light(kLightTriangles) || has_light(kLightRectangle) || has_light(kLightSphere) || has_light(kLightDisk) ||
         has_light(kLightCylinder);
}

// Whether some stage samples lights; next-event estimation may still be no use to a kernel's own class.
bool has_shadow_rays() { return light_selection != kSelectNone && strategy != kStrategyBsdf; }

#endif
