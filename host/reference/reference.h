#pragma once

// The CPU reference: a plain path tracer in double precision that judges the device kernels. It shares the
// Scene with them, nothing else: ray tracing, materials, lights, media and random numbers are its own, one
// path at a time. How the scene's words are meant stands in the headers beside this one: bsdf/, light/,
// medium/, texture/, sensor.h, path.cpp and volpath.cpp.

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "image/film.h"
#include "scene/scene.h"

namespace tachylite {

/// A result of the reference, and the film that it is a view of. Pixels are row by row from the top of the crop window, linear Rec.709.
struct ReferenceImage {
  FilmBuffer film;
  int width = 0, height = 0;
  uint64_t samples = 0;              // per pixel
  std::vector<glm::dvec3> mean;      // radiance
  std::vector<glm::dvec3> variance;  // of the pixel's mean, from its samples; 0 with fewer than two
  struct Channel {
    std::string name;  // "albedo.R", ...
    std::vector<double> values;
  };
  std::vector<Channel> aovs;  // mean over samples of the first hit's value, 0 where nothing was hit; and where the
                              // scene's integrator is `moment`, m2_R/G/B: mean square of a sample
  uint64_t nonfinite = 0;     // samples dropped (counted as 0)
  uint64_t closest_rays = 0, shadow_rays = 0;
};

/// Renders sample after sample. Sample s of a pixel depends on seed, pixel and s alone: the image is the same
/// for any number of threads, and ranges of samples can be rendered apart.
class ReferenceRenderer {
 public:
  /// `scene` must outlive this. `aovs` as in Integrator::aovs ("type" or "name:type"), beside those of the
  /// scene (scene/aov.h). Throws InputError on an unknown AOV or a sensor that the scene does not have.
  explicit ReferenceRenderer(const Scene& scene, int sensor = 0, uint32_t seed = 0,
                             const std::vector<std::string>& aovs = {});
  ~ReferenceRenderer();

  /// Adds the samples [first, first + count) to every pixel, on all threads of base/parallel.h.
  void add_samples(uint64_t first, uint64_t count);
  /// Adds those of a film of this scene, sensor, seed and AOVs.
  void add_film(const FilmBuffer& film);
  ReferenceImage image() const;
  /// Estimated standard error of the pixels' mean relative to the mean radiance: sqrt(mean variance) / mean.
  double relative_error() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct ReferenceProgress {
  uint64_t samples_done = 0, samples_wanted = 0;  // per pixel
  double seconds = 0;
  double relative_error = 0;  // ReferenceRenderer::relative_error
};
struct ReferenceOptions {
  int sensor = 0;
  uint64_t samples = 0;  // 0: the sensor's sample_count
  uint64_t first_sample = 0;
  const FilmBuffer* begun = nullptr;  // the samples from first_sample on that there are already
  uint32_t seed = 0;
  double seconds = std::numeric_limits<double>::infinity();  // no pass begins after this wall-clock time
  std::vector<std::string> aovs;
  /// Called after each pass over the image; returning false ends the rendering.
  std::function<bool(const ReferenceProgress&)> progress;
};
/// Renders in passes of a few samples until all are done, time is up, or `progress` ends it.
ReferenceImage render_reference(const Scene& scene, const ReferenceOptions& options);

/// Channels R G B, variance.R/G/B, and the AOVs.
inline Image to_image(const ReferenceImage& image) { return image.film.to_image(); }

}  // namespace tachylite
