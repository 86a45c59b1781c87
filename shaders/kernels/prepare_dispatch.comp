// Sizes the indirect dispatches that follow from the lengths of the queues, gives entries of queues that are shaded
// their places, and empties the queues that are filled next.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 1) in;
#include "base/features.glsl"
#include "base/queues.glsl"
#include "geometry/trace_settings.glsl"
#include "medium/record.glsl"

// One past the last queue that sorting fills.
uint queues_end() { return kQueueSurface + class_count + (has_media() ? 1u : 0u); }

void set_groups(uint dispatch, uint lanes, uint lanes_per_group) {
  uint word = kCounterArguments + 4u * dispatch;
  counters[word] = (lanes + lanes_per_group - 1u) / lanes_per_group;
  counters[word + 1u] = 1u;
  counters[word + 2u] = 1u;
}

void prepare_shadow(uint places) {
  set_groups(kDispatchShadow, places, is_volumetric() ? kWorkgroupSize : kRaysPerGroup);
  counters[kCounterQueue + kQueueShadow] = places;
}

void main() {
  uint rays = counters[kCounterQueue + wave.ray_queue];
  if (wave.mode == kPrepareShadow) {
    prepare_shadow(rays);
  } else if (wave.mode == kPrepareTrace) {
    // Shading (or the camera) has queued rays for wave.bounce, and shadow rays.
    if (wave.bounce == 0u) rays = wave.pixel_count * wave.block_count * kBlockSamples;
    counters[kCounterQueue + wave.ray_queue] = rays;
    set_groups(kDispatchClosest, rays, kRaysPerGroup);
    prepare_shadow(rays);
    if (has_media()) set_groups(kDispatchQueue + wave.ray_queue, rays, kWorkgroupSize);
    for (uint q = kQueueEmitter; q < queues_end(); ++q) counters[kCounterQueue + q] = 0u;
  } else {
    for (uint q = kQueueEmitter; q < queues_end(); ++q)
      set_groups(kDispatchQueue + q, counters[kCounterQueue + q], kWorkgroupSize);
    uint places = 0u;
    for (uint q = kQueueSurface; q < queues_end(); ++q) {
      counters[kCounterPlace + q] = places;
      places += counters[kCounterQueue + q];
    }
    counters[kCounterQueue + (1u - wave.ray_queue)] = places;
  }
}
