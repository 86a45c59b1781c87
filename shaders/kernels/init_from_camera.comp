// Starts the paths of a wave: one camera ray a lane, and its place in the queue of bounce 0.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/queues.glsl"
#include "path/camera.glsl"
#include "path/volume_path.glsl"

void main() {
  uint slot = gl_GlobalInvocationID.x;
  uvec2 pixel = uvec2(0u);
  bool owned = slot < wave.pixel_count * wave.block_count * kBlockSamples;
  bool inside = owned && slot_sample(slot) < params.end_sample && pixel_of(slot_tile_pixel(slot), pixel);
  if (!owned) return;
  store_queue(kQueueRays0, slot, inside ? slot : kNoPath);
  store_path(kPathRadiance, slot, vec4(0.0));
  if (!inside) return;

  PathSampler path_sampler = begin_path_sampler(film_pixel(pixel), slot_sample(slot), params.seed);
  CameraRay ray = sample_camera_ray(pixel, camera_sample(path_sampler).xy, path_sampler);
  store_path_ray(slot, ray.o, kNoHit, ray.d, 0.0);
  store_path(kPathBeta, slot, vec4(1.0));
  store_path(kPathHit, slot, vec4(0.0, 0.0, 0.0, ray.tmax));
  store_volume_path(slot, VolumePath(camera_medium, 1u, 0.0));
}
