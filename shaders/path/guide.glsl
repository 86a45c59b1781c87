// Guiding of diffuse surfaces: directions are sampled by what photons have left in the cell (shared/guide.h): some by
// cosine times the density of its first table, as a warp of the numbers that sample the cosine; the others within the
// cones of its focusers, by the densities of their tables. Jensen 1995, "Importance Driven Path Tracing using
// the Photon Map", with the hashed cells of Binder, Fricke and Keller 2019, "Massively Parallel Path Space Filtering".
#ifndef TACHYLITE_PATH_GUIDE_GLSL
#define TACHYLITE_PATH_GUIDE_GLSL
#include "base/features.glsl"
#include "base/queues.glsl"
#include "path/focus_cone.glsl"
#include "path/guide_table.glsl"
#include "shared/guide.h"
#include "shared/rng.h"

layout(set = 0, binding = kBindPhotons) restrict buffer Photons { uint photon_flux[]; };

// The cell at a point of a surface.
struct GuideCell {
  uint first;     // bin
  vec4 shares;    // of the samples that go to each focuser; w: that follow nothing
  vec3 p, tangent;
};

uint guide_cell_bins() { return kGuideCellBins * (1u + focuser_count); }

// First bin of the table of a focuser.
uint focuser_table(GuideCell cell, uint focuser) { return cell.first + (focuser + 1u) * kGuideCellBins; }

// First bin of the cell at p (device space) on a surface with normal n.
uint first_guide_bin(vec3 p, vec3 n) {
  float edge = camera_kind == kCameraOrthographic ? params.guide_scale
                                                  : params.guide_scale * distance(p, params.camera.position.xyz);
  // Near a focuser its light has a direction of its own at each place.
  bool near = false;
  for (uint k = 0u; k < focuser_count; ++k) near = near || !sees_focuser(params.focusers[k], p);
  if (near) edge *= 0.25;
  uint exponent = floatBitsToUint(max(edge, 1e-30)) >> 23u;
  float per_edge = uintBitsToFloat((254u - exponent) << 23u);  // 1 / 2^floor(log2 edge)
  // Walls often lie at round numbers; borders of cells should not.
  uvec3 q = uvec3(ivec3(floor(p * per_edge + vec3(0.377, 0.291, 0.433))));
  vec3 a = abs(n);
  uint axis = a.x > max(a.y, a.z) ? (n.x > 0.0 ? 0u : 1u) : (a.y > a.z ? (n.y > 0.0 ? 2u : 3u) : (n.z > 0.0 ? 4u : 5u));
  uint key = hash_pair(hash_pair(q.x, q.y), hash_pair(q.z, exponent * 8u + axis));
  return key % kGuideCells * guide_cell_bins();
}

GuideCell find_guide_cell(vec3 p, vec3 n) {
  GuideCell cell = GuideCell(first_guide_bin(p, n), vec4(0.0), p, frame_from_normal(n).s);
  if (!is_photon_pass) {
    uvec2 shares = texelFetch(guide_table, int(cell.first + kGuideShares)).xy;
    cell.shares = vec4(unpackUnorm2x16(shares.x), unpackUnorm2x16(shares.y));
    if (shares.y >> 16u == 0xffffu) cell.first = kGuideCells * guide_cell_bins();
    // Where a sphere holds the point, the surface goes on without it.
    for (uint k = 0u; k < focuser_count; ++k)
      if (!sees_focuser(params.focusers[k], p)) cell.shares[k] = 0.0;
  }
  return cell;
}

FocusCone focus_cone(GuideCell cell, uint focuser) {
  return focus_cone(params.focusers[focuser], cell.p, cell.tangent);
}

// Density [1/sr] of all ways to sample the world direction w, whose direction in the surface's frame is `local`.
// pdf_bsdf: that of the bsdf.
float guided_pdf(GuideCell cell, vec3 w, vec3 local, float pdf_bsdf) {
  float base = 1.0, pdf = 0.0;
  for (uint k = 0u; k < focuser_count; ++k) {
    FocusCone cone = focus_cone(cell, k);
    vec2 u = focus_numbers(cone, w);
    float density = table_density(focuser_table(cell, k), bin_of_numbers(u));
    pdf += cell.shares[k] > 0.0 && is_in_square(u) ? cell.shares[k] * pdf_focus_cone(cone) * density : 0.0;
    base -= cell.shares[k];
  }
  return base * guide_density(cell.first, local) * pdf_bsdf + pdf;
}

// flux: of the photon that came from o along d, 1 for the mean photon; w: against d, in the surface's frame;
// is_caustic: from a focused lobe.
void deposit_photon(bool wanted, GuideCell cell, vec3 o, vec3 d, vec3 w, float flux, bool is_caustic) {
  wanted = wanted && w.z > 0.0;
  flux = clamp(flux, 0.0, 16.0);
  uint bin = cell.first + guide_bin(w);
  bool found = false;
  for (uint k = 0u; k < focuser_count; ++k) {
    vec4 sphere = params.focusers[k];
    bool comes = !found && distance(o, sphere.xyz) < sphere.w && sees_focuser(sphere, cell.p);
    if (comes) bin = focuser_table(cell, k) + bin_of_numbers(focus_numbers(focus_cone(cell, k), -d));
    found = found || comes;
  }
  if (wanted) atomicAdd(photon_flux[bin], uint(flux * kPhotonUnit + 0.5));
  add_to_counter(kCounterCaustics, wanted && is_caustic ? uint(flux * kCausticUnit + 0.5) : 0u);
}

#endif
