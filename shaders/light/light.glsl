// Lights: the switch over their kinds. Directions point away from p; all densities are w.r.t. solid angle at p.
#ifndef TACHYLITE_LIGHT_LIGHT_GLSL
#define TACHYLITE_LIGHT_LIGHT_GLSL
#include "base/features.glsl"
#include "base/frame.glsl"
#include "base/math.glsl"
#include "base/warp.glsl"
#include "geometry/interaction.glsl"
#include "light/cylinder.glsl"
#include "light/disk.glsl"
#include "light/environment.glsl"
#include "light/rectangle.glsl"
#include "light/record.glsl"
#include "light/selection.glsl"
#include "light/sphere.glsl"
#include "light/spot.glsl"
#include "light/triangle.glsl"
#include "shared/path_state.h"
#include "texture/texture.glsl"

struct LightSample {
  vec3 wi;        // unit
  vec3 to_light;  // target - p, the unnormalised direction of the shadow ray; wi when the light is infinitely far
  vec3 radiance;  // Le [W/sr/m^2]; of delta lights I / r^2 or the irradiance of a surface that faces them [W/m^2]
  float pdf;      // [1/sr], times the probability of choosing this light; of delta lights only the latter. 0: nothing
  bool delta;
  uint target;    // hit on the light that the shadow ray ignores, kTargetPoint or kTargetInfinite
};

bool is_light(uint kind, uint wanted) { return has_light(wanted) && kind == wanted; }

bool has_framed_lights() { return (light_kinds & (1u << kLightSpot | 1u << kLightProjector)) != 0u; }

// First row of the record of the primitive that was hit.
uint light_of_hit(Interaction it) {
  uint light = it.light;
  if (has_light(kLightTriangles) || has_light(kLightRectangle)) {
    uint word = floatBitsToUint(load_found_light(light, 0u).w), first = floatBitsToUint(load_found_light(light, 5u).x);
    uint offset = (it.point.primitive - first) >> ((word & kLightPairs) != 0u ? 1u : 0u);
    if ((word & kLightKindMask) <= kLightRectangle) light += kLightRows * offset;
  }
  return light;
}

// I / r^2 of a spot or projector. local: from the light to p, in the light's frame; d2: its squared length in device
// space.
vec3 framed_radiance(uint light, uint kind, vec3 intensity, vec3 local, float d2) {
  vec4 profile = load_light(light + 4u), row5 = load_light(light + 5u);
  float falloff = 0.0;
  vec2 uv = vec2(0.0);
  if (is_light(kind, kLightSpot)) {
    falloff = spot_falloff(profile, local) / d2;
    uv = spot_uv(local, row5.y);
  }
  if (is_light(kind, kLightProjector)) {
    uv = projector_uv(local, profile.xy);
    falloff = projector_falloff(local, uv);
  }
  vec3 value = intensity * falloff;
  uint texture_row = floatBitsToUint(row5.x);
  if (has_light_textures && texture_row != kNoTexture && falloff > 0.0)
    value *= texture_color(texture_row, TexturePoint(uv, kNoIndex, vec2(0.0)));
  return value;
}

bool is_framed_light(uint kind) { return is_light(kind, kLightSpot) || is_light(kind, kLightProjector); }

// Of a point, spot or projector light with record `light` and its row 0.
vec3 point_light_position(uint light, vec4 row0) {
  vec4 row1 = load_light(light + 1u);
  if (!has_framed_lights()) return row1.xyz;
  vec3 framed = vec3(row1.w, load_light(light + 2u).w, load_light(light + 3u).w);
  return is_framed_light(floatBitsToUint(row0.w) & kLightKindMask) ? framed : row1.xyz;
}

// The irradiance at p of a surface that faces it [W/m^2]; to: from p to the light.
vec3 point_light_irradiance(uint light, vec4 row0, vec3 p, out vec3 to) {
  uint kind = floatBitsToUint(row0.w) & kLightKindMask;
  bool framed = is_framed_light(kind);
  PointFrame frame = PointFrame(load_light(light + 1u).xyz, vec3(0.0), vec3(0.0), vec3(0.0));
  if (framed) frame = load_point_frame(light);
  to = frame.position - p;
  float d2 = dot(to, to);
  vec3 value = row0.xyz / d2;
  if (framed) value = framed_radiance(light, kind, row0.xyz, to_point_frame(frame, -to), d2);
  return value;
}

// Mitsuba converts area to solid angle by the shading normal n_s; its estimate depends on the density that it weighs
// against the bsdf's, and its images are the standard. density: row 2, w of the corners; to: from p to the light.
float pdf_smooth_light(float density, vec3 n_s, vec3 to) {
  float d2 = dot(to, to);
  return density * d2 * sqrt(d2) / max(abs(dot(n_s, to)), 1e-30);
}

// Radiance of an area light, chosen with that probability, from one of its points towards -wi. row4, row5: of the
// light. Of smooth lights the density becomes that of pdf_smooth_light, and the radiance makes up for it.
vec3 sampled_radiance(vec3 le, uint kind, uint flags, uint texture_row, vec4 row4, vec4 row5, vec3 wi,
                      float probability, inout LightPoint point) {
  vec3 n = point.n;
  float smooth_scale = 1.0;
  TexturePoint where = TexturePoint(point.st, floatBitsToUint(row5.x), point.st);
  uint corners = floatBitsToUint(row5.z);
  bool flat_shape = is_light(kind, kLightTriangles) || is_light(kind, kLightRectangle);
  if (has_light_textures && flat_shape && corners != kNoIndex) {
    vec4 a = load_light(corners), b = load_light(corners + 1u);
    where.uv = a.xy + point.st.x * (a.zw - a.xy) + point.st.y * (b.xy - a.xy);
  }
  if (has_light(kLightsSmooth) && flat_shape && (flags & kLightSmooth) != 0u) {
    vec4 n0 = load_light(corners + 2u);
    n = normalize((1.0 - point.st.x - point.st.y) * n0.xyz + point.st.x * load_light(corners + 3u).xyz +
                  point.st.y * load_light(corners + 4u).xyz);
    float density = n0.w / probability;
    smooth_scale = row4.w * density;
    point.pdf = pdf_smooth_light(density, n, point.to);
  }
  if (has_light_textures && is_light(kind, kLightDisk)) {
    float phi = xatan2(point.st.y, point.st.x) * kInvTwoPi;
    where.uv = vec2(length(point.st), phi < 0.0 ? phi + 1.0 : phi);
  }
  if (has_light_textures && texture_row != kNoTexture) le = texture_color(texture_row, where);
  return dot(n, wi) < 0.0 ? smooth_scale * le : vec3(0.0);
}

// n: shading normal at p, on the side that light may come from; zero where it may come from all sides: in media, on
// surfaces that transmit or whose frame is bumped. selection_key: what a hit of the next ray must know of n.
LightSample sample_light(vec3 p, vec3 n, vec2 u, float u_select, out float selection_key) {
  float probability = 1.0;
  uint light = 0u;
  selection_key = 0.0;
  if (light_selection == kSelectLoop || light_selection == kSelectTree) {
    uint packed_normal = pack_normal(n);
    selection_key = uintBitsToFloat(packed_normal);
    light = choose_light(Receiver(p, unpack_normal(packed_normal)), u_select, u, probability);
  }

  vec4 row0 = load_found_light(light, 0u);
  uint kind = floatBitsToUint(row0.w) & kLightKindMask, flags = floatBitsToUint(row0.w);
  LightSample s = LightSample(vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, false, kTargetInfinite);

  if (has_area_light()) {
    vec4 row1 = load_found_light(light, 1u), row2 = load_found_light(light, 2u), row3 = load_found_light(light, 3u);
    vec4 row4 = load_found_light(light, 4u), row5 = load_found_light(light, 5u);
    vec3 v0 = row1.xyz - p;
    uint hit = floatBitsToUint(row1.w);
    LightPoint point = kNoLightPoint;
    if (is_light(kind, kLightTriangles)) point = sample_triangle(v0, row2.xyz, row3.xyz, row4.xyz, row4.w, u);
    if (is_light(kind, kLightRectangle)) {
      RectangleView view = view_rectangle(v0, row2.xyz, row3.xyz, row4.xyz);
      point = sample_rectangle(view, v0, row2.xyz, row3.xyz, row4.xyz, row4.w, u);
      hit = point.st.x + point.st.y < 1.0 ? hit : floatBitsToUint(row3.w);
    }
    if (is_light(kind, kLightSphere)) {
      point = sample_sphere(v0, row2.x, row2.y != 0.0, u);
      if (has_light_textures) point.st = sphere_uv(row3, row4.xyz, point.to - v0);
    }
    if (is_light(kind, kLightDisk)) point = sample_disk(v0, row2.xyz, row3.xyz, row4.xyz, row4.w, u);
    if (is_light(kind, kLightCylinder)) {
      bool inward = row3.w != 0.0;
      point = sample_cylinder(view_cylinder(v0, row2.xyz, row3.xyz, row4.xyz, inward), inward, u);
    }
    float d2 = dot(point.to, point.to);
    if (kind <= kLightCylinder && point.pdf > 0.0 && d2 > 0.0) {
      s.wi = point.to * inversesqrt(d2);
      s.to_light = point.to;
      s.radiance =
          sampled_radiance(row0.xyz, kind, flags, floatBitsToUint(row2.w), row4, row5, s.wi, probability, point);
      s.pdf = point.pdf;
      s.target = hit;
    }
  }
  if (has_light(kLightPoint) || has_framed_lights()) {
    vec3 to;
    vec3 value = point_light_irradiance(light, row0, p, to);
    float d2 = dot(to, to);
    if (is_framed_light(kind) || is_light(kind, kLightPoint)) {
      s.wi = to * inversesqrt(d2);
      s.to_light = to;
      s.radiance = value;
      s.pdf = d2 > 0.0 ? 1.0 : 0.0;
      s.delta = true;
      s.target = kTargetPoint;
    }
  }
  if (is_light(kind, kLightDirectional)) {
    s.wi = load_light(light + 1u).xyz;
    s.radiance = row0.xyz;
    s.pdf = 1.0;
    s.delta = true;
  }
  if (has_light(kLightsSampledConstant) && is_light(kind, kLightConstant)) {
    bool surface = n != vec3(0.0);
    vec3 local = surface ? sample_cosine_hemisphere(u) : sample_uniform_sphere(u);
    s.pdf = surface ? pdf_cosine_hemisphere(local.z) : pdf_uniform_sphere();
    s.wi = to_world(frame_from_normal(surface ? n : vec3(0.0, 0.0, 1.0)), local);
    s.radiance = row0.xyz;
  }
  if (is_light(kind, kLightEnvironment)) {
    EnvironmentMap map = load_environment(light);
    vec3 local = sample_environment(map, u);
    vec4 value = environment_lookup(map, local);
    s.wi = map_to_world(map, local);
    s.radiance = value.xyz;
    s.pdf = value.w;
  }
  if (s.target == kTargetInfinite) s.to_light = s.wi;
  s.pdf *= probability;
  return s;
}

Receiver receiver(vec3 p, float selection_key) { return Receiver(p, unpack_normal(floatBitsToUint(selection_key))); }

// Density of sample_light at p, which gave selection_key, for the direction d (unit) in which a ray from p hit the
// light of `it` after t, at hit_id. Of smooth lights that of pdf_smooth_light.
float pdf_light_hit(vec3 p, float selection_key, Interaction it, uint hit_id, vec3 d, float t) {
  uint light = light_of_hit(it);
  vec4 row0 = load_found_light(light, 0u), row1 = load_found_light(light, 1u), row2 = load_found_light(light, 2u);
  vec4 row3 = load_found_light(light, 3u), row4 = load_found_light(light, 4u), row5 = load_found_light(light, 5u);
  uint kind = floatBitsToUint(row0.w) & kLightKindMask;
  vec3 v0 = row1.xyz - p, to = t * d;
  float pdf = 0.0;
  if (is_light(kind, kLightTriangles)) pdf = pdf_triangle(row4.xyz, row4.w, to);
  if (is_light(kind, kLightRectangle))
    pdf = pdf_rectangle(view_rectangle(v0, row2.xyz, row3.xyz, row4.xyz), row4.w, to);
  if (is_light(kind, kLightSphere)) pdf = pdf_sphere(v0, row2.x, row2.y != 0.0);
  if (is_light(kind, kLightDisk)) pdf = pdf_of_area(row4.w, to, row4.xyz);
  if (is_light(kind, kLightCylinder))
    pdf = pdf_cylinder_hit(view_cylinder(v0, row2.xyz, row3.xyz, row4.xyz, row3.w != 0.0), to);
  pdf *= probability_of_light(receiver(p, selection_key), floatBitsToUint(row5.yw));
  if (has_light(kLightsSmooth) && (floatBitsToUint(row0.w) & kLightSmooth) != 0u)
    pdf = pdf_smooth_light(load_light(floatBitsToUint(row5.z) + 2u).w, it.n_s, to);
  return pdf;
}

// Density of sample_light at p for the direction d (unit) of a ray that escaped. 0 where the environment is not
// among the lights that are sampled.
float pdf_light_escaped(vec3 p, float selection_key, vec3 d) {
  float pdf = 0.0;
  if (has_light(kLightEnvironment)) {
    uvec4 header = load_light_table_header();
    EnvironmentMap map = load_environment(header.z);
    pdf = environment_lookup(map, world_to_map(map, d)).w;
    pdf *= probability_of_environment(receiver(p, selection_key), header.x, uintBitsToFloat(header.w));
  }
  return pdf;
}

// Le of the light that was hit, towards wo (unit, away from the light): on the side of its shading normal.
vec3 emitted_radiance(Interaction it, vec3 wo) {
  uint light = light_of_hit(it);
  vec3 le = load_found_light(light, 0u).xyz;
  if (has_light_textures) {
    uint texture_row = floatBitsToUint(load_found_light(light, 2u).w);
    if (texture_row != kNoTexture) le = texture_color(texture_row, it.point);
  }
  return dot(it.n_s, wo) > 0.0 ? le : vec3(0.0);
}

// Radiance of the environment in direction d (unit).
vec3 escaped_radiance(vec3 d) {
  vec3 radiance = vec3(0.0);
  uint light = load_light_table_header().z;
  if (has_light(kLightConstant)) radiance = load_light(light).xyz;
  if (has_light(kLightEnvironment)) {
    EnvironmentMap map = load_environment(light);
    radiance = environment_lookup(map, world_to_map(map, d)).xyz;
  }
  return radiance;
}

#endif
