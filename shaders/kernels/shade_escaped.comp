// Adds the environment's radiance to paths that left the scene.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/queues.glsl"
#include "light/light.glsl"
#include "path/mis.glsl"
#include "path/volume_path.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= queue_length(kQueueEscaped)) return;
  uint slot = load_queue(kQueueEscaped, i);
  vec4 direction = load_path(kPathDirection, slot);
  float selection_key = load_path(kPathRadiance, slot).w;
  vec3 p = load_path(kPathOrigin, slot).xyz - load_volume_path(slot).distance * direction.xyz;
  float light_pdf = pdf_light_escaped(p, selection_key, direction.xyz);
  float weight = found_light_weight(direction.w, light_pdf);
  add_radiance(slot, weight * load_path(kPathBeta, slot).xyz * escaped_radiance(direction.xyz));
}
