// Lat-long environment maps. Texel columns have their centres at (x + 0.5) / W and repeat; texel rows lie on the grid
// theta = pi y / (H - 1), row 0 at the zenith (+y of the map). Radiance is bilinear in (phi, theta).
//
// Sampling: each texel is a tent over its neighbours, in phi and in cos(theta); a texel is drawn with the tent's
// share of the luminance, then a point of the tent. The density is the tents' sum: the bilinear interpolant, in phi
// and cos(theta), of the fourth component of the texels, which the host has normalised to 1/sr. It has no seam and
// no singularity at the poles. MIS compensation (Karlik et al. 2019, "MIS Compensation") is in the texels, too.
#ifndef TACHYLITE_LIGHT_ENVIRONMENT_GLSL
#define TACHYLITE_LIGHT_ENVIRONMENT_GLSL
#include "base/math.glsl"
#include "light/record.glsl"

layout(set = 0, binding = kBindEnvironment) uniform samplerBuffer environment_texels;
layout(set = 0, binding = kBindEnvironmentCdf) uniform samplerBuffer environment_cdf;

vec4 load_environment_texel(uint i) { return texelFetch(environment_texels, int(i)); }
vec4 load_environment_cdf(uint i) { return texelFetch(environment_cdf, int(i)); }

struct EnvironmentMap {
  vec3 x, y, z;         // rows: world -> map
  uint width, height;   // at least 1 and 2
  uint levels_x, levels_y;  // of the tables of a row, and of the rows
};

EnvironmentMap load_environment(uint light) {
  vec4 a = load_light(light + 1u), b = load_light(light + 2u), c = load_light(light + 3u);
  uint levels = floatBitsToUint(c.w);
  return EnvironmentMap(a.xyz, b.xyz, c.xyz, floatBitsToUint(a.w), floatBitsToUint(b.w), levels & 0xffu, levels >> 8u);
}

// Radiance [W/sr/m^2] and density of sample_environment [1/sr] in the map's direction d (unit).
vec4 environment_lookup(EnvironmentMap map, vec3 d) {
  float turns = xatan2(d.x, -d.z) * kInvTwoPi;
  float r2 = d.x * d.x + d.z * d.z;
  bool south = d.y < 0.0;
  float from_pole = xatan2(sqrt(r2), abs(d.y)) * kInvPi;  // in [0, 1/2]

  float x = turns * float(map.width) - 0.5, fx = x - floor(x);
  int width = int(map.width), x0 = int(floor(x));  // in [-W/2 - 1, W/2]
  x0 = x0 < 0 ? x0 + width : x0;
  x0 = clamp(x0, 0, width - 1);
  int x1 = x0 + 1 == width ? 0 : x0 + 1;

  float last = float(map.height - 1u), steps = from_pole * last, y = south ? last - steps : steps;
  int y0 = clamp(int(floor(y)), 0, int(map.height) - 2);
  float fy = clamp(y - float(y0), 0.0, 1.0);

  uint row = uint(y0) * map.width;
  vec4 a0 = load_environment_texel(row + uint(x0)), a1 = load_environment_texel(row + uint(x1));
  vec4 b0 = load_environment_texel(row + map.width + uint(x0)), b1 = load_environment_texel(row + map.width + uint(x1));
  vec4 upper = mix(a0, a1, fx), lower = mix(b0, b1, fx);

  // Of the density: the same row interval in cos(theta). The row's record has sin^2(theta/2) of it and its
  // neighbours, or cos^2 south of the equator.
  vec4 latitudes = load_environment_cdf(uint(y0));
  float h = 0.5 * r2 / (1.0 + abs(d.y));
  if (south != (latitudes.w != 0.0)) h = 1.0 - h;
  float fh = clamp((h - latitudes.y) / (latitudes.z - latitudes.y), 0.0, 1.0);
  return vec4(mix(upper.xyz, lower.xyz, fy), mix(upper.w, lower.w, fh));
}

// Descends a table of `levels` levels over `count` items, which begins at `first`: 4-ary, a row holds the cumulative
// probabilities of its first three children. u is stretched over what was chosen. Monotone: strata stay strata.
uint sample_environment_table(uint first, uint levels, uint count, inout float u) {
  uint item = 0u;
  for (uint level = levels; level > 0u; --level) {
    vec3 c = load_environment_cdf(first + item).xyz;
    uint j = uint(u >= c.x) + uint(u >= c.y) + uint(u >= c.z);
    float lo = j == 0u ? 0.0 : (j == 1u ? c.x : (j == 2u ? c.y : c.z));
    float hi = j == 0u ? c.x : (j == 1u ? c.y : (j == 2u ? c.z : 1.0));
    u = clamp((u - lo) / max(hi - lo, 1e-30), 0.0, 1.0 - kEpsilon);
    // Rows of the levels from the top down: ceil(count / 4^level) each.
    first += (count + (1u << (2u * level)) - 1u) >> (2u * level);
    item = 4u * item + j;
  }
  return min(item, count - 1u);
}

// Direction in the map's frame.
vec3 sample_environment(EnvironmentMap map, vec2 u) {
  uint tables = map.height;
  uint row_size = 0u, rows_size = 0u;
  for (uint level = 1u; level <= map.levels_x; ++level)
    row_size += (map.width + (1u << (2u * level)) - 1u) >> (2u * level);
  for (uint level = 1u; level <= map.levels_y; ++level)
    rows_size += (map.height + (1u << (2u * level)) - 1u) >> (2u * level);
  uint row = sample_environment_table(tables, map.levels_y, map.height, u.y);
  uint column = sample_environment_table(tables + rows_size + row * row_size, map.levels_x, map.width, u.x);

  // A point of the tent in phi, by the inverse of its cumulative distribution.
  float dx = u.x < 0.5 ? sqrt(2.0 * u.x) - 1.0 : 1.0 - sqrt(2.0 - 2.0 * u.x);
  vec2 cs = cos_sin_turns((float(column) + 0.5 + dx) / float(map.width));
  // And in cos(theta), where its two halves differ in width.
  vec4 latitudes = load_environment_cdf(row);
  float a = abs(latitudes.y - latitudes.x), b = abs(latitudes.z - latitudes.y), v = u.y * (a + b);
  bool upper = v < a;
  float t = upper ? sqrt(v / a) : sqrt(max(a + b - v, 0.0) / b);
  float h = mix(upper ? latitudes.x : latitudes.z, latitudes.y, t);
  float cos_theta = 1.0 - 2.0 * h, sin_theta = 2.0 * safe_sqrt(h * (1.0 - h));
  return vec3(cs.y * sin_theta, latitudes.w != 0.0 ? -cos_theta : cos_theta, -cs.x * sin_theta);
}

vec3 world_to_map(EnvironmentMap map, vec3 d) { return vec3(dot(map.x, d), dot(map.y, d), dot(map.z, d)); }
vec3 map_to_world(EnvironmentMap map, vec3 d) { return d.x * map.x + d.y * map.y + d.z * map.z; }

#endif
