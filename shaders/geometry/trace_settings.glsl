// How many rays a workgroup of the trace kernels takes.
#ifndef TACHYLITE_GEOMETRY_TRACE_SETTINGS_GLSL
#define TACHYLITE_GEOMETRY_TRACE_SETTINGS_GLSL
const uint kPlainRaysPerGroup = 64u;
const uint kRefillRaysPerGroup = 64u;
#endif
