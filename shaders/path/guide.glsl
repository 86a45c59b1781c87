// Guiding of diffuse surfaces: directions are sampled by cosine times the density that photons have left in the cell
// (shared/guide.h), as a warp of the numbers that sample the cosine. Jensen 1995, "Importance Driven Path Tracing using
// the Photon Map", with the hashed cells of Binder, Fricke and Keller 2019, "Massively Parallel Path Space Filtering".
#ifndef TACHYLITE_PATH_GUIDE_GLSL
#define TACHYLITE_PATH_GUIDE_GLSL
#include "base/features.glsl"
#include "base/queues.glsl"
#include "path/guide_table.glsl"
#include "shared/guide.h"
#include "shared/rng.h"

layout(set = 0, binding = kBindPhotons) restrict buffer Photons { uint photon_flux[]; };

// First bin of the cell at p (device space) on a surface with normal n.
uint guide_cell(vec3 p, vec3 n) {
  float edge = camera_kind == kCameraOrthographic ? params.guide_scale
                                                  : params.guide_scale * distance(p, params.camera.position.xyz);
  uint exponent = floatBitsToUint(max(edge, 1e-30)) >> 23u;
  float per_edge = uintBitsToFloat((254u - exponent) << 23u);  // 1 / 2^floor(log2 edge)
  // Walls often lie at round numbers; borders of cells should not.
  uvec3 q = uvec3(ivec3(floor(p * per_edge + vec3(0.377, 0.291, 0.433))));
  vec3 a = abs(n);
  uint axis = a.x > max(a.y, a.z) ? (n.x > 0.0 ? 0u : 1u) : (a.y > a.z ? (n.y > 0.0 ? 2u : 3u) : (n.z > 0.0 ? 4u : 5u));
  uint key = hash_pair(hash_pair(q.x, q.y), hash_pair(q.z, exponent * 8u + axis));
  return key % kGuideCells * kGuideCellBins;
}

// flux: of the photon that came from the local direction w, 1 for the mean photon; is_caustic: from a focused lobe.
void deposit_photon(bool wanted, uint cell, vec3 w, float flux, bool is_caustic) {
  wanted = wanted && w.z > 0.0;
  flux = clamp(flux, 0.0, 16.0);
  if (wanted) atomicAdd(photon_flux[cell + guide_bin(w)], uint(flux * kPhotonUnit + 0.5));
  add_to_counter(kCounterCaustics, wanted && is_caustic ? uint(flux * kCausticUnit + 0.5) : 0u);
}

#endif
