// How many rays a workgroup of 64 lanes of the trace kernels takes (geometry/trace_rays.glsl). Twice as many gain 1 %,
// but Mesa 22.3.6 ends all loops of an invocation after 65535 iterations: this bounds the steps of a ray to 4000.
#ifndef TACHYLITE_GEOMETRY_TRACE_SETTINGS_GLSL
#define TACHYLITE_GEOMETRY_TRACE_SETTINGS_GLSL
#extension GL_KHR_shader_subgroup_basic : require

// RAYS_PER_GROUP: of a kernel that keeps more of a ray in shared memory.
const uint kFewerRaysPerGroup = 512u;
#ifndef RAYS_PER_GROUP
#define RAYS_PER_GROUP 1024u
#endif
const uint kRaysPerGroup = RAYS_PER_GROUP;
const uint kRaysPerLane = kRaysPerGroup / 64u;

// Where this subgroup's rays begin among those of its workgroup, and how many they are at most.
uint rays_per_subgroup() { return kRaysPerLane * gl_SubgroupSize; }
uint first_ray_in_group() { return gl_SubgroupID * rays_per_subgroup(); }

#endif
