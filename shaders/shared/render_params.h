// What the whole render shares (uniform buffer) and what one wave has of its own (push constants).
//
// A wave is a set of paths that are traced together: `block_count` blocks of kBlockSamples samples of `pixel_count`
// consecutive pixels in tile order. Path slot = (block * pixel_count + pixel) * kBlockSamples + sample.
// With adaptive sampling the pixels are those of a list instead: pixel in tile order, first block.
// A pixel in tile order counts through tiles of 8 x 8 pixels, row by row of tiles; those outside the image are idle.
#ifndef TACHYLITE_SHARED_RENDER_PARAMS_H
#define TACHYLITE_SHARED_RENDER_PARAMS_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kBlockSamples = 4u;
TACHYLITE_CONST uint kTileSize = 8u;

// Perspective, thin lens and orthographic cameras. Device space = world space - centre.
struct CameraParams {
  vec4 right, up, forward, position;  // xyz; camera-space axes (+x is LEFT in Mitsuba: `right` is -x) and origin
  // Film position (x, y) in pixels of the full film, y down -> camera-space point on the plane z = 1 (perspective)
  // or offset on the film (orthographic): px = scale.x * x + offset.x, py = scale.y * y + offset.y (right, up).
  vec4 scale_offset;
  float near_clip, far_clip, aperture_radius, focus_distance;
};

struct RenderParams {
  CameraParams camera;
  uint width, height;       // of the image that is rendered (the crop)
  uint crop_x, crop_y;      // where it begins in the full film
  uint film_width;          // of the full film: pixels are numbered there, so that a crop has the samples of the whole
  uint tiles_x, tile_count;
  uint capacity;            // paths in flight: stride of the rows of the path state
  uint seed;
  uint end_sample;          // samples of a pixel from this index on are not rendered
  uint class_count;         // material classes
  float filter_radius, filter_stddev;
  uint aov_stride;          // of the rows of kBindAov: pixels times blocks of a wave
  uint light_count;         // records in kBindLights that photons may leave from
  float guide_scale;        // edge of a guide's cell by its distance from the camera, at most
  vec4 focusers[3];         // kMaxFocusers spheres of the guide: centre (device space), radius
};

struct WaveParams {
  uint first_pixel, pixel_count;   // in tile order
  uint first_block, block_count;
  uint bounce;                     // 0: camera rays
  uint ray_queue;                  // 0 or 1: which of the two ray queues holds this bounce's rays
  uint mode;                       // of prepare_dispatch
  uint photons;                    // 1: the paths are photons, as of pixels beyond the film (path/guide.glsl)
};

TACHYLITE_SHARED_END
#endif
