// Sums the auxiliary outputs over the samples of a block, after the camera rays were traced (but for the moments,
// which wait for the radiance: MOMENT). One lane a pixel and block.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/features.glsl"
#include "base/queues.glsl"
#include "geometry/load.glsl"
#include "geometry/surface.glsl"
#include "bsdf/albedo.glsl"
#include "shared/aov.h"

layout(set = 0, binding = kBindAov) writeonly restrict buffer Aov { vec4 aov[]; };

bool has_aov(uint kind) { return (aov_kinds & (1u << kind)) != 0u; }
// hits: samples that hit something.
void put(uint kind, uint i, vec3 sum, float hits) {
  uint row = bitCount(aov_kinds & ((1u << kind) - 1u));
  if (has_aov(kind)) aov[row * params.aov_stride + i] = vec4(sum, hits);
}

void main() {
  uint i = gl_GlobalInvocationID.x;  // block * pixel_count + pixel
  if (i >= wave.pixel_count * wave.block_count) return;
#ifdef MOMENT
  vec3 squares = vec3(0.0);
  for (uint s = 0u; s < kBlockSamples; ++s) {
    vec3 radiance = load_path(kPathRadiance, i * kBlockSamples + s).xyz;
    squares += radiance * radiance;
  }
  put(kAovMoment, i, squares, 0.0);
#else
  vec3 sums[kAovKinds];
  for (uint k = 0u; k < kAovKinds; ++k) sums[k] = vec3(0.0);
  float hits = 0.0;
  uvec2 pixel;
  bool inside = pixel_of(slot_tile_pixel(i * kBlockSamples), pixel);
  for (uint s = 0u; s < kBlockSamples; ++s) {
    uint slot = i * kBlockSamples + s;
    vec4 hit = load_path(kPathHit, slot);
    if (inside && slot_sample(slot) < params.end_sample && floatBitsToUint(hit.x) != kNoHit) {
      vec3 o = load_path(kPathOrigin, slot).xyz, d = load_path(kPathDirection, slot).xyz;
      Interaction it = load_interaction(hit, o, d);
      hits += 1.0;
      sums[kAovDepth] += hit.w;
      sums[kAovPosition] += it.p;
      sums[kAovUv] += vec3(it.point.uv, 0.0);
      sums[kAovGeoNormal] += it.n_g;
      sums[kAovShNormal] += it.n_s;
      sums[kAovDpDu] += it.dp_du;
      sums[kAovDpDv] += it.dp_dv;
      uvec4 primitives = load_shape(it.shape + 1u);
      sums[kAovPrimIndex] += it.point.primitive == kNoIndex
                                 ? 0.0 : float((it.point.primitive - primitives.x) / primitives.w);
      sums[kAovShapeIndex] += float(it.shape / kShapeRows);
      if (has_aov(kAovAlbedo)) sums[kAovAlbedo] += material_albedo(it, -d);
    }
  }
  for (uint k = 0u; k < kAovMoment; ++k) put(k, i, sums[k], hits);
#endif
}
