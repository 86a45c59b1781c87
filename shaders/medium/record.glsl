// Access to the records of shared/medium.h.
#ifndef TACHYLITE_MEDIUM_RECORD_GLSL
#define TACHYLITE_MEDIUM_RECORD_GLSL
#include "base/features.glsl"
#include "shared/bindings.h"
#include "shared/geometry.h"
#include "shared/medium.h"

layout(set = 0, binding = kBindMedia) uniform samplerBuffer media;

vec4 load_medium(uint row) { return texelFetch(media, int(row)); }

// Paths count their own depth; rays meet media.
bool is_volumetric() { return media_kinds != 0u; }
bool has_media() { return (media_kinds & (kMediaHomogeneous | kMediaGrids)) != 0u; }
bool has_medium(uint kind) { return (media_kinds & kind) != 0u; }

// Whether the medium with that row 0 is a grid.
bool is_grid(vec4 row0) {
  bool grid = (floatBitsToUint(row0.w) & 0xffu) == kMediumGrid;
  return has_medium(kMediaGrids) && (!has_medium(kMediaHomogeneous) || grid);
}

// The medium on the side of direction d, of a surface whose shape has the words `shape` (row 0, shared/geometry.h) and
// the geometric normal n_g; `current` where the shape is no boundary.
uint medium_behind(uvec4 shape, vec3 n_g, vec3 d, uint current) {
  uint beyond = dot(n_g, d) > 0.0 ? shape.w >> 16u : shape.w & 0xffffu;
  return (shape.z & kShapeIsBoundary) != 0u ? beyond : current;
}

#endif
