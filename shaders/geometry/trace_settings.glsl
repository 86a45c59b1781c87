// How many rays a workgroup of 64 lanes of the trace kernels takes (geometry/trace_rays.glsl). Twice as many gain 1 %,
// but Mesa 22.3.6 ends all loops of an invocation after 65535 iterations: this bounds the steps of a ray to 4000.
#ifndef TACHYLITE_GEOMETRY_TRACE_SETTINGS_GLSL
#define TACHYLITE_GEOMETRY_TRACE_SETTINGS_GLSL
const uint kRaysPerGroup = 1024u;
const uint kRaysPerLane = kRaysPerGroup / 64u;
#endif
