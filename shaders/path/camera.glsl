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

// Integral of the reconstruction filter from -infinity to x, and its inverse; the filter has radius 1 (tent) or is a
// normal distribution (gaussian; Mitsuba's also subtracts its value at the radius, 3e-4 of the peak: left out).
float filter_cdf(float x) {
  if (filter_kind == kFilterGaussian) return 0.5 + 0.5 * xerf(x * 0.70710678);
  return x < 0.0 ? 0.5 * sqr(1.0 + x) : 1.0 - 0.5 * sqr(1.0 - x);
}
float inverse_filter_cdf(float u) {
  if (filter_kind == kFilterGaussian) return 1.41421356 * xerfinv(2.0 * u - 1.0);
  float v = 2.0 * u - 1.0;
  return v < 0.0 ? sqrt(1.0 + v) - 1.0 : 1.0 - sqrt(1.0 - v);
}

// Offset from the pixel's centre, distributed as the reconstruction filter (Ernst, Stamminger and Greiner 2006,
// "Filter Importance Sampling"): every sample then counts for its own pixel alone, with weight 1. below, above:
// distances from the centre to the borders of the image, beyond which there are no samples.
float filter_offset(float u, float below, float above) {
  if (filter_kind == kFilterBox) return (2.0 * u - 1.0) * params.filter_radius;
  float unit = filter_kind == kFilterGaussian ? params.filter_stddev : params.filter_radius;
  float lo = filter_cdf(-min(below, params.filter_radius) / unit);
  float hi = filter_cdf(min(above, params.filter_radius) / unit);
  return unit * inverse_filter_cdf(mix(lo, hi, u));
}

// u: position in the filter.
CameraRay sample_camera_ray(uvec2 pixel, vec2 u, PathSampler path_sampler) {
  vec2 below = vec2(pixel) + 0.5, above = vec2(params.width, params.height) - below;
  vec2 offset = vec2(filter_offset(u.x, below.x, above.x), filter_offset(u.y, below.y, above.y));
  vec2 film = below + vec2(params.crop_x, params.crop_y) + offset;
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
    float depth = length(local);
    ray.d = (local.x * camera.right.xyz + local.y * camera.up.xyz + local.z * camera.forward.xyz) * (1.0 / depth);
    per_depth = depth / local.z;
  }
  ray.o += ray.d * (camera.near_clip * per_depth);
  ray.tmax = (camera.far_clip - camera.near_clip) * per_depth;
  return ray;
}

#endif
