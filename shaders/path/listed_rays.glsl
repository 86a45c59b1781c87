// The rays that a subgroup of a trace kernel takes: the places of a queue that have one (shared/counters.h), put side by
// side in shared memory, for trace_rays.
#ifndef TACHYLITE_PATH_LISTED_RAYS_GLSL
#define TACHYLITE_PATH_LISTED_RAYS_GLSL
#extension GL_KHR_shader_subgroup_shuffle : require
#include "base/queues.glsl"
#include "geometry/trace_settings.glsl"

shared uint listed[kRaysPerGroup];
uint ray_at(uint i) { return listed[i]; }

// The first of the kRaysPerLane neighbouring places that a lane lists.
uint first_place(uint first) {
  return gl_WorkGroupID.x * kRaysPerGroup + first + gl_SubgroupInvocationID * kRaysPerLane;
}

struct RayList {
  uint count;
  uint mask;  // bit k: whether place first_place + k of the lane has a ray
};

// Lists the rays of the queue's places that fall to this subgroup, from listed[first] on.
RayList list_rays(uint queue, uint first) {
  uint begin = first_place(first), places = queue_length(queue);
  RayList list = RayList(0u, 0u);
  [[dont_unroll]] for (uint k = 0u; k < kRaysPerLane; ++k)
    if (begin + k < places && load_queue(queue, begin + k) != kNoPath) list.mask |= 1u << k;
  uint rays = bitCount(list.mask), next = first + subgroupExclusiveAdd(rays);
  list.count = subgroupShuffle(next + rays, gl_SubgroupSize - 1u) - first;
  [[dont_unroll]] for (uint k = 0u; k < kRaysPerLane; ++k) {
    if ((list.mask & 1u << k) != 0u) {
      listed[next] = begin + k;
      next += 1u;
    }
  }
  subgroupMemoryBarrierShared();
  subgroupBarrier();
  return list;
}

// Called by all lanes, in a loop over the places listed from `first` on, for what was read there: lists `place` again if
// it is wanted. left: how many are so far. In order; entries are read before others are written over them.
void keep_listed(bool wanted, uint place, uint first, inout uint left) {
  uvec4 ballot = subgroupBallot(wanted);
  if (wanted) listed[first + left + subgroupBallotExclusiveBitCount(ballot)] = place;
  left += subgroupBallotBitCount(ballot);
}

// Adds the number of a subgroup's rays to a counter.
void count_rays(uint counter, uint count) {
  if (subgroupElect() && count > 0u) atomicAdd(counters[counter], count);
}

#endif
