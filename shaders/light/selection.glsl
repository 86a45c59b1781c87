// Which light to sample: by importance in a flat loop over a few units, and in a binary tree below one of them when
// there are many (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting";
// bounds of the angles as there, section 4.2). The importance estimates the irradiance at p, whatever the surface's
// normal, so that a later hit finds the same probability from p alone.
#ifndef TACHYLITE_LIGHT_SELECTION_GLSL
#define TACHYLITE_LIGHT_SELECTION_GLSL
#include "base/math.glsl"
#include "light/record.glsl"

struct LightBounds {
  vec3 centre;
  float radius;
  vec3 axis;
  float power;
  float cos_o, sin_o, cos_e;
  uint child;
};

LightBounds load_light_bounds(uint row) {
  vec4 a = uintBitsToFloat(load_light_table(row)), b = uintBitsToFloat(load_light_table(row + 1u));
  uvec4 c = load_light_table(row + 2u);
  return LightBounds(a.xyz, a.w, b.xyz, b.w, uintBitsToFloat(c.x), uintBitsToFloat(c.y), uintBitsToFloat(c.z), c.w);
}

// Estimated irradiance at p [W/m^2]; 0 only where none of the lights inside can shine on p.
float light_importance(LightBounds b, vec3 p) {
  vec3 v = p - b.centre;
  float d2 = dot(v, v), r2 = b.radius * b.radius, inv_d = inversesqrt(max(d2, 1e-36));
  float cosine = clamp(dot(b.axis, v) * inv_d, -1.0, 1.0), sine = safe_sqrt((1.0 - cosine) * (1.0 + cosine));
  // theta - theta_o, at least 0
  bool in_cone = cosine >= b.cos_o;
  float cos1 = in_cone ? 1.0 : cosine * b.cos_o + sine * b.sin_o;
  float sin1 = in_cone ? 0.0 : sine * b.cos_o - cosine * b.sin_o;
  // less theta_u, the angle that the sphere around the lights subtends
  float sin_u = b.radius * inv_d, cos_u = safe_sqrt((1.0 - sin_u) * (1.0 + sin_u));
  bool facing = r2 >= d2 || cos1 >= cos_u;
  float cos2 = facing ? 1.0 : cos1 * cos_u + sin1 * sin_u;
  // A single flat light is invisible from behind its plane, wherever its sphere reaches.
  bool flat_leaf = (b.child & kLightNode) == 0u && b.cos_o == 1.0 && b.cos_e == 0.0;
  bool dark = cos2 <= b.cos_e || (flat_leaf && cosine <= 0.0);
  float finite_light = dark ? 0.0 : b.power * cos2 / max(d2 + r2, 1e-36);
  return b.radius < 0.0 ? b.power : finite_light;
}

// One step of choosing with probability w / (sum of all w): takes the new item or keeps the old one, and stretches
// what is left of u over [0, 1).
bool take_light(float w, float sum, inout float u) {
  float x = u * sum;
  bool take = x < w;
  float rest = take ? w : sum - w;
  u = rest > 0.0 ? min((take ? x : x - w) / rest, 1.0 - kEpsilon) : u;
  return take;
}

// A number in [0, 1) that differs wherever u or v does, in digits that float's u no longer has.
float low_digits(float u, vec2 v) {
  uint x = floatBitsToUint(u) ^ (floatBitsToUint(v.x) * 0x9e3779b9u) ^ (floatBitsToUint(v.y) * 0x85ebca6bu);
  x = (x ^ (x >> 16u)) * 0x7feb352du;
  x = (x ^ (x >> 15u)) * 0x846ca68bu;
  return float((x ^ (x >> 16u)) >> 8u) * kEpsilon;
}

// First row of a light, chosen with `probability` (0: none shines on p). norm: 1 / sum of the units' importances.
uint choose_light(vec3 p, float u, vec2 entropy, out float probability, out float norm) {
  uint count = load_light_table_header().x, chosen = 0u;
  float sum = 0.0, importance = 0.0;
  for (uint i = 0u; i < count; ++i) {
    LightBounds b = load_light_bounds(kLightTableHeaderRows + i * kLightNodeRows);
    float w = light_importance(b, p);
    sum += w;
    bool take = take_light(w, sum, u);
    chosen = take ? b.child : chosen;
    importance = take ? w : importance;
  }
  norm = sum > 0.0 ? 1.0 / sum : 0.0;
  probability = importance * norm;
  if (light_selection == kSelectTree) {
    uint level = 0u;
    while ((chosen & kLightNode) != 0u) {
      // Every few levels u has lost most of its 24 digits to the choice: fill them up.
      if ((level & 7u) == 7u) u = min(u + low_digits(u, entropy) * kEpsilon / probability, 1.0 - kEpsilon);
      uint node = chosen & ~kLightNode;
      LightBounds a = load_light_bounds(node), b = load_light_bounds(node + kLightNodeRows);
      float wa = light_importance(a, p), wb = light_importance(b, p), both = wa + wb;
      bool second = take_light(wb, both, u);
      chosen = both > 0.0 ? (second ? b.child : a.child) : 0u;
      probability *= both > 0.0 ? (second ? wb : wa) / both : 0.0;
      ++level;
    }
  }
  return chosen;
}

// Probability that choose_light finds the light whose row 5 begins with `where` (trail or unit).
float probability_of_light(vec3 p, float norm, uint where) {
  if (light_selection == kSelectLoop) return light_importance(load_light_bounds(where), p) * norm;
  if (light_selection != kSelectTree) return 1.0;
  LightBounds root = load_light_bounds(load_light_table_header().y);
  float probability = light_importance(root, p) * norm;
  uint node = root.child, trail = where;
  while ((node & kLightNode) != 0u) {
    uint row = node & ~kLightNode;
    LightBounds a = load_light_bounds(row), b = load_light_bounds(row + kLightNodeRows);
    float wa = light_importance(a, p), wb = light_importance(b, p), both = wa + wb;
    bool second = (trail & 1u) != 0u;
    probability *= both > 0.0 ? (second ? wb : wa) / both : 0.0;
    node = second ? b.child : a.child;
    trail >>= 1u;
  }
  return probability;
}

#endif
