// Starts photons: one a lane, from a light that is chosen by its power and uniform over its area, one half by the
// cosine and one half to the focusers (shared/guide.h), which few find else; Jensen 1996, "Global Illumination using
// Photon Maps", aims them so with projection maps. Only the guide learns from photons, so their density may be
// approximate (elliptic shapes, textures).
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/queues.glsl"
#include "light/light.glsl"
#include "path/focus_cone.glsl"
#include "shared/sampler.h"
layout(set = 0, binding = kBindEmission) uniform samplerBuffer emission;

// The first light whose share, summed up to and with it, exceeds u.
uint choose_emitter(float u) {
  uint first = 0u, last = params.light_count - 1u;
  while (first < last) {
    uint middle = (first + last) / 2u;
    if (texelFetch(emission, int(middle)).x > u) last = middle; else first = middle + 1u;
  }
  return first;
}

// A direction from p on a light with normal n; flux: that by the cosine over that of the sample.
vec3 sample_photon_direction(vec3 p, vec3 n, vec2 u, uint aim, out float flux) {
  Frame frame = frame_from_normal(n);
  vec3 d = to_world(frame, sample_cosine_hemisphere(u));
  const float share = 0.5 / float(max(focuser_count, 1u));
  for (uint k = 0u; k < focuser_count; ++k)
    if (aim == k && sees_focuser(params.focusers[k], p))
      d = focus_direction(focus_cone(params.focusers[k], p, frame.s), u);
  float by_cosine = pdf_cosine_hemisphere(dot(n, d)), rest = 1.0, pdf = 0.0;
  for (uint k = 0u; k < focuser_count; ++k) {
    if (!sees_focuser(params.focusers[k], p)) continue;
    FocusCone cone = focus_cone(params.focusers[k], p, frame.s);
    if (is_in_square(focus_numbers(cone, d))) pdf += share * pdf_focus_cone(cone);
    rest -= share;
  }
  flux = by_cosine > 0.0 ? by_cosine / (rest * by_cosine + pdf) : 0.0;
  return d;
}

// Whoever aims has one sequence for all photons: the more even they are, the less noise the guide has.
vec4 photon_sample(uint aim, uint index, uint group) {
  return unit_float4(sample_group(kSamplerSobol, pixel_key(~aim, params.seed), index, group, kPhotonBits));
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  bool owned = slot < wave.pixel_count * wave.block_count * kBlockSamples;
  if (!owned) return;
  store_queue(kQueueRays0, slot, slot);

  uint photon = wave.first_pixel * kBlockSamples + slot, aims = 2u * max(focuser_count, 1u);
  uint aim = photon % aims, index = photon / aims;
  vec4 u = photon_sample(aim, index, kGroupCamera);
  uint light = kLightRows * choose_emitter(photon_sample(aim, index, kGroupLens).x);
  vec4 row0 = load_light(light), row1 = load_light(light + 1u), row2 = load_light(light + 2u);
  vec4 row3 = load_light(light + 3u), row4 = load_light(light + 4u);
  uint kind = floatBitsToUint(row0.w) & kLightKindMask;
  vec3 p = row1.xyz, n = row4.xyz;
  uint leaving = floatBitsToUint(row1.w);
  if (is_light(kind, kLightTriangles)) {
    vec2 b = sample_uniform_triangle(u.xy).xy;
    p += b.x * row2.xyz + b.y * row3.xyz;
  }
  if (is_light(kind, kLightRectangle)) {
    p += u.x * row2.xyz + u.y * row3.xyz;
    if (u.x + u.y >= 1.0) leaving = floatBitsToUint(row3.w);
  }
  if (is_light(kind, kLightDisk)) {
    vec2 q = sample_uniform_disk(u.xy);
    p += q.x * row2.xyz + q.y * row3.xyz;
  }
  if (is_light(kind, kLightSphere)) {
    n = sample_uniform_sphere(u.xy);
    p += row2.x * n;
    if (row2.y != 0.0) n = -n;
  }
  if (is_light(kind, kLightCylinder)) {
    vec2 cs = cos_sin_turns(u.x);
    p += cs.x * row2.xyz + cs.y * row3.xyz + u.y * row4.xyz;
    n = normalize(cross(cs.x * row3.xyz - cs.y * row2.xyz, row4.xyz)) * (row3.w != 0.0 ? -1.0 : 1.0);
  }
  float flux;
  vec3 d = sample_photon_direction(p, n, u.zw, aim, flux);
  p += n * (1e-5 * max_component(abs(p)));
  store_path_ray(slot, p, leaving, d, 0.0);
  store_path(kPathBeta, slot, vec4(row0.xyz * (3.0 * flux / max(row0.x + row0.y + row0.z, 1e-30)), 1.0));
  store_path(kPathRadiance, slot, vec4(0.0));
}
