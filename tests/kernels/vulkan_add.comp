#version 460
#extension GL_GOOGLE_include_directive : require
// sum[i] = a[i] + texel(b, i) + scale; local size and scale by specialization constants.
layout(local_size_x_id = 1) in;
layout(constant_id = 0) const uint kScale = 0u;
layout(push_constant) uniform Push { uint count; uint offset; };
layout(set = 0, binding = 0) readonly buffer A { uint a[]; };
layout(set = 0, binding = 1) uniform usamplerBuffer b;
layout(set = 0, binding = 2) buffer Sum { uint sum[]; };
layout(set = 0, binding = 3) uniform Offset { uint uniform_offset; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < count) sum[i] = sum[i] + a[i] + texelFetch(b, int(i)).x + kScale + offset + uniform_offset;
}
