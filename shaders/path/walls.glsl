// Walls (shared/baked.h): what is large and flat is tested before the tree, for all lanes at once and without loads.
// Many rays then need no tree, and the others none of its root. WALLS: of a scene that has some.
//
// The kernel defines, before it includes this file and geometry/trace_rays.glsl,
//   TraceRay load_ray(uint ray)
//   void finish_ray(uint ray, TraceHit hit)    the last one counts
#ifndef TACHYLITE_PATH_WALLS_GLSL
#define TACHYLITE_PATH_WALLS_GLSL
#include "geometry/bvh.glsl"
#include "path/listed_rays.glsl"
#ifdef WALLS
#define BAKED_COUNT 8
#include "geometry/baked.glsl"

layout(set = 0, binding = kBindBaked) uniform samplerBuffer walls;

// Of a ray that goes on to the tree, by its place in the workgroup: which of the root's slots it meets, and where it
// has met a wall.
shared uint wall_slots[kRaysPerGroup];
shared float wall_distances[kRaysPerGroup];

// The hit on a face of a wall. Faces have no seams: barycentrics are moved into the leaf's triangles.
TraceHit wall_hit(TraceRay ray, uint face, float t) {
  if (face == kNoHit) return TraceHit(kNoHit, 0.0, 0.0, t);
  int row = int(face * kWallRows);
  vec4 a = texelFetch(walls, row), b = texelFetch(walls, row + 1);
  uint id = floatBitsToUint(texelFetch(walls, row + 2).x);
  vec3 p = ray.o + t * ray.d;
  float s = clamp(dot(a.xyz, p) + a.w, 0.0, 1.0), r = clamp(dot(b.xyz, p) + b.w, 0.0, 1.0);
  // v0 + s (v1 - v0) + r (v3 - v0), as a point of (v0, v1, v2) or of (v0, v2, v3).
  return s >= r ? TraceHit(id, s - r, r, t) : TraceHit(id + 1u, s, r - s, t);
}

// Finishes the `count` rays listed from `first` on by what they meet of walls. Returns how many may meet the tree
// before; these are then listed from `first` on.
uint trace_walls(uint first, uint count, const bool any) {
  uvec4 n0 = load_bvh_node(0u), n1 = load_bvh_node(1u);  // the root
  uvec4 n2 = load_bvh_node(2u), n3 = load_bvh_node(3u), n4 = load_bvh_node(4u);
  uint left = 0u;
  for (uint k = 0u; k < count; k += gl_SubgroupSize) {
    uint i = k + gl_SubgroupInvocationID;
    uint place = listed[first + min(i, count - 1u)];
    TraceRay ray = load_ray(place);
    bool goes_on = i < count;
    BakedRay baked = BakedRay(ray.o, ray.d, ray.ignored, ray.ignored_target);
    uint face = kNoHit;
    if (any)
      goes_on = goes_on && !any_baked(baked, ray.tmax);
    else
      face = closest_baked(baked, ray.tmax);
    uint slots = hit_boxes(begin_traversal(ray), n0, n2, n3, n4) & (n0.w >> 24u | n1.w & 0xffu);
    if (any ? goes_on && slots == 0u : goes_on) finish_ray(place, wall_hit(ray, face, ray.tmax));
    goes_on = goes_on && slots != 0u;
    if (goes_on) wall_slots[place % kRaysPerGroup] = slots;
    if (!any && goes_on) wall_distances[place % kRaysPerGroup] = ray.tmax;
    keep_listed(goes_on, place, first, left);
  }
  // Not in the loop, which subgroups leave at different times: entries are read before others are written over them.
  // Hits may be written once more, by other lanes.
  subgroupMemoryBarrier();
  subgroupBarrier();
  return left;
}

Traversal begin_ray(uint place, const bool any) {
  TraceRay ray = load_ray(place);
  if (!any) ray.tmax = wall_distances[place % kRaysPerGroup];
  Traversal s = begin_traversal(ray);
  visit_root(s, wall_slots[place % kRaysPerGroup]);
  return s;
}

void end_ray(uint place, TraceHit hit, const bool any) {
  if (any || hit.id != kNoHit) finish_ray(place, hit);
}
#else
uint trace_walls(uint first, uint count, const bool any) { return count; }
Traversal begin_ray(uint place, const bool any) { return begin_traversal(load_ray(place)); }
void end_ray(uint place, TraceHit hit, const bool any) { finish_ray(place, hit); }
#endif
#endif
