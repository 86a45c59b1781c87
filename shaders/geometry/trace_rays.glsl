// Traces many rays with few lanes: a lane that has finished its ray takes the next one, so that short rays do not wait
// for long ones. The kernel defines, before it includes this file (and after geometry/bvh.glsl),
//   TraceRay fetch_ray(uint i)           ray i of the dispatch
//   void store_hit(uint i, TraceHit hit)
// and calls trace_rays from all lanes of workgroups of 64, ceil(count / kRaysPerGroup) of them.
// Aila and Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs", section 4.
#ifndef TACHYLITE_GEOMETRY_TRACE_RAYS_GLSL
#define TACHYLITE_GEOMETRY_TRACE_RAYS_GLSL
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "geometry/bvh.glsl"
#include "geometry/trace_settings.glsl"

// Number of lanes of the (full) subgroup; a third of a ballot's time on lavapipe.
uint count_lanes(bool counts) {
  uint n = counts ? 1u : 0u;
  for (uint mask = 1u; mask < gl_SubgroupSize; mask <<= 1u) n += subgroupShuffleXor(n, mask);
  return n;
}

// The rays of this subgroup.
uint rays_per_lane() { return kRaysPerGroup / gl_WorkGroupSize.x; }
uint first_ray() {
  return gl_WorkGroupID.x * kRaysPerGroup + gl_SubgroupID * rays_per_lane() * gl_SubgroupSize;
}

// Rays 0 .. count - 1. All loops end for a whole subgroup at once, and what lives on is carried by them
// (Mesa 22.3.6 confuses values that leave a divergent loop).
void trace_rays(uint count, const bool any) {
  uint next = first_ray();
  uint end = min(next + rays_per_lane() * gl_SubgroupSize, count);
  Traversal s = begin_traversal(TraceRay(vec3(0.0), vec3(1.0), 0.0, kNoHit, kNoHit));
  s.group = 0u;
  uint ray = kNoHit;
  uint idle_lanes = gl_SubgroupSize;
  do {
    bool idle = !is_traversing(s);
    uint rank = subgroupBallotExclusiveBitCount(subgroupBallot(idle));
    if (idle) {
      if (ray != kNoHit) store_hit(ray, s.hit);
      ray = next + rank < end ? next + rank : kNoHit;
      if (ray != kNoHit) s = begin_traversal(fetch_ray(ray));
    }
    next += idle_lanes;
    // While there are rays to take, a quarter of the lanes may wait for them.
    uint enough = next < end ? max(gl_SubgroupSize / 4u, 1u) : gl_SubgroupSize;
    do {
      step_traversal(s, any);
      idle_lanes = count_lanes(!is_traversing(s));
    } while (idle_lanes < enough);
  } while (next < end || idle_lanes < gl_SubgroupSize);
  if (ray != kNoHit) store_hit(ray, s.hit);
  rays_unfinished = rays_unfinished || next < end || is_traversing(s);
}

#endif
