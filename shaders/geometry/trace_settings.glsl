// How many rays the kernels take that trace or list them, each workgroup of 64 lanes.
#ifndef TACHYLITE_GEOMETRY_TRACE_SETTINGS_GLSL
#define TACHYLITE_GEOMETRY_TRACE_SETTINGS_GLSL
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#include "base/features.glsl"
#include "shared/medium.h"

// Twice as many gain 1 %, but Mesa 22.3.6 ends all loops of an invocation after 65535 iterations: this bounds the steps
// of a ray to 4000 (geometry/trace_rays.glsl).
const uint kTracedPerGroup = 64u * 16u;
// Of kernels that walk through grids (WALKS_GRIDS).
const uint kWalkedPerGroup = 64u * ((media_kinds & kMediaDense) != 0u ? 1u : kWalksPerLane);

#ifdef WALKS_GRIDS
const uint kRaysPerGroup = kWalkedPerGroup;
#else
const uint kRaysPerGroup = kTracedPerGroup;
#endif
// Loops over a lane's rays are not to be unrolled: Mesa 25.0.7 needs two seconds for that, once, and gains nothing.
const uint kRaysPerLane = kRaysPerGroup / 64u;

// Where this subgroup's rays begin among those of its workgroup, and how many they are at most.
uint rays_per_subgroup() { return kRaysPerLane * gl_SubgroupSize; }
uint first_ray_in_group() { return gl_SubgroupID * rays_per_subgroup(); }

#endif
