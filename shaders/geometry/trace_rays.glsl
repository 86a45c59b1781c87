// Traces many rays with few lanes: a lane that has finished its ray takes the next one, so that short rays do not wait
// for long ones. The kernel defines, before it includes this file (and after geometry/bvh.glsl),
//   uint ray_at(uint i)                  its name for ray i
//   Traversal begin_ray(uint ray, const bool any)
//   void end_ray(uint ray, TraceHit hit, const bool any)
// and calls trace_rays from all lanes of workgroups of 64, each subgroup with rays of its own.
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

// Rays next .. end - 1. All loops end for a whole subgroup at once, and what lives on is carried by them
// (Mesa 22.3.6 confuses values that leave a divergent loop).
void trace_rays(uint next, uint end, const bool any) {
  Traversal s = begin_traversal(TraceRay(vec3(0.0), vec3(1.0), 0.0, kNoHit, kNoHit));
  s.group = 0u;
  uint ray = kNoHit;
  uint idle_lanes = gl_SubgroupSize;
  do {
    bool idle = !is_traversing(s);
    uint rank = subgroupBallotExclusiveBitCount(subgroupBallot(idle));
    if (idle) {
      if (ray != kNoHit) end_ray(ray, s.hit, any);
      ray = kNoHit;
      if (next + rank < end) {
        ray = ray_at(next + rank);
        s = begin_ray(ray, any);
      }
    }
    next += idle_lanes;
    // While there are rays to take, a quarter of the lanes may wait for them.
    uint enough = next < end ? max(gl_SubgroupSize / 4u, 1u) : gl_SubgroupSize;
    do {
      step_traversal(s, any);
      idle_lanes = count_lanes(!is_traversing(s));
    } while (idle_lanes < enough);
  } while (next < end || idle_lanes < gl_SubgroupSize);
  if (ray != kNoHit) end_ray(ray, s.hit, any);
  rays_unfinished = rays_unfinished || next < end || is_traversing(s);
}

#endif
