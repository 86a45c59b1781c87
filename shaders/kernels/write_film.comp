// Sums the samples of a block of each pixel, in sample order. One lane a pixel and block.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/features.glsl"
#include "base/queues.glsl"

layout(set = 0, binding = kBindFilm) writeonly restrict buffer Film { vec4 film[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;  // block * pixel_count + pixel
  if (i >= wave.pixel_count * wave.block_count) return;
  vec3 sum = vec3(0.0);
  for (uint s = 0u; s < kBlockSamples; ++s) sum += load_path(kPathRadiance, i * kBlockSamples + s).xyz;
  film[i] = vec4(sum, 0.0);
}
