// The queues that a path goes to when its ray was traced.
#ifndef TACHYLITE_PATH_SORT_PATH_GLSL
#define TACHYLITE_PATH_SORT_PATH_GLSL
#include "base/features.glsl"
#include "base/queues.glsl"
#include "geometry/load.glsl"
#include "shared/geometry.h"

// Two at most, as one word: that of a surface or of escaped rays, or none (0), and kToEmitter.
const uint kNoQueues = 0u, kToEmitter = 0x80000000u;

// edges: of the path, with this ray.
uint queues_after(uint hit_id, uint edges) {
  bool found = hit_id != kNoHit;
  uvec4 info = found ? load_leaf_info(hit_id >> 1u) : uvec4(0u);
  uint path_class = (info.z >> kLeafClassShift) & kLeafClassMask;
  bool counts = !(hide_emitters && edges == 1u);
  // Behind a null surface may be light even at the largest depth.
  bool goes_on = edges < max_depth || shadow_passes_null;
  uint queues = found && goes_on && path_class < class_count ? kQueueSurface + path_class : kNoQueues;
  if (has_escaped_light() && !found && counts) queues = kQueueEscaped;
  if (has_area_light() && counts && (info.z & kLeafEmits) != 0u) queues |= kToEmitter;
  return queues;
}

bool goes_to_emitter(uint queues) { return (queues & kToEmitter) != 0u; }
uint surface_queue(uint queues) { return queues & ~kToEmitter; }

// Called by all lanes that have a ray; `wanted`: this path goes on from its hit.
void sort_path(bool wanted, uint slot, uint hit_id, uint edges) {
  uint queues = wanted ? queues_after(hit_id, edges) : kNoQueues;
  if (has_area_light()) append_to_queue(kQueueEmitter, goes_to_emitter(queues), slot);
  if (has_escaped_light()) append_to_queue(kQueueEscaped, surface_queue(queues) == kQueueEscaped, slot);
  for (uint c = 0u; c < class_count; ++c) append_to_queue(kQueueSurface + c, surface_queue(queues) == kQueueSurface + c, slot);
}

#endif
