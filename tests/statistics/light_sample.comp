// One call of light/light.glsl an invocation. Inputs and outputs: kRows rows of vec4 an item.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "light/light.glsl"

layout(push_constant) uniform Push { uint count, mode; };
layout(set = 0, binding = 64) readonly buffer Input { vec4 items[]; };
layout(set = 0, binding = 65) writeonly buffer Output { vec4 results[]; };
const uint kRows = 4u;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec4 a = items[kRows * i], b = items[kRows * i + 1u], c = items[kRows * i + 2u], e = items[kRows * i + 3u];
  if (mode == 0u) {
    // In: p, u_select | n, 0 | u, 0, 0
    float key;
    LightSample s = sample_light(a.xyz, b.xyz, c.xy, a.w, key);
    results[kRows * i] = vec4(s.wi, s.pdf);
    results[kRows * i + 1u] = vec4(s.to_light, uintBitsToFloat(s.target));
    results[kRows * i + 2u] = vec4(s.radiance, key);
    results[kRows * i + 3u] = vec4(s.delta ? 1.0 : 0.0, 0.0, 0.0, 0.0);
  } else {
    // In: p, key | d, t | n_s, light row | uv, primitive, 0
    Interaction it;
    it.n_s = c.xyz;
    it.light = floatBitsToUint(c.w);
    it.point = TexturePoint(e.xy, floatBitsToUint(e.z), e.xy);
    float pdf_hit = it.light == kNoIndex ? 0.0 : pdf_light_hit(a.xyz, a.w, it, 0u, b.xyz, b.w);
    vec3 emitted = it.light == kNoIndex ? vec3(0.0) : emitted_radiance(it, -b.xyz);
    results[kRows * i] = vec4(emitted, pdf_hit);
    results[kRows * i + 1u] = vec4(escaped_radiance(b.xyz), pdf_light_escaped(a.xyz, a.w, b.xyz));
  }
}
