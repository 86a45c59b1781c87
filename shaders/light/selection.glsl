// Which light to sample: by importance among a few units at the top, and below them through nodes of up to eight
// children when there are many lights. Bounds of angles: Conty Estevez and Kulla 2018, "Importance Sampling of Many
// Lights with Adaptive Tree Splitting", section 4.2; but they only say where the importance is 0. Its value has the
// cosines at the group's centre, with a floor: the conservative ones had 2 to 4 times the variance in fields of
// 1,000 to 20,000 lights, and nodes of two children 1.5 to 2 times that of eight at two thirds of the cost.
#ifndef TACHYLITE_LIGHT_SELECTION_GLSL
#define TACHYLITE_LIGHT_SELECTION_GLSL
#include "base/math.glsl"
#include "light/record.glsl"

// Where lights are chosen from: a point, and the normal of the side that light may come from (0: from all sides).
struct Receiver {
  vec3 p, n;
};

// A normal in one word, octahedral: what a path keeps of it for the density of a later hit (Cigolle et al. 2014, "A
// Survey of Efficient Representations for Independent Unit Vectors"). Off by 1e-4 at most. 0: no normal.
uint pack_normal(vec3 n) {
  vec2 q = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  if (n.z < 0.0) q = (1.0 - abs(q.yx)) * vec2(q.x < 0.0 ? -1.0 : 1.0, q.y < 0.0 ? -1.0 : 1.0);
  uvec2 i = uvec2(clamp(q * 32767.0 + 32768.5, 1.0, 65535.0));
  return n == vec3(0.0) ? 0u : i.x | i.y << 16u;
}
vec3 unpack_normal(uint word) {
  vec2 q = (vec2(word & 0xffffu, word >> 16u) - 32768.0) / 32767.0;
  vec3 n = vec3(q, 1.0 - abs(q.x) - abs(q.y));
  float t = max(-n.z, 0.0);
  n.xy -= t * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return word == 0u ? vec3(0.0) : normalize(n);
}
// More than the cosine that packing a normal may cost.
const float kPackedNormalError = 2e-4;

struct LightBounds {
  vec3 centre;
  float radius;
  vec3 axis;
  float power;
  float cos_o, sin_o, cos_e;
  uint child;
};

LightBounds load_light_bounds(uint index) {
  uint row = kLightTableHeaderRows + kLightNodeRows * index;
  vec4 a = uintBitsToFloat(load_light_table(row)), b = uintBitsToFloat(load_light_table(row + 1u));
  uvec4 c = load_light_table(row + 2u);
  return LightBounds(a.xyz, a.w, b.xyz, b.w, uintBitsToFloat(c.x), uintBitsToFloat(c.y), uintBitsToFloat(c.z), c.w);
}

// Estimated irradiance [W/m^2]; 0 only where none of the lights inside can shine on the receiver.
float light_importance(LightBounds b, Receiver at) {
  const float floor_of_cosines = 0.05;
  vec3 v = at.p - b.centre;
  float d2 = dot(v, v), r2 = b.radius * b.radius, inv_d = inversesqrt(max(d2, 1e-36));
  float sin_u = b.radius * inv_d, cos_u = safe_sqrt((1.0 - sin_u) * (1.0 + sin_u));  // of the sphere around the lights
  bool around = r2 >= d2;

  // theta - theta_o, at least 0; and the largest cosine that some light inside may have.
  float cosine = clamp(dot(b.axis, v) * inv_d, -1.0, 1.0), sine = safe_sqrt((1.0 - cosine) * (1.0 + cosine));
  bool in_cone = cosine >= b.cos_o;
  float cos1 = in_cone ? 1.0 : cosine * b.cos_o + sine * b.sin_o;
  float sin1 = in_cone ? 0.0 : sine * b.cos_o - cosine * b.sin_o;
  float most = around || cos1 >= cos_u ? 1.0 : cos1 * cos_u + sin1 * sin_u;
  // A single flat light is invisible from behind its plane, wherever its sphere reaches.
  bool leaf = (b.child & kLightNode) == 0u, flat_leaf = leaf && b.cos_o == 1.0 && b.cos_e == 0.0;
  bool dark = most <= b.cos_e || (flat_leaf && cosine <= 0.0);
  // The centre speaks for a leaf only from afar.
  float emitted = max(leaf ? mix(cos1, most, min(r2 * inv_d * inv_d, 1.0)) : cos1, floor_of_cosines);

  // The same of the receiver.
  bool sided = at.n != vec3(0.0);
  float cos_r = -dot(at.n, v) * inv_d, sin_r = safe_sqrt((1.0 - cos_r) * (1.0 + cos_r));
  float most_r = around || cos_r >= cos_u ? 1.0 : cos_r * cos_u + sin_r * sin_u;
  dark = dark || (sided && most_r <= -kPackedNormalError);
  float received = sided ? max(leaf ? mix(cos_r, most_r, min(r2 * inv_d * inv_d, 1.0)) : cos_r, floor_of_cosines) : 1.0;

  float finite_light = dark ? 0.0 : b.power * emitted * received / max(d2 + 0.5 * r2, 1e-36);
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

uint node_first(uint node) { return node & kLightNodeFirstMask; }
uint node_count(uint node) { return ((node >> kLightNodeCountShift) & (kLightNodeWidth - 1u)) + 1u; }

// Chooses among children [first, first + count); multiplies `probability`. Returns the child word, 0 if all are dark.
uint choose_child(Receiver at, uint first, uint count, inout float u, inout float probability) {
  uint chosen = 0u;
  float sum = 0.0, importance = 0.0;
  for (uint i = 0u; i < count; ++i) {
    LightBounds b = load_light_bounds(first + i);
    float w = light_importance(b, at);
    sum += w;
    bool take = take_light(w, sum, u);
    chosen = take ? b.child : chosen;
    importance = take ? w : importance;
  }
  probability *= sum > 0.0 ? importance / sum : 0.0;
  return chosen;
}

// Probability of child number `index`, and its word.
float probability_of_child(Receiver at, uint first, uint count, uint index, out uint child) {
  float sum = 0.0, importance = 0.0;
  child = 0u;
  for (uint i = 0u; i < count; ++i) {
    LightBounds b = load_light_bounds(first + i);
    float w = light_importance(b, at);
    sum += w;
    importance = i == index ? w : importance;
    child = i == index ? b.child : child;
  }
  return sum > 0.0 ? importance / sum : 0.0;
}

// First row of a light, chosen with `probability` (0: none shines on the receiver).
uint choose_light(Receiver at, float u, vec2 entropy, out float probability) {
  probability = 1.0;
  uint chosen = choose_child(at, 0u, load_light_table_header().x, u, probability);
  if (light_selection == kSelectTree) {
    uint level = 0u;
    while ((chosen & kLightNode) != 0u) {
      // Every few levels u has lost most of its 24 digits to the choice: fill them up.
      if ((level & 1u) == 1u) u = min(u + low_digits(u, entropy) * kEpsilon / max(probability, kEpsilon), 1.0 - kEpsilon);
      chosen = choose_child(at, node_first(chosen), node_count(chosen), u, probability);
      ++level;
    }
  }
  return chosen;
}

// Probability that choose_light finds the light whose row 5 says `where` (its words y and w).
float probability_of_light(Receiver at, uvec2 where) {
  if (light_selection != kSelectLoop && light_selection != kSelectTree) return 1.0;
  uint node, unit = where.x & 0xffu, trail = where.x >> 8u, levels = 0u;
  float probability = probability_of_child(at, 0u, load_light_table_header().x, unit, node);
  if (light_selection == kSelectTree) {
    while ((node & kLightNode) != 0u) {
      uint child;
      probability *= probability_of_child(at, node_first(node), node_count(node), trail & 7u, child);
      node = child;
      ++levels;
      trail = levels == 8u ? where.y : trail >> 3u;
    }
  }
  return probability;
}

// Probability that choose_light finds the environment.
float probability_of_environment(Receiver at, uint count, float importance) {
  if (light_selection != kSelectLoop && light_selection != kSelectTree) return 1.0;
  float sum = 0.0;
  for (uint i = 0u; i < count; ++i) sum += light_importance(load_light_bounds(i), at);
  return importance / sum;
}

#endif
