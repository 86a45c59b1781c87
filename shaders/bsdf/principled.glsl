// Mitsuba's `principled` (disney.glsl): diffuse with retro-reflection, sheen, a GGX lobe that is a metal, a tinted
// dielectric or an interface that refracts, and a clearcoat. From behind only that interface is seen.
// Inputs: 0 base_color; 1-2 quad (roughness, anisotropic, metallic, spec_trans); 3-4 quad (spec_tint, sheen,
// sheen_tint, flatness); 5 pair (clearcoat, clearcoat_gloss); 6 constants of interface_from; 7 constants: sampling
// rates (diffuse, specular, clearcoat, unused).
#ifndef TACHYLITE_BSDF_PRINCIPLED_GLSL
#define TACHYLITE_BSDF_PRINCIPLED_GLSL
#include "base/warp.glsl"
#include "bsdf/disney.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"

struct PrincipledBsdf {
  vec3 base_color;
  float roughness, metallic, spec_tint, sheen, sheen_tint, flatness, clearcoat;
  float clearcoat_alpha2;
  float diffuse, transmission;  // (1 - metallic)(1 - spec_trans), (1 - metallic) spec_trans
  Microfacet mf;
  Interface side;
  bool outside;
  vec3 probability;  // of sampling diffuse, specular, clearcoat
};

// Colour of the GGX lobe's reflection; `reflected`: Fresnel of the dielectric at c.
vec3 principled_fresnel(PrincipledBsdf b, float reflected, float c) {
  vec3 f = vec3((1.0 - b.metallic) * (1.0 - b.spec_tint) * reflected) +
           b.metallic * schlick(b.base_color, c, b.side.eta) +
           ((1.0 - b.metallic) * b.spec_tint) * schlick(tint_of(b.base_color) * schlick_r0(b.side.eta), c, b.side.eta);
  f = b.outside ? f : vec3(b.transmission * reflected);
  return reflected > 0.0 ? f : vec3(0.0);  // so Mitsuba, even for metals
}

PrincipledBsdf load_principled(uint leaf, vec3 wo, TexturePoint point) {
  PrincipledBsdf b;
  b.base_color = load_color(leaf, 0u, point);
  vec4 first = load_scalar_quad(leaf, 1u, point), second = load_scalar_quad(leaf, 3u, point);
  vec2 coat = has_material(kMaterialClearcoat) ? load_scalar_pair(leaf, 5u, point) : vec2(0.0);
  float spec_trans = has_material(kMaterialTransmits) ? first.w : 0.0;
  b.roughness = first.x;
  b.metallic = first.z;
  b.spec_tint = second.x;
  b.sheen = second.y;
  b.sheen_tint = second.z;
  b.flatness = second.w;
  b.clearcoat = coat.x;
  b.clearcoat_alpha2 = sqr(mix(0.1, 0.001, coat.y));
  b.diffuse = (1.0 - b.metallic) * (1.0 - spec_trans);
  b.transmission = (1.0 - b.metallic) * spec_trans;
  b.mf = disney_microfacet(first.x, first.y);
  b.outside = wo.z > 0.0;
  b.side = interface_from(load_constants(leaf, 6u), b.outside);

  // Lobes are sampled by estimates of their albedos.
  vec3 rates = load_constants(leaf, 7u).xyz;
  float reflected = fresnel_dielectric(abs(wo.z), b.side.e);
  float specular = mean(principled_fresnel(b, reflected, abs(wo.z))) + b.transmission * (1.0 - reflected);
  vec3 weights = rates * vec3(b.diffuse * mean(b.base_color) + 0.2 * b.sheen * (1.0 - b.metallic), max(specular, 0.1),
                              0.25 * b.clearcoat * mix(schlick_weight(abs(wo.z)), 1.0, 0.04));
  if (!b.outside) weights = vec3(0.0, b.transmission > 0.0 ? 1.0 : 0.0, 0.0);
  float sum = weights.x + weights.y + weights.z;
  b.probability = sum > 0.0 ? weights / sum : vec3(0.0, 1.0, 0.0);
  return b;
}

// GTR1 with alpha^2 = a2 [1/sr] (Burley 2012, eq. 4); the density of half vectors is this times h.z.
float clearcoat_density(float a2, vec3 h) {
  return (a2 - 1.0) * kInvPi / (xlog(a2) * (dot(h.xy, h.xy) + a2 * h.z * h.z));
}
vec3 sample_clearcoat_normal(float a2, vec2 u) {
  float z2 = (1.0 - xexp(xlog(a2) * (1.0 - u.y))) / (1.0 - a2);
  return vec3(safe_sqrt(1.0 - z2) * cos_sin_turns(u.x), safe_sqrt(z2));
}
// Its masking: GGX with alpha = 0.25.
float clearcoat_masking(float z) { return 2.0 * z / (z + sqrt(z * z + 0.0625 * (1.0 - z * z))); }

// The chance of refracting at a microfacet, once the GGX lobe is sampled.
float refraction_chance(PrincipledBsdf b, float reflected) {
  return (b.outside ? b.transmission : 1.0) * (1.0 - reflected);
}

BsdfEval eval_principled(PrincipledBsdf b, vec3 wo_leaf, vec3 wi_leaf) {
  float turn = b.outside ? 1.0 : -1.0;
  vec3 wo = turn * wo_leaf, wi = turn * wi_leaf;
  bool reflects = !has_material(kMaterialTransmits) || wi.z > 0.0;
  vec3 h = wo + (reflects ? 1.0 : b.side.eta) * wi;
  h = h.z < 0.0 ? -h : h;
  float length_h = max(length(h), 1e-30);
  vec3 m = h / length_h;
  float c = dot(wo, m), c_i = dot(wi, m);
  bool facet_visible = c > 0.0 && (reflects ? c_i > 0.0 : c_i < 0.0);
  float reflected = fresnel_dielectric(max(c, 0.0), b.side.e);

  // The GGX lobe, by the density of its normals over solid angle of wi.
  float jacobian = reflects ? 0.25 : max(c, 0.0) * abs(c_i) * sqr(b.side.eta / length_h);
  float density = facet_visible ? jacobian * normal_density(b.mf, m) / projected_area(b.mf, wo) : 0.0;
  float refracts = refraction_chance(b, reflected);
  vec3 color = reflects ? principled_fresnel(b, reflected, c)
                        : sqrt(b.base_color) * (b.transmission * (1.0 - reflected) * sqr(b.side.inv_eta));
  vec3 up = reflects ? wi : -wi;
  vec3 f = color * (density * masking(b.mf, up));
  float pdf = b.probability.y * density * (reflects ? 1.0 - refracts : refracts);

  bool front = b.outside && reflects;
  float lambert = front ? pdf_cosine_hemisphere(wi.z) : 0.0;
  f += b.base_color * (b.diffuse * lambert * disney_diffuse(wo.z, abs(wi.z), c, b.roughness, b.flatness));
  f += disney_sheen(b.base_color, b.sheen, b.sheen_tint, c) * ((1.0 - b.metallic) * kPi * lambert);
  pdf += b.probability.x * lambert;
  if (has_material(kMaterialClearcoat)) {
    float d = front && facet_visible ? clearcoat_density(b.clearcoat_alpha2, m) : 0.0;
    float fresnel = schlick(vec3(0.04), c, b.side.eta).x;
    f += vec3(0.25 * b.clearcoat * fresnel * d * clearcoat_masking(wo.z) * clearcoat_masking(wi.z) * wi.z);
    pdf += b.probability.z * d * m.z / max(4.0 * c, 1e-20);
  }
  bool valid = wo.z > 0.0 && up.z > 0.0 && (b.outside || b.transmission > 0.0);
  return valid ? BsdfEval(f, pdf) : kNoEval;
}

BsdfSample sample_principled(PrincipledBsdf b, vec3 wo_leaf, vec2 u, float u_lobe) {
  float turn = b.outside ? 1.0 : -1.0;
  vec3 wo = turn * wo_leaf;
  vec3 m = sample_visible_ggx(b.mf.alpha, wo, u, 1.0);
  float u_specular = (u_lobe - b.probability.x) / b.probability.y;
  vec3 wi = reflect_about(wo, m);
  bool refracts = false;
  if (has_material(kMaterialTransmits)) {
    float gap;
    float reflected = fresnel_dielectric(max(dot(wo, m), 0.0), b.side.e, gap);
    refracts = u_specular >= 0.0 && u_specular < refraction_chance(b, reflected);
    if (refracts) wi = refract_by_gap(wo, m, gap, b.side.inv_eta);
  }
  if (u_lobe < b.probability.x) wi = sample_cosine_hemisphere(u);
  if (has_material(kMaterialClearcoat) && u_lobe >= b.probability.x + b.probability.y) {
    wi = reflect_about(wo, sample_clearcoat_normal(b.clearcoat_alpha2, u));
    refracts = false;
  }
  BsdfEval eval = eval_principled(b, wo_leaf, turn * wi);
  BsdfSample s = BsdfSample(turn * wi, eval.f / eval.pdf, eval.pdf, refracts ? kLobeTransmission : 0u,
                            refracts ? b.side.eta : 1.0);
  if (!(eval.pdf > 0.0 && (refracts ? wi.z < 0.0 : wi.z > 0.0))) s = absorbed();
  return s;
}

#endif
