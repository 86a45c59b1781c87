// Sorts paths, whose rays were traced, into the queues of the stages that follow.
#ifndef TACHYLITE_PATH_SORT_PATHS_GLSL
#define TACHYLITE_PATH_SORT_PATHS_GLSL
#include "base/features.glsl"
#include "base/queues.glsl"
#include "geometry/load.glsl"
#include "geometry/trace_settings.glsl"
#include "path/volume_path.glsl"
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

// Of this workgroup's places. Until sort_paths has asked for it, the kernel may keep there what it will need to answer.
shared uint destinations[kRaysPerGroup];
// By the kernel: the queues of the path whose ray has this place.
uint destination(uint place);

// Appends the paths of this subgroup's rays to their queues: six queues at a time, with one atomic each. Each lane has
// neighbouring rays, so that entries keep the order of the rays. Reports loops that the driver has ended.
void sort_paths(uint begin, uint mask) {
  uint queue = kQueueEmitter;
  bool cut = false;
  for (; queue < queues_end(); queue += 6u) {
    uvec3 lengths = uvec3(0u);  // of the lane's parts of the six, 16 bits each
    uint k = 0u;
    [[dont_unroll]] for (; k < kRaysPerLane; ++k) {
      uint i = (begin + k) % kRaysPerGroup, queues = destinations[i];
      if (queue == kQueueEmitter) {
        queues = (mask & 1u << k) != 0u ? destination(begin + k) : kNoQueues;
        destinations[i] = queues;
      }
      uint q = surface_queue(queues) - queue;
      uint one = 1u << (16u * (q & 1u));
      lengths += uvec3(q < 2u ? one : 0u, (q & ~1u) == 2u ? one : 0u, (q & ~1u) == 4u ? one : 0u);
      if (has_area_light() && queue == kQueueEmitter && goes_to_emitter(queues)) lengths.x += 1u;
    }
    cut = cut || k < kRaysPerLane;
    uvec3 before = subgroupExclusiveAdd(lengths), all = subgroupAdd(lengths);
    uvec3 low = uvec3(0u), high = uvec3(0u);
    if (subgroupElect()) {
      for (uint pair = 0u; pair < 3u; ++pair) {
        uint l = all[pair] & 0xffffu, h = all[pair] >> 16u;
        uint word = length_word(queue, wave.bounce) + 2u * pair;
        if (l > 0u) low[pair] = atomicAdd(counters[word], l);
        if (h > 0u) high[pair] = atomicAdd(counters[word + 1u], h);
      }
    }
    low = subgroupBroadcastFirst(low) + (before & 0xffffu);
    high = subgroupBroadcastFirst(high) + (before >> 16u);
    k = 0u;
    [[dont_unroll]] for (; k < kRaysPerLane; ++k) {
      uint queues = destinations[(begin + k) % kRaysPerGroup], slot = load_queue(wave.ray_queue, begin + k);
      uint q = surface_queue(queues) - queue;
      bvec3 pair = equal(uvec3(q >> 1u), uvec3(0u, 1u, 2u));
      bool odd = (q & 1u) != 0u;
      uvec3 at = odd ? high : low;
      if (q < 6u) store_queue(queue + q, pair.x ? at.x : (pair.y ? at.y : at.z), slot);
      uvec3 step = uvec3(pair);
      low += odd ? uvec3(0u) : step;
      high += odd ? step : uvec3(0u);
      if (has_area_light() && queue == kQueueEmitter && goes_to_emitter(queues)) {
        store_queue(kQueueEmitter, low.x, slot);
        low.x += 1u;
      }
    }
    cut = cut || k < kRaysPerLane;
  }
  report_unfinished(cut || queue < queues_end());
}

#endif
