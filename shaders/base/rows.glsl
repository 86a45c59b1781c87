// Rows: four words of a storage buffer. Kernels that store or read many have variants with WIDE_ROWS, for devices with
// integers of 64 bits, whose rows are two of these: lavapipe accesses a vector component by component, lane by lane.
#ifndef TACHYLITE_BASE_ROWS_GLSL
#define TACHYLITE_BASE_ROWS_GLSL
#include "base/features.glsl"

#ifdef WIDE_ROWS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define ROW u64vec2
#define ROW_PAIR u64vec4
u64vec2 pack_row(vec4 v) { return u64vec2(packUint2x32(floatBitsToUint(v.xy)), packUint2x32(floatBitsToUint(v.zw))); }
u64vec4 pack_rows(vec4 v, vec4 w) { return u64vec4(pack_row(v), pack_row(w)); }
uvec4 unpack_row(u64vec2 row) { return uvec4(unpackUint2x32(row.x), unpackUint2x32(row.y)); }
// What lies in a storage buffer, which has a view as a texel buffer: read as this kernel is to.
#define STORED_OR_FETCHED(stored, fetched) (reads_storage ? (stored) : (fetched))
#else
#define ROW vec4
#define ROW_PAIR mat2x4
vec4 pack_row(vec4 v) { return v; }
mat2x4 pack_rows(vec4 v, vec4 w) { return mat2x4(v, w); }
#define STORED_OR_FETCHED(stored, fetched) (fetched)
#endif

#endif
