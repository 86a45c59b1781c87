// Fresnel reflectance of unpolarised light.
#ifndef TACHYLITE_BSDF_FRESNEL_GLSL
#define TACHYLITE_BSDF_FRESNEL_GLSL
#include "base/math.glsl"

// An interface between dielectrics as seen from one side. e is computed on the host in double: near eta = 1 it is
// what counts.
struct Interface {
  float eta;      // index of refraction beyond over that on this side
  float inv_eta;
  float e;        // (eta - 1)(eta + 1)
};

// From the row (eta, 1/eta, eta^2 - 1, 1/eta^2 - 1), eta = inside over outside.
Interface interface_from(vec4 row, bool outside) {
  return outside ? Interface(row.x, row.y, row.z) : Interface(row.y, row.x, row.w);
}

// c >= 0: cosine of the angle of incidence. gap: g - c, where g = eta cos_t; meaningless under total reflection.
// Exact to 7e-7 for eta to 1 + 1e-6, where the usual form with cos_t loses all digits; exactly 0 at eta = 1.
float fresnel_dielectric(float c, float e, out float gap) {
  float g2 = e + c * c;
  float sum = sqrt(max(g2, 0.0)) + c;
  gap = sum > 0.0 ? e / sum : 0.0;
  float a = sum > 0.0 ? gap / sum : 0.0;
  float b = (c * sum - 1.0) / (c * gap + 1.0);
  return g2 > 0.0 ? 0.5 * a * a * (1.0 + b * b) : (e < 0.0 ? 1.0 : 0.0);
}
float fresnel_dielectric(float c, float e) {
  float gap;
  return fresnel_dielectric(c, e, gap);
}

// Direction of the refracted ray: wo on this side of m, dot(wo, m) > 0; gap of fresnel_dielectric(dot(wo, m), e).
vec3 refract_by_gap(vec3 wo, vec3 m, float gap, float inv_eta) { return (-wo - gap * m) * inv_eta; }

// Complex index eta + i k relative to the outside; c >= 0. Born and Wolf 1999, "Principles of Optics", sec. 14.2.
vec3 fresnel_conductor(float c, vec3 eta, vec3 k) {
  float c2 = c * c, s2 = max(1.0 - c2, 0.0);
  vec3 ek2 = 4.0 * eta * eta * k * k;
  vec3 t0 = (eta - k) * (eta + k) - s2;
  vec3 ab = sqrt(t0 * t0 + ek2);  // a^2 + b^2
  // a^2 = (ab + t0) / 2, without cancellation where t0 < 0.
  vec3 near = 0.5 * (ab + t0);
  vec3 far = 0.5 * ek2 / max(ab - t0, vec3(1e-30));
  vec3 a = sqrt(max(vec3(t0.x < 0.0 ? far.x : near.x, t0.y < 0.0 ? far.y : near.y, t0.z < 0.0 ? far.z : near.z),
                    vec3(0.0)));
  vec3 t1 = ab + c2, t2 = 2.0 * c * a;
  vec3 rs = (t1 - t2) / max(t1 + t2, vec3(1e-30));
  vec3 t3 = ab * c2 + s2 * s2, t4 = t2 * s2;
  vec3 rp = rs * (t3 - t4) / max(t3 + t4, vec3(1e-30));
  return 0.5 * (rs + rp);
}

#endif
