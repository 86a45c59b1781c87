// Looks a texture up at one point an invocation: colour, luminance in w; gradient of the luminance.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "texture/texture.glsl"

layout(push_constant) uniform Push { uint count, row; };
layout(set = 0, binding = 64) readonly buffer Input { vec4 points[]; };  // uv or barycentrics, triangle (bits), 0
layout(set = 0, binding = 65) writeonly buffer Output { vec4 results[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec4 p = points[i];
  TexturePoint point = TexturePoint(p.xy, floatBitsToUint(p.z), p.xy);
  results[2u * i] = vec4(texture_color(row, point), texture_scalar(row, point));
  results[2u * i + 1u] = vec4(texture_scalar_gradient(row, point), 0.0, 0.0);
}
