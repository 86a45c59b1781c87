// Adds the radiance of area lights that a ray has hit.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/queues.glsl"
#include "geometry/load.glsl"
#include "geometry/surface.glsl"
#include "light/light.glsl"
#include "path/mis.glsl"
#include "path/volume_path.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= queue_length(kQueueEmitter)) return;
  uint slot = load_queue(kQueueEmitter, i);
  vec4 origin = load_path(kPathOrigin, slot), direction = load_path(kPathDirection, slot);
  vec4 hit = load_path(kPathHit, slot);
  Interaction it = load_interaction(hit, origin.xyz, direction.xyz);
  vec3 radiance = emitted_radiance(it, -direction.xyz);
  float selection_key = load_path(kPathRadiance, slot).w;
  // Light was sampled at the last vertex that is not null.
  float before = load_volume_path(slot).distance;
  vec3 p = origin.xyz - before * direction.xyz;
  float light_pdf = pdf_light_hit(p, selection_key, it, floatBitsToUint(hit.x), direction.xyz, before + hit.w);
  float weight = found_light_weight(direction.w, light_pdf);
  if (radiance != vec3(0.0)) add_radiance(slot, weight * load_path(kPathBeta, slot).xyz * radiance);
}
