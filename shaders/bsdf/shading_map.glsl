// Normal and bump maps: a frame for the leaf that is turned against the shading frame, as Mitsuba 3.7's `normalmap`
// and `bumpmap`. The two share Schuessler et al. 2017, "Microfacet-Based Normal Mapping for Robust Monte Carlo Path
// Tracing" (turn normals that face away from wo), and Conty Estevez et al. 2019, "A Microfacet-Based Shadowing
// Function to Solve the Bump Terminator Problem" (eq. 1 to 3). The frame of a map is the shading frame of the map
// inside it; what the surface itself gives (derivatives, geometric normal) stays.
#ifndef TACHYLITE_BSDF_SHADING_MAP_GLSL
#define TACHYLITE_BSDF_SHADING_MAP_GLSL
#include "base/math.glsl"
#include "bsdf/input.glsl"
#include "geometry/interaction.glsl"

struct ShadingMap {
  vec3 n;            // unit, in the shading frame
  vec3 s, t;
  float alpha2;      // of the shadowing function; 0: none
};

// Unit vector along a b with a, b of any length.
vec3 normal_of_tangents(vec3 a, vec3 b) {
  float la = max_component(abs(a)), lb = max_component(abs(b));
  vec3 n = cross(a / max(la, 1e-37), b / max(lb, 1e-37));
  float length2 = dot(n, n);
  return length2 > 0.0 ? n * inversesqrt(length2) : vec3(0.0);
}

// map: kind and options as in a leaf's header; row: of its frame; wo: in the shading frame.
ShadingMap load_shading_map(uint map, uint row, Interaction it, vec3 wo) {
  uvec4 frame = load_material_row(row);
  uint kind = map & 0xffu, options = map >> 8u;
  vec3 n = vec3(0.0, 0.0, 1.0);
  if (kind == kFrameNormalMap) n = 2.0 * input_color(frame.w, it.point) - 1.0;
  if (kind == kFrameBumpMap) {
    vec2 slope = uintBitsToFloat(frame.x) * input_gradient(frame.w, it.point);
    vec3 dp_du = it.dp_du + it.n_s * (slope.x - dot(it.n_s, it.dp_du));
    vec3 dp_dv = it.dp_dv + it.n_s * (slope.y - dot(it.n_s, it.dp_dv));
    vec3 world = normal_of_tangents(dp_du, dp_dv);
    if (dot(it.n_g, world) < 0.0) world = -world;
    n = vec3(dot(it.s, world), dot(it.t, world), dot(it.n_s, world));
  }
  if ((options & kFrameFlipInvalid) != 0u && wo.z * dot(wo, n) <= 0.0) n.xy = -n.xy;
  float length2 = dot(n, n);
  n = length2 > 0.0 ? n * inversesqrt(length2) : vec3(0.0, 0.0, 1.0);
  vec3 s = vec3(1.0, 0.0, 0.0) - n * n.x;
  float s2 = dot(s, s);
  s = s2 > 1e-12 ? s * inversesqrt(s2) : vec3(0.0, 1.0, 0.0);
  float tan2 = dot(n.xy, n.xy) / max(n.z * n.z, 1e-20);
  float alpha2 = (options & kFrameShadowing) != 0u ? min(0.125 * tan2, 1.0) : 0.0;
  return ShadingMap(n, s, cross(n, s), alpha2);
}

// Share of light from the direction whose cosine to the shading normal is c.
float shading_map_shadowing(float alpha2, float c) {
  float c2 = c * c, tan2 = max(1.0 - c2, 0.0) / max(c2, 1e-20);
  return 2.0 / (1.0 + sqrt(1.0 + alpha2 * tan2));
}

#endif
