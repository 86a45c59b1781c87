// Access to the records of shared/light.h.
#ifndef TACHYLITE_LIGHT_RECORD_GLSL
#define TACHYLITE_LIGHT_RECORD_GLSL
#include "base/features.glsl"
#include "shared/bindings.h"
#include "shared/geometry.h"
#include "shared/light.h"

layout(set = 0, binding = kBindLights) uniform samplerBuffer lights;
layout(set = 0, binding = kBindLightTable) uniform usamplerBuffer light_table;

vec4 load_light(uint row) { return texelFetch(lights, int(row)); }

// Rows of a light that was chosen or hit. A kernel that looks at them often defines LIGHT_IN_REGISTERS and calls
// hoist_light once: where there is only one such light, at row 0, it is not loaded again.
#ifdef LIGHT_IN_REGISTERS
vec4 only_light[kLightRows];
void hoist_light() {
  if (light_selection != kSelectSingle) return;
  for (uint row = 0u; row < kLightRows; ++row) only_light[row] = load_light(row);
}
vec4 load_found_light(uint light, uint row) {
  return light_selection == kSelectSingle ? only_light[row] : load_light(light + row);
}
#else
vec4 load_found_light(uint light, uint row) { return load_light(light + row); }
#endif
uvec4 load_light_table(uint row) { return texelFetch(light_table, int(row)); }
uvec4 load_light_table_header() { return load_light_table(0u); }

// A point on a light, seen from p.
struct LightPoint {
  vec3 to;    // point - p
  vec3 n;     // geometric normal there, on the side that emits
  float pdf;  // w.r.t. solid angle at p [1/sr]; 0: nothing was sampled
  vec2 st;    // where on the light: barycentrics, rectangle coordinates, or uv of a curved shape
};

const LightPoint kNoLightPoint = LightPoint(vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, vec2(0.0));

// Density w.r.t. solid angle of a point that was sampled with density 1 / area w.r.t. area.
float pdf_of_area(float area, vec3 to, vec3 n) {
  float d2 = dot(to, to), cosine = abs(dot(n, to));
  return cosine > 0.0 ? d2 * sqrt(d2) / (area * cosine) : 0.0;
}

#endif
