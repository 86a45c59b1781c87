// Light that a segment of a path receives from a light without extent.
#ifndef TACHYLITE_PATH_SEGMENT_LIGHT_GLSL
#define TACHYLITE_PATH_SEGMENT_LIGHT_GLSL
#include "light/light.glsl"
#include "medium/equiangular.glsl"

// Chooses a point, spot or projector light by the integral of power / r^2 along the segment. First row of its record;
// u is stretched over [0, 1) again.
uint choose_segment_light(vec3 o, vec3 d, float tmax, inout float u, out float probability) {
  probability = 1.0;
  if (light_selection == kSelectSingle) return 0u;
  uint light = 0u, count = load_light_table_header().x;
  float sum = 0.0, importance = 0.0;
  for (uint i = 0u; i < count; ++i) {
    LightBounds b = load_light_bounds(i);
    SegmentView view = view_segment(o, d, tmax, b.centre);
    float w = b.radius == 0.0 ? b.power * view.angle / view.h : 0.0;  // only these lights have no extent
    sum += w;
    bool take = take_light(w, sum, u);
    light = take ? b.child : light;
    importance = take ? w : importance;
  }
  probability = sum > 0.0 ? importance / sum : 0.0;
  return light;
}

// A point of the segment, its density [1/length], and the light that arrives there.
struct SegmentSample {
  float t, pdf;        // pdf includes the choice of the light; 0: nothing
  vec3 to_light;
  vec3 irradiance;     // of a surface that faces the light [W/m^2]
};

// weights: of the channels for the exponential, sum 1. u: distance; u_choice: light, strategy and channel.
SegmentSample sample_segment(vec3 o, vec3 d, float tmax, vec3 weights, vec3 sigma, float u, float u_choice) {
  SegmentSample s;
  float probability;
  uint light = choose_segment_light(o, d, tmax, u_choice, probability);
  vec4 row0 = load_light(light);
  SegmentView view = view_segment(o, d, tmax, point_light_position(light, row0));
  float equiangular = equiangular_probability(view, dot(weights, sigma));
  if (u_choice < equiangular) {
    s.t = sample_equiangular(view, tmax, u);
  } else {
    u_choice = (u_choice - equiangular) / (1.0 - equiangular);
    float chosen = u_choice < weights.x || weights.y + weights.z == 0.0
                       ? sigma.x
                       : (u_choice < weights.x + weights.y || weights.z == 0.0 ? sigma.y : sigma.z);
    s.t = sample_truncated_exponential(chosen, tmax, u);
  }
  s.pdf = equiangular * pdf_equiangular(view, s.t) +
          (1.0 - equiangular) * pdf_truncated_exponential(weights, sigma, tmax, s.t);
  s.pdf *= probability;
  s.irradiance = point_light_irradiance(light, row0, o + s.t * d, s.to_light);
  if (s.to_light == vec3(0.0)) s.pdf = 0.0;
  return s;
}

#endif
