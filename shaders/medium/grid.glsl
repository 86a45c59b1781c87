// Media whose coefficients are grids: delta and ratio tracking with a majorant for each cell of a coarse grid.
#ifndef TACHYLITE_MEDIUM_GRID_GLSL
#define TACHYLITE_MEDIUM_GRID_GLSL
#include "base/math.glsl"
#include "medium/free_flight.glsl"
#include "medium/record.glsl"
#include "shared/sampler.h"

layout(set = 0, binding = kBindGrids) uniform samplerBuffer grids;

// Numbers of a walk: a hash of the path, the segment and the step.
struct WalkRandom {
  uint key, index, segment;
};
vec2 walk_numbers(WalkRandom random, uint step) {
  uvec4 bits = hash_pcg4d(uvec4(random.key, random.index, 0x3c6ef372u + random.segment, step));
  return vec2(min((float(bits.x) + 0.5) * 2.3283064e-10, 1.0 - kEpsilon), unit_float(bits.y));
}

// Indices lie at most a cell outside the grid for `clamp`, anywhere for the others.
ivec3 wrap_voxel(ivec3 i, ivec3 n, uint wrap) {
  ivec3 wrapped = i;
  if (has_medium(kMediaRepeated)) {
    ivec3 twice = 2 * n;
    ivec3 repeated = i - n * ivec3(floor(vec3(i) / vec3(n)));
    ivec3 mirrored = i - twice * ivec3(floor(vec3(i) / vec3(twice)));
    mirrored = min(mirrored, twice - 1 - mirrored);
    wrapped = wrap == kVolumeRepeat ? repeated : (wrap == kVolumeMirror ? mirrored : i);
  }
  return clamp(wrapped, ivec3(0), n - 1);
}

// A volume along a ray: what its values at many points have in common.
struct VolumeRay {
  vec3 o, d;  // in index space; o is the value where the volume is constant
  ivec3 n;
  int channels, first;  // 0 channels: constant
  uint filtering, wrap;
};

// Row of the volume; o, d: in device space.
VolumeRay begin_volume(uint row, vec3 o, vec3 d) {
  vec4 r0 = load_medium(row), r1 = load_medium(row + 1u), r2 = load_medium(row + 2u);
  uvec4 shape = floatBitsToUint(load_medium(row + 3u));
  VolumeRay v;
  v.n = max(ivec3(shape.x & 0xffffu, shape.x >> 16u, shape.y & 0xffffu), ivec3(1));
  v.channels = int((shape.y >> 16u) & 0xffu);
  v.first = int(shape.z);
  v.filtering = (shape.y >> 24u) & 0xfu;
  v.wrap = shape.y >> 28u;
  bool constant = v.channels == 0;
  v.o = constant ? r0.xyz : vec3(dot(r0.xyz, o) + r0.w, dot(r1.xyz, o) + r1.w, dot(r2.xyz, o) + r2.w);
  v.d = vec3(dot(r0.xyz, d), dot(r1.xyz, d), dot(r2.xyz, d));
  return v;
}

// coloured: whether it may have three channels.
vec3 load_voxel(VolumeRay v, int voxel, const bool coloured) {
  int at = v.first + (coloured ? voxel * v.channels : voxel);
  vec3 value = texelFetch(grids, at).xxx;
  if (coloured && v.channels == 3) value.yz = vec2(texelFetch(grids, at + 1).x, texelFetch(grids, at + 2).x);
  return value;
}

vec3 volume_at(VolumeRay v, float t, const bool coloured) {
  vec3 q = clamp(v.o + t * v.d, vec3(-1e6), vec3(1e6));
  ivec3 stride = ivec3(1, v.n.x, v.n.x * v.n.y);
  vec3 base = floor(q - 0.5), f = q - 0.5 - base;
  ivec3 low = wrap_voxel(ivec3(base), v.n, v.wrap) * stride, high = wrap_voxel(ivec3(base) + 1, v.n, v.wrap) * stride;
  vec3 sum = vec3(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    bvec3 upper = bvec3((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
    ivec3 i = mix(low, high, upper);
    vec3 w = mix(1.0 - f, f, upper);
    sum += w.x * w.y * w.z * load_voxel(v, i.x + i.y + i.z, coloured);
  }
  if (has_medium(kMediaNearest) && v.filtering == kVolumeNearest) {
    ivec3 i = wrap_voxel(ivec3(floor(q)), v.n, v.wrap) * stride;
    sum = load_voxel(v, i.x + i.y + i.z, coloured);
  }
  return v.channels == 0 ? v.o : sum;
}

// The part of a ray in the medium's box, as an interval of t in [0, tmax]; begin >= end: none.
vec2 clip_to_box(vec3 low, vec3 high, vec3 o, vec3 d, float tmax) {
  vec3 safe = mix(d, vec3(1e-30), lessThan(abs(d), vec3(1e-30)));
  vec3 a = (low - o) / safe, b = (high - o) / safe;
  vec3 enter = min(a, b), leave = max(a, b);
  return vec2(max(max_component(enter), 0.0), min(min_component(leave), tmax));
}

// A walk along a ray through the cells of the majorants.
struct MajorantWalk {
  float t, end;        // where it is, and where the medium or the segment ends
  float per_t;         // length of the ray's direction
  float majorant;      // of the cell that holds t [1/length]
  vec3 o, inv;         // the ray in units of cells: origin, 1 / direction
  vec3 next;           // t of the next boundary of the cell in each axis; infinite beyond the last one
  ivec3 cell, n;
  int first;           // where the cells begin in kBindGrids
};

MajorantWalk begin_walk(uint medium, vec3 o, vec3 d, float tmax) {
  uint row = medium * kMediumRows;
  vec4 cells = load_medium(row + 1u), low = load_medium(row + 2u), high = load_medium(row + 3u);
  uint n = floatBitsToUint(cells.y);
  vec2 inside = clip_to_box(low.xyz, high.xyz, o, d, tmax);
  MajorantWalk w;
  w.t = inside.x;
  w.end = inside.y;
  w.per_t = length(d);
  w.majorant = 0.0;
  w.n = ivec3(n & 0xffu, (n >> 8u) & 0xffu, (n >> 16u) & 0xffu);
  w.first = int(floatBitsToUint(cells.x));
  vec3 per_length = vec3(w.n) / (high.xyz - low.xyz);
  w.o = (o - low.xyz) * per_length;
  vec3 along = d * per_length;
  w.inv = 1.0 / mix(along, vec3(1e-30), lessThan(abs(along), vec3(1e-30)));
  w.cell = clamp(ivec3(floor(w.o + w.t * along)), ivec3(0), w.n - 1);
  w.next = (vec3(w.cell) + vec3(greaterThan(w.inv, vec3(0.0))) - w.o) * w.inv;
  return w;
}

// Goes on until the majorants add up to the optical depth `depth`: a tentative collision; false at the end of the walk.
bool walk_to_collision(inout MajorantWalk w, float depth) {
  bool collides = false, crossing = w.t < w.end;
  while (crossing) {
    float leave = clamp(min_component(w.next), w.t, w.end);
    w.majorant = texelFetch(grids, w.first + (w.cell.z * w.n.y + w.cell.y) * w.n.x + w.cell.x).x;
    float rate = w.majorant * w.per_t, whole = rate * (leave - w.t);
    collides = depth < whole;
    w.t = collides ? min(w.t + depth / rate, leave) : leave;
    depth -= whole;
    crossing = !collides && leave < w.end;
    bvec3 crosses = lessThanEqual(w.next, vec3(collides ? -infinity() : leave));
    ivec3 cell = w.cell + ivec3(mix(vec3(0.0), sign(w.inv), crosses));
    w.cell = clamp(cell, ivec3(0), w.n - 1);
    vec3 next = (vec3(cell) + vec3(greaterThan(w.inv, vec3(0.0))) - w.o) * w.inv;
    next = mix(next, vec3(infinity()), notEqual(w.cell, cell));
    w.next = mix(w.next, next, crosses);
  }
  return collides;
}

uint max_collisions() { return has_medium(kMediaDense) ? kMaxCollisionsDense : kMaxCollisions; }

// A tentative collision is real with the probability sigma_t / majorant, averaged over the channels in proportion to
// the throughput; both outcomes are weighted by that average (Miller, Georgiev and Jarosz 2019, single-sample balance
// heuristic over the channels): the sum of the throughput never grows. overflow: tracking was cut short.
FreeFlight fly_grid(uint medium, vec3 o, vec3 d, float tmax, vec3 beta, WalkRandom random, inout bool overflow) {
  uint row = medium * kMediumRows;
  float scale = load_medium(row + 2u).w;
  VolumeRay sigma = begin_volume(row + kMediumSigmaRow, o, d);
  MajorantWalk walk = begin_walk(medium, o, d, tmax);
  FreeFlight flight = FreeFlight(false, tmax, beta);
  bool going = walk.t < walk.end;
  uint steps = 0u;
  while (going) {
    vec2 u = walk_numbers(random, steps);
    bool within = walk_to_collision(walk, -xlog1p(-u.x));
    steps += 1u;
    vec3 real = min(scale * volume_at(sigma, walk.t, has_medium(kMediaColouredSigma)) / walk.majorant, vec3(1.0));
    float probability = dot(flight.beta, real) / (flight.beta.x + flight.beta.y + flight.beta.z);
    bool collides = within && u.y < probability;
    vec3 factor = collides ? real / probability : (1.0 - real) / (1.0 - probability);
    flight.beta = within ? flight.beta * factor : flight.beta;
    flight.collides = collides;
    going = within && !collides && steps < max_collisions();
  }
  overflow = overflow || going || steps == max_collisions();
  if (flight.collides) {
    VolumeRay albedo = begin_volume(row + kMediumAlbedoRow, o, d);
    flight.beta *= has_medium(kMediaAlbedoGrids) ? volume_at(albedo, walk.t, true) : albedo.o;
    flight.t = walk.t;
  }
  return flight;
}

// An unbiased estimate of the transmittance up to tmax (d of any length): ratio tracking, Novak, Selle and Jarosz
// 2014, "Residual Ratio Tracking for Estimating Attenuation in Participating Media". Once it is below
// kLeastTransmittance Russian roulette keeps it there or ends the walk.
vec3 transmittance_grid(uint medium, vec3 o, vec3 d, float tmax, WalkRandom random, inout bool overflow) {
  uint row = medium * kMediumRows;
  float scale = load_medium(row + 2u).w;
  VolumeRay sigma = begin_volume(row + kMediumSigmaRow, o, d);
  MajorantWalk walk = begin_walk(medium, o, d, tmax);
  vec3 transmittance = vec3(1.0);
  bool going = walk.t < walk.end;
  uint steps = 0u;
  while (going) {
    vec2 u = walk_numbers(random, steps);
    bool within = walk_to_collision(walk, -xlog1p(-u.x));
    steps += 1u;
    vec3 real = min(scale * volume_at(sigma, walk.t, has_medium(kMediaColouredSigma)) / walk.majorant, vec3(1.0));
    transmittance = within ? transmittance * (1.0 - real) : transmittance;
    float q = max_component(transmittance) / kLeastTransmittance;
    if (q < 1.0) transmittance = u.y < q ? transmittance / q : vec3(0.0);
    going = within && transmittance != vec3(0.0) && steps < max_collisions();
  }
  overflow = overflow || going || steps == max_collisions();
  return transmittance;
}

#endif
