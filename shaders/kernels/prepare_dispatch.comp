// Sizes the indirect dispatches that follow from the lengths of the queues, gives entries of queues that are shaded
// their places, and empties the queues that are filled at the next bounce. Shading fills a place for each entry, so the
// tracing that follows it is sized before it.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 1) in;
#include "base/features.glsl"
#include "base/queues.glsl"
#include "geometry/trace_settings.glsl"
#include "path/volume_path.glsl"

void set_groups(uint dispatch, uint lanes, uint lanes_per_group) {
  uint word = kCounterArguments + 4u * dispatch;
  counters[word] = (lanes + lanes_per_group - 1u) / lanes_per_group;
  counters[word + 1u] = 1u;
  counters[word + 2u] = 1u;
}

void prepare_shadow(uint places) {
  set_groups(kDispatchShadow, places, is_volumetric() ? kWalkedPerGroup : kTracedPerGroup);
  counters[kCounterQueue + kQueueShadow] = places;
}

void prepare_rays(uint queue, uint places) {
  counters[kCounterQueue + queue] = places;
  set_groups(kDispatchClosest, places, kTracedPerGroup);
  if (has_media()) set_groups(kDispatchQueue + queue, places, kWalkedPerGroup);
}

void main() {
  if (wave.mode == kPrepareShadow) {
    prepare_shadow(counters[kCounterQueue + wave.ray_queue]);
  } else if (wave.mode == kPrepareFirst) {
    prepare_rays(wave.ray_queue, wave.pixel_count * wave.block_count * kBlockSamples);
  } else {
    uint places = 0u;
    for (uint q = kQueueEmitter; q < queues_end(); ++q) {
      uint entries = counters[length_word(q, wave.bounce)];
      set_groups(kDispatchQueue + q, entries, kWorkgroupSize);
      counters[kCounterPlace + q] = places;
      if (q >= kQueueSurface) places += entries;
      counters[length_word(q, wave.bounce + 1u)] = 0u;
    }
    prepare_rays(1u - wave.ray_queue, places);
    prepare_shadow(places);
  }
}
