// What `principled` and `principledthin` share: Burley 2012, "Physically Based Shading at Disney", and Burley 2015,
// "Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering", as Mitsuba 3 reads them.
#ifndef TACHYLITE_BSDF_DISNEY_GLSL
#define TACHYLITE_BSDF_DISNEY_GLSL
#include "base/color.glsl"
#include "bsdf/microfacet.glsl"

// Roughness and anisotropy to alpha (Burley 2012, section 5.4); Mitsuba's lower limit.
Microfacet disney_microfacet(float roughness, float anisotropic) {
  float aspect = sqrt(1.0 - 0.9 * anisotropic);
  return Microfacet(max(roughness * roughness * vec2(1.0 / aspect, aspect), vec2(1e-3)), true);
}

float schlick_weight(float c) {
  float m = clamp(1.0 - c, 0.0, 1.0);
  return sqr(sqr(m)) * m;
}
// Schlick's approximation; below eta = 1 it takes the cosine on the other side.
vec3 schlick(vec3 r0, float c, float eta) {
  float cos_t = safe_sqrt(1.0 - (1.0 - c * c) / (eta * eta));
  return mix(vec3(schlick_weight(eta > 1.0 ? c : cos_t)), vec3(1.0), r0);
}
float schlick_r0(float eta) { return sqr((eta - 1.0) / (eta + 1.0)); }

vec3 tint_of(vec3 base_color) {
  float y = luminance(base_color);
  return y > 0.0 ? base_color / y : vec3(1.0);
}

// pi f / base_color of diffuse, retro-reflection and, by `flatness`, the flat one of Hanrahan and Krueger. cos_d:
// cosine between half vector and wi.
float disney_diffuse(float cos_o, float cos_i, float cos_d, float roughness, float flatness) {
  float fo = schlick_weight(cos_o), fi = schlick_weight(cos_i);
  float rr = 2.0 * roughness * cos_d * cos_d;
  float lambert = (1.0 - 0.5 * fo) * (1.0 - 0.5 * fi);
  float retro = rr * (fo + fi + fo * fi * (rr - 1.0));
  float fss = mix(1.0, 0.5 * rr, fo) * mix(1.0, 0.5 * rr, fi);
  float flat_part = 1.25 * (fss * (1.0 / (cos_o + cos_i) - 0.5) + 0.5);
  return mix(lambert + retro, flat_part, flatness);
}

vec3 disney_sheen(vec3 base_color, float sheen, float sheen_tint, float cos_d) {
  return sheen * schlick_weight(abs(cos_d)) * mix(vec3(1.0), tint_of(base_color), sheen_tint);
}

#endif
