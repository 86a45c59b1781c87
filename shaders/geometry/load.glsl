// Reads of the tree and its leaves (shared/bvh.h), in one place, so that another path to memory can be chosen there.
#ifndef TACHYLITE_GEOMETRY_LOAD_GLSL
#define TACHYLITE_GEOMETRY_LOAD_GLSL
#include "base/rows.glsl"
#include "shared/bindings.h"
#include "shared/bvh.h"

layout(set = 0, binding = kBindBvhNodes) uniform usamplerBuffer bvh_nodes;
layout(set = 0, binding = kBindBvhLeaves) uniform samplerBuffer bvh_leaves;
layout(set = 0, binding = kBindLeafInfo) uniform usamplerBuffer leaf_info;

#ifdef WIDE_ROWS
layout(set = 0, binding = kBindBvhNodeRows) readonly restrict buffer BvhNodeRows { ROW bvh_node_rows[]; };
layout(set = 0, binding = kBindBvhLeafRows) readonly restrict buffer BvhLeafRows { ROW bvh_leaf_rows[]; };
#endif

uvec4 load_bvh_node(uint row) {
  return STORED_OR_FETCHED(unpack_row(bvh_node_rows[row]), texelFetch(bvh_nodes, int(row)));
}
vec4 load_bvh_leaf(uint row) {
  return STORED_OR_FETCHED(uintBitsToFloat(unpack_row(bvh_leaf_rows[row])), texelFetch(bvh_leaves, int(row)));
}
uvec4 load_leaf_info(uint leaf) {
  uint row = leaf * kBvhLeafRows + 3u;
  return STORED_OR_FETCHED(unpack_row(bvh_leaf_rows[row]), texelFetch(leaf_info, int(row)));
}

#endif
