// Reads of the tree and its leaves (shared/bvh.h), in one place, so that another path to memory can be chosen there.
#ifndef TACHYLITE_GEOMETRY_LOAD_GLSL
#define TACHYLITE_GEOMETRY_LOAD_GLSL
#include "shared/bindings.h"
#include "shared/bvh.h"

layout(set = 0, binding = kBindBvhNodes) uniform usamplerBuffer bvh_nodes;
layout(set = 0, binding = kBindBvhLeaves) uniform samplerBuffer bvh_leaves;
layout(set = 0, binding = kBindLeafInfo) uniform usamplerBuffer leaf_info;

uvec4 load_bvh_node(uint row) { return texelFetch(bvh_nodes, int(row)); }
vec4 load_bvh_leaf(uint row) { return texelFetch(bvh_leaves, int(row)); }
uvec4 load_leaf_info(uint leaf) { return texelFetch(leaf_info, int(leaf * kBvhLeafRows + 3u)); }

#endif
