// Mesh attributes: values a face, or interpolated from a triangle's vertices.
#ifndef TACHYLITE_TEXTURE_ATTRIBUTE_GLSL
#define TACHYLITE_TEXTURE_ATTRIBUTE_GLSL
#include "shared/bindings.h"
#include "shared/texture.h"

layout(set = 0, binding = kBindAttributes) uniform samplerBuffer attributes;

vec3 load_attribute(uint row) { return texelFetch(attributes, int(row)).xyz; }

// row0: of the texture; b: barycentrics of vertices 1 and 2. Black where the mesh lacks the attribute.
vec3 attribute_color(uvec4 row0, float scale, uint triangle, vec2 b) {
  uint i = triangle - row0.z;
  bool per_vertex = (row0.x & kAttributePerVertex) != 0u;
  uint row = row0.y + (i < row0.w ? i : 0u) * (per_vertex ? 3u : 1u);
  vec3 value = load_attribute(row);
  if (per_vertex) value = (1.0 - b.x - b.y) * value + b.x * load_attribute(row + 1u) + b.y * load_attribute(row + 2u);
  return i < row0.w ? scale * value : vec3(0.0);
}

#endif
