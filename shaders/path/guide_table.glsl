// Sampling by the guide's table (shared/guide.h).
#ifndef TACHYLITE_PATH_GUIDE_TABLE_GLSL
#define TACHYLITE_PATH_GUIDE_TABLE_GLSL
#include "base/math.glsl"
#include "shared/bindings.h"
#include "shared/guide.h"

layout(set = 0, binding = kBindGuide) uniform usamplerBuffer guide_table;

struct GuidedNumbers {
  vec2 u;
  float density;  // w.r.t. area of the square
};

GuidedNumbers guide_numbers(uint cell, vec2 u) {
  vec2 scaled = float(kGuideBins) * u;
  uvec2 bin = min(uvec2(scaled), kGuideBins - 1u);
  vec2 rest = scaled - vec2(bin);
  uvec2 entry = texelFetch(guide_table, int(cell + kGuideBins * bin.y + bin.x)).xy;
  float stay = float(entry.x >> 8u) * exp2(-24.0);
  bool stays = rest.x < stay;
  rest.x = stays ? rest.x / stay : (rest.x - stay) / (1.0 - stay);
  rest = clamp(rest, 0.0, 0.999998);  // the sum with a bin is not to be rounded to the next
  if (!stays) {
    uint other = entry.x & 0xffu;
    bin = uvec2(other % kGuideBins, other / kGuideBins);
    entry = texelFetch(guide_table, int(cell + other)).xy;
  }
  return GuidedNumbers((vec2(bin) + rest) / float(kGuideBins), uintBitsToFloat(entry.y));
}

// The bin of a local direction: sample_cosine_hemisphere undone.
uint guide_bin(vec3 w) {
  vec2 a = abs(w.xy);
  bool wide = a.x > a.y;
  float r = sqrt(w.x * w.x + w.y * w.y);
  float across = 4.0 / kPi * r * xatan2(wide ? a.y : a.x, max(wide ? a.x : a.y, 1e-20));
  // The map of the square has r, signed, on the longer axis, and the angle times its sign on the other.
  vec2 square = wide ? vec2(r, across) : vec2(across, r);
  square = vec2(w.x < 0.0 ? -square.x : square.x, w.y < 0.0 ? -square.y : square.y);
  uvec2 bin = uvec2(clamp((0.5 * square + 0.5) * float(kGuideBins), 0.0, float(kGuideBins) - 1.0));
  return kGuideBins * bin.y + bin.x;
}

// Density of guide_numbers w.r.t. area of the square at those that give the local direction w, above the surface.
float guide_density(uint cell, vec3 w) {
  return w.z > 0.0 ? uintBitsToFloat(texelFetch(guide_table, int(cell + guide_bin(w))).y) : 1.0;
}

#endif
