// Camera rays.
#ifndef TACHYLITE_PATH_CAMERA_GLSL
#define TACHYLITE_PATH_CAMERA_GLSL
#include "base/math.glsl"
#include "base/queues.glsl"
#include "base/warp.glsl"
#include "path/path_sampler.glsl"

struct CameraRay {
  vec3 o, d;    // from the near clip plane on
  float tmax;   // to the far clip plane
};

// Offset from the pixel's centre, distributed as the reconstruction filter (Ernst, Stamminger and Greiner 2006,
// "Filter Importance Sampling"): every sample then counts for its own pixel alone, with weight 1.
float filter_offset(float u) {
  if (filter_kind == kFilterTent) {
    // Inverse of the CDF of a tent of radius r.
    float v = 2.0 * u - 1.0;
    return params.filter_radius * (v < 0.0 ? sqrt(1.0 + v) - 1.0 : 1.0 - sqrt(1.0 - v));
  }
  if (filter_kind == kFilterGaussian) {
    // Truncated at the radius; Mitsuba's filter also subtracts its value there (3e-4 of the peak), which is left out.
    float cut = xerf(params.filter_radius / (1.41421356 * params.filter_stddev));
    return 1.41421356 * params.filter_stddev * xerfinv((2.0 * u - 1.0) * cut);
  }
  return (2.0 * u - 1.0) * params.filter_radius;
}

// u: position in the filter.
CameraRay sample_camera_ray(uvec2 pixel, vec2 u, PathSampler path_sampler) {
  vec2 film = vec2(pixel + uvec2(params.crop_x, params.crop_y)) + 0.5 + vec2(filter_offset(u.x), filter_offset(u.y));
  CameraParams camera = params.camera;
  vec2 plane = film * camera.scale_offset.xy + camera.scale_offset.zw;  // right, up

  CameraRay ray;
  ray.o = camera.position.xyz;
  float per_depth;  // length of the ray for one unit of depth along the camera's axis
  if (camera_kind == kCameraOrthographic) {
    ray.o += plane.x * camera.right.xyz + plane.y * camera.up.xyz;
    ray.d = camera.forward.xyz;
    per_depth = 1.0;
  } else {
    vec3 local = vec3(plane, 1.0);
    if (camera_kind == kCameraThinLens) {
      vec2 lens = camera.aperture_radius * sample_uniform_disk(lens_sample(path_sampler));
      local = vec3(local.xy * camera.focus_distance - lens, camera.focus_distance);
      ray.o += lens.x * camera.right.xyz + lens.y * camera.up.xyz;
    }
    local = normalize(local);
    ray.d = normalize(local.x * camera.right.xyz + local.y * camera.up.xyz + local.z * camera.forward.xyz);
    per_depth = 1.0 / local.z;
  }
  ray.o += ray.d * (camera.near_clip * per_depth);
  ray.tmax = (camera.far_clip - camera.near_clip) * per_depth;
  return ray;
}

#endif
