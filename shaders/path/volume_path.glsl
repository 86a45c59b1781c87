// What a path carries where there are media or null surfaces (kPathMedium); without them everything here is constant.
#ifndef TACHYLITE_PATH_VOLUME_PATH_GLSL
#define TACHYLITE_PATH_VOLUME_PATH_GLSL
#include "base/queues.glsl"
#include "medium/record.glsl"

// One past the last queue that sorting fills.
uint queues_end() { return kQueueSurface + class_count + (has_media() ? 1u : 0u); }

struct VolumePath {
  uint medium;
  uint edges;      // of the path with its last ray; those that begin on null surfaces are parts of the edge before
  float distance;  // from the last vertex that is not null to the origin of the last ray
};

VolumePath load_volume_path(uint slot) {
  VolumePath path = VolumePath(kNoMedium, wave.bounce + 1u, 0.0);
  if (is_volumetric()) {
    vec4 row = load_path(kPathMedium, slot);
    path = VolumePath(floatBitsToUint(row.x), floatBitsToUint(row.y), row.z);
  }
  return path;
}

void store_volume_path(uint slot, VolumePath path) {
  if (is_volumetric())
    store_path(kPathMedium, slot, vec4(uintBitsToFloat(path.medium), uintBitsToFloat(path.edges), path.distance, 0.0));
}

// A shadow ray that begins in a medium.
void store_volume_shadow_ray(uint place, vec3 o, uint leaving, vec3 d, uint target, vec3 contribution, uint slot,
                             uint medium) {
  store_shadow_ray(place, o, leaving, d, target, contribution, slot);
  if (is_volumetric()) shadow_rows[row_index(3u, place)] = pack_row(vec4(uintBitsToFloat(medium), 0.0, 0.0, 0.0));
}

#endif
