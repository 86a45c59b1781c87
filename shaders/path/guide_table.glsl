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

// Halves the square at p: where u lies in its half; p becomes the half's probability.
bool choose_half(inout float u, inout float p) {
  bool upper = u >= p;
  if (upper) {
    u -= p;
    p = 1.0 - p;
  }
  u /= p;
  return upper;
}

// table: its first bin.
GuidedNumbers guide_numbers(uint table, vec2 u) {
  uvec2 bin = uvec2(0u);
  uint node = 0u;
  float density = 1.0;
  for (uint level = 0u; level < kGuideLevels; ++level) {
    uvec2 entry = texelFetch(guide_table, int(table + node)).xy;
    vec2 p = vec2(float(entry.x), 0.0) * exp2(-16.0);
    bool right = choose_half(u.x, p.x);
    p.y = float(right ? entry.y >> 16u : entry.y & 0xffffu) * exp2(-16.0);
    bool up = choose_half(u.y, p.y);
    density *= 4.0 * p.x * p.y;
    uvec2 quadrant = uvec2(right ? 1u : 0u, up ? 1u : 0u);
    bin = 2u * bin + quadrant;
    node = 4u * node + 1u + quadrant.x + 2u * quadrant.y;
  }
  u = clamp(u, 0.0, 0.999998);  // the sum with a bin is not to be rounded to the next
  return GuidedNumbers((vec2(bin) + u) / float(kGuideBins), density);
}

uint bin_of_numbers(vec2 u) {
  uvec2 bin = uvec2(clamp(u * float(kGuideBins), 0.0, float(kGuideBins) - 1.0));
  return kGuideBins * bin.y + bin.x;
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
  return bin_of_numbers(0.5 * square + 0.5);
}

// Density of guide_numbers w.r.t. area of the square in a bin.
float table_density(uint table, uint bin) {
  uvec2 pair = texelFetch(guide_table, int(table + kGuideDensities + (bin >> 1u))).xy;
  return uintBitsToFloat((bin & 1u) == 0u ? pair.x : pair.y);
}

// The same at the numbers that give the local direction w, above the surface.
float guide_density(uint table, vec3 w) {
  float density = table_density(table, guide_bin(w));
  return w.z > 0.0 ? density : 1.0;
}

#endif
