// Puts a path whose ray was traced into the queues of the stages that follow. Needs leaf_info.
#ifndef TACHYLITE_PATH_SORT_PATH_GLSL
#define TACHYLITE_PATH_SORT_PATH_GLSL
#include "base/features.glsl"
#include "base/queues.glsl"
#include "shared/geometry.h"

// edges: of the path, with this ray. Called by all lanes that have a ray; `wanted`: this path goes on from its hit.
void sort_path(bool wanted, uint slot, uint hit_id, uint edges) {
  bool found = wanted && hit_id != kNoHit;
  uvec4 info = found ? texelFetch(leaf_info, int(hit_id >> 1u)) : uvec4(0u);
  uint path_class = (info.z >> kLeafClassShift) & kLeafClassMask;
  bool counts = !(hide_emitters && edges == 1u);
  if (has_area_light()) append_to_queue(kQueueEmitter, found && counts && (info.z & kLeafEmits) != 0u, slot);
  if (has_escaped_light()) append_to_queue(kQueueEscaped, wanted && !found && counts, slot);
  // Behind a null surface may be light even at the largest depth.
  bool goes_on = edges < max_depth || shadow_passes_null;
  for (uint c = 0u; c < class_count; ++c) append_to_queue(kQueueSurface + c, found && goes_on && path_class == c, slot);
}

#endif
