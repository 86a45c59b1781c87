// Where along a ray through a homogeneous medium light of a point is scattered: distances for Kulla and Fajardo 2012,
// "Importance Sampling Techniques for Path Tracing in Participating Media", section 3: equiangular, mixed with the
// exponential cut off at the end of the segment. Densities are w.r.t. distance [1/length].
#ifndef TACHYLITE_MEDIUM_EQUIANGULAR_GLSL
#define TACHYLITE_MEDIUM_EQUIANGULAR_GLSL
#include "base/math.glsl"
#include "base/warp.glsl"

// A segment o + t d, 0 <= t <= tmax (d unit, tmax > 0, perhaps infinite), as the light sees it.
struct SegmentView {
  float h;      // distance of the light from the line, not below a millionth of its distance from o: any h gives a density
  float at;     // t of the point next to the light
  float angle;  // under which the light sees the segment
};

SegmentView view_segment(vec3 o, vec3 d, float tmax, vec3 light) {
  SegmentView view;
  vec3 to = light - o;
  view.at = dot(to, d);
  view.h = max(length(to - view.at * d), max(1e-6 * length(to), 1e-18));
  // Kulla and Fajardo's difference of two angles would cancel.
  view.angle = xatan2(view.h, (view.h * view.h + view.at * view.at) / tmax - view.at);
  return view;
}

float sample_equiangular(SegmentView view, float tmax, float u) {
  float r2 = view.h * view.h + view.at * view.at;
  vec2 turned = cos_sin_turns(u * view.angle * kInvTwoPi);
  float below = view.h * turned.x + view.at * turned.y;
  return min(r2 * turned.y / max(below, 1e-9 * sqrt(r2)), tmax);
}

float pdf_equiangular(SegmentView view, float t) {
  return view.h / (view.angle * (view.h * view.h + sqr(t - view.at)));
}

// How often the equiangular distance is taken: near the light, in free paths, its 1 / r^2 matters, far from it the
// transmittance. Among constants and powers of 1 / (1 + sigma h) this was the best or close to it over sigma h from
// 2e-4 to 25 in the variance of single scattering by quadrature.
float equiangular_probability(SegmentView view, float sigma) { return clamp(1.0 / (1.0 + sqr(sigma * view.h)), 0.05, 0.98); }

// Probability of a collision before tmax: the exponential's norm. sigma > 0.
float collision_probability(float sigma, float tmax) { return -xexpm1(-sigma * tmax); }

float sample_truncated_exponential(float sigma, float tmax, float u) {
  return min(-xlog1p(-u * collision_probability(sigma, tmax)) / sigma, tmax);
}

// The exponential's density, one channel chosen in proportion to the weights (sum 1; 0 where sigma is 0).
float pdf_truncated_exponential(vec3 weights, vec3 sigma, float tmax, float t) {
  float pdf = 0.0;
  for (int c = 0; c < 3; ++c) {
    float norm = collision_probability(sigma[c], tmax);
    if (weights[c] > 0.0 && norm > 0.0) pdf += weights[c] * sigma[c] * xexp(-sigma[c] * t) / norm;
  }
  return pdf;
}

#endif
