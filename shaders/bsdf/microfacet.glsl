// Microfacet distributions: Beckmann and GGX (Trowbridge-Reitz), with Smith masking, after Walter et al. 2007,
// "Microfacet Models for Refraction through Rough Surfaces", and Heitz 2014, "Understanding the Masking-Shadowing
// Function in Microfacet-Based BRDFs". Shadowing and masking are separable, G = G1(wo) G1(wi), as Mitsuba's.
//
// Directions are in the leaf's frame and above the surface (w.z > 0). Forms are chosen for float32: no 1 - z^2 and no
// tangents; what would divide by w.z at grazing angles is expressed through the projected area.
#ifndef TACHYLITE_BSDF_MICROFACET_GLSL
#define TACHYLITE_BSDF_MICROFACET_GLSL
#include "base/features.glsl"
#include "base/math.glsl"

struct Microfacet {
  vec2 alpha;  // along s and t, in [kMinAlpha, ...]
  bool ggx;
};

// Below kSmoothAlpha the rounding of directions blurs more than the roughness: the smooth bsdf takes over.
const float kSmoothAlpha = 2e-5;
const float kMinAlpha = 1e-5;
const float kInvSqrtPi = 0.564189583547756;

bool is_smooth(vec2 alpha) { return has_material(kMaterialDelta) && max(alpha.x, alpha.y) < kSmoothAlpha; }

// options: of the leaf; looked at only where a class has both distributions.
bool is_ggx(uint options) {
  return has_material(kMaterialGgx) && (!has_material(kMaterialBeckmann) || (options & kOptionGgx) != 0u);
}
Microfacet make_microfacet(vec2 alpha, uint options) {
  return Microfacet(max(alpha, vec2(kMinAlpha)), is_ggx(options));
}

// D(m), m.z > 0 [1/sr]: D(m) m.z integrates to 1 over the hemisphere.
float normal_density(Microfacet mf, vec3 m) {
  vec2 slope = m.xy / mf.alpha;
  float r2 = dot(slope, slope), z2 = m.z * m.z;
  float norm = kPi * mf.alpha.x * mf.alpha.y;
  float density;
  if (mf.ggx) density = 1.0 / (norm * sqr(r2 + z2));
  else density = xexp(-r2 / z2) / (norm * z2 * z2);
  return m.z > 1e-10 ? density : 0.0;
}

float stretched_length(Microfacet mf, vec3 w) { return length(vec3(mf.alpha * w.xy, w.z)); }

// Area of the visible facets projected towards w, per area of the surface: w.z (1 + Lambda(w)).
float projected_area(Microfacet mf, vec3 w) {
  if (mf.ggx) return 0.5 * (w.z + stretched_length(mf, w));
  // Lambda = exp(-a^2) (1 / (a sqrt(pi)) - P(a)) / 2 with erfc(a) = P(a) exp(-a^2), a = w.z / r;
  // P: Abramowitz and Stegun 1964, 7.1.26, |error of erfc| < 1.5e-7.
  float r = length(mf.alpha * w.xy);
  float a = min(w.z / max(r, 1e-30), 8.0);
  float t = 1.0 / (1.0 + 0.3275911 * a);
  float p = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
  return w.z + 0.5 * xexp(-a * a) * max(r * kInvSqrtPi - w.z * p, 0.0);
}

// Smith's G1(w).
float masking(Microfacet mf, vec3 w) { return w.z / projected_area(mf, w); }

// Visible GGX normals: Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical
// Caps". bound: 1, or that of bound_of_reflections.
vec3 sample_visible_ggx(vec2 alpha, vec3 wo, vec2 u, float bound) {
  vec3 w = normalize(vec3(alpha * wo.xy, wo.z));
  float t = u.y * (1.0 + bound * w.z);
  float r = sqrt(t * max(2.0 - t, 0.0));
  vec3 h = vec3(r * cos_sin_turns(u.x), 1.0 - t) + w;
  return normalize(vec3(alpha * h.xy, max(h.z, 0.0)));
}

// Visible Beckmann normals: Heitz and d'Eon 2014, "Importance Sampling Microfacet-Based BSDFs using the Distribution
// of Visible Normals", inverted as in Jakob 2014, "An Improved Visible Normal Sampling Routine for the Beckmann
// Distribution": Newton's method on the CDF of the slope along wo, x = erf(slope).
vec3 sample_visible_beckmann(vec2 alpha, vec3 wo, vec2 u) {
  const float limit = 0.9999999;  // erfinv of it is 3.77
  vec2 stretched = alpha * wo.xy;
  float r = length(stretched);
  vec2 azimuth = r > 0.0 ? stretched / r : vec2(1.0, 0.0);
  float cot_o = clamp(wo.z / max(r, 1e-30), 1e-10, 1e10), tan_o = 1.0 / cot_o;
  float x_max = min(xerf(cot_o), limit);
  float u_x = clamp(u.x, 1e-6, 1.0 - 1e-6);
  float target = u_x * (1.0 + x_max + kInvSqrtPi * tan_o * xexp(-cot_o * cot_o));
  // Start from the solution for wo at the horizon.
  float x = clamp(x_max - (x_max + 1.0) * xerf(sqrt(-xlog(u_x))), -limit, x_max);
  for (int i = 0; i < 3; ++i) {
    float slope = xerfinv(x);
    float value = 1.0 + x + kInvSqrtPi * tan_o * xexp(-slope * slope) - target;
    float derivative = max(1.0 - slope * tan_o, 1e-6);
    x = clamp(x - value / derivative, -limit, x_max);
  }
  vec2 slope = vec2(xerfinv(x), xerfinv(clamp(2.0 * u.y - 1.0, -limit, limit)));
  slope = vec2(azimuth.x * slope.x - azimuth.y * slope.y, azimuth.y * slope.x + azimuth.x * slope.y);
  return normalize(vec3(-slope * alpha, 1.0));
}

// A visible normal; its density is D(m) dot(wo, m) / projected_area(wo).
vec3 sample_visible_normal(Microfacet mf, vec3 wo, vec2 u) {
  if (mf.ggx) return sample_visible_ggx(mf.alpha, wo, u, 1.0);
  return sample_visible_beckmann(mf.alpha, wo, u);
}

// Normals for reflection: those that send light below the surface are left out as far as a spherical cap can; Eto and
// Tokuyoshi 2023, "Bounding the Visible Normal Distribution Function for Sampling Microfacet Reflection", eq. 7 and 8.
float bound_of_reflections(Microfacet mf, vec3 wo) {
  float a = min(1.0, min(mf.alpha.x, mf.alpha.y));
  float s = 1.0 + length(wo.xy), a2 = a * a, s2 = s * s;
  return (1.0 - a2) * s2 / (s2 + a2 * wo.z * wo.z);
}

vec3 sample_reflection_normal(Microfacet mf, vec3 wo, vec2 u) {
  if (mf.ggx) return sample_visible_ggx(mf.alpha, wo, u, bound_of_reflections(mf, wo));
  return sample_visible_beckmann(mf.alpha, wo, u);
}
// Density of the reflected direction of sample_reflection_normal, w.r.t. its solid angle, over D(m).
float reflection_pdf_over_density(Microfacet mf, vec3 wo) {
  if (mf.ggx) return 0.5 / (bound_of_reflections(mf, wo) * wo.z + stretched_length(mf, wo));
  return 0.25 / projected_area(mf, wo);
}

// G1(wo) G1(wi) / (4 wo.z): f |cos_wi| of a reflection is this times F D(m).
float reflection_over_density(Microfacet mf, vec3 wo, vec3 wi) {
  return 0.25 * masking(mf, wi) / projected_area(mf, wo);
}

vec3 reflect_about(vec3 wo, vec3 m) { return 2.0 * dot(wo, m) * m - wo; }

#endif
