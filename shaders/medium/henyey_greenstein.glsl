// Henyey and Greenstein 1941, "Diffuse radiation in the galaxy". With cos = dot(d, wi), d and wi directions of travel
// before and after: p = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)); g > 0 scatters forward, |g| < 1.
//
// Forms of our own without cancellation: in 1 - cos instead of cos, about the axis where the lobe is (a = d for
// g >= 0, -d else), with |g|. Relative error 3e-7 up to |g| = 0.9999, where the textbook's sample is wrong by 1e-2 and
// its density by a factor.
#ifndef TACHYLITE_MEDIUM_HENYEY_GREENSTEIN_GLSL
#define TACHYLITE_MEDIUM_HENYEY_GREENSTEIN_GLSL
#include "base/frame.glsl"
#include "base/math.glsl"

/// W.r.t. solid angle of wi [1/sr]. d, wi: unit.
float pdf_henyey_greenstein(float g, vec3 d, vec3 wi) {
  float a = abs(g);
  vec3 off_axis = g < 0.0 ? wi + d : wi - d;
  float q = (1.0 - a) * (1.0 - a) + a * dot(off_axis, off_axis);  // 1 - cos = |off_axis|^2 / 2
  return (1.0 - a) * (1.0 + a) * kInvFourPi / (q * sqrt(q));
}

/// Inverse CDF: with D = 1 - |g| + 2 |g| u,
///   1 - cos = 2 (1 - |g|)^2 (1 - u) (1 + |g| u) / D^2,
///   1 + cos = 2 (1 + |g|)^2 u (1 - |g| (1 - u)) / D^2.
vec3 sample_henyey_greenstein(float g, vec3 d, vec2 u) {
  float a = abs(g), v = 1.0 - u.x;
  float inv = 1.0 / (1.0 - a + 2.0 * a * u.x);
  float forward = u.x * (1.0 - a * v), backward = v * (1.0 + a * u.x);
  float below = (1.0 - a) * inv, above = (1.0 + a) * inv;
  float one_minus_cos = 2.0 * below * below * backward;
  float cosine = u.x < 0.5 ? 2.0 * above * above * forward - 1.0 : 1.0 - one_minus_cos;
  float sine = 2.0 * below * above * sqrt(max(forward * backward, 0.0));
  vec3 local = vec3(sine * cos_sin_turns(u.y), cosine);
  // Normalised: over thousands of collisions the length would drift.
  return normalize(to_world(frame_from_normal(g < 0.0 ? -d : d), local));
}

#endif
