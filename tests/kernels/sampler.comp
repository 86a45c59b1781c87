#version 460
#extension GL_GOOGLE_include_directive : require
// bits[i] = sample_group of keys[i] = (pixel, seed, index, group); the hashes where kSampler is 2.
#include "shared/sampler.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kKind = 0u;
layout(constant_id = 1) const uint kBits = 24u;
layout(push_constant) uniform Push { uint count; };
layout(set = 0, binding = 0) readonly buffer In { uvec4 keys[]; };
layout(set = 0, binding = 1) writeonly buffer Out { uvec4 bits[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const uvec4 key = keys[i];
  if (kKind == 2u)
    bits[i] = uvec4(hash_pcg(key.x), hash_pair(key.x, key.y), floatBitsToUint(unit_float(key.z)),
                    permute_index(key.z, key.x)) + hash_pcg4d(key);
  else
    bits[i] = sample_group(kKind, pixel_key(key.x, key.y), key.z, key.w, kBits);
}
