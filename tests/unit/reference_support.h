#pragma once

// Small scenes made in code for the tests of host/reference.

#include <string>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "reference/reference.h"
#include "reference/world.h"
#include "scene/scene.h"

namespace tachylite::test {

struct SceneBuilder {
  Scene scene;

  SceneBuilder() {
    scene.integrator.rr_depth = 1 << 20;
    Sensor sensor;
    sensor.x_fov = 0.5;
    sensor.film.width = sensor.film.crop_width = 4;
    sensor.film.height = sensor.film.crop_height = 4;
    sensor.film.filter = ReconstructionFilter::kBox;
    sensor.film.filter_radius = 0.5;
    scene.sensors.push_back(sensor);
  }

  BsdfIndex add(BsdfKind kind) {
    scene.bsdfs.push_back({{}, "", "", std::move(kind)});
    return static_cast<BsdfIndex>(scene.bsdfs.size()) - 1;
  }
  /// Returns the shape's index. The bsdf defaults to black.
  template <class Kind>
  int add_shape(const Kind& kind, const dmat4& to_world = dmat4(1), BsdfIndex bsdf = kNone) {
    Shape shape;
    shape.kind = kind;
    shape.to_world = to_world;
    shape.bsdf = bsdf == kNone ? add(DiffuseBsdf{0.0}) : bsdf;
    scene.shapes.push_back(shape);
    return static_cast<int>(scene.shapes.size()) - 1;
  }
  void add_area_light(int shape, const dvec3& radiance) {
    scene.shapes[static_cast<size_t>(shape)].emitter = static_cast<EmitterIndex>(scene.emitters.size());
    scene.emitters.push_back({{}, "area", AreaEmitter{radiance}, shape});
  }
  template <class Kind>
  void add_light(const Kind& kind) {
    scene.emitters.push_back({{}, "", kind, kNone});
  }
  TextureIndex add_texture(Texture texture) {
    scene.textures.push_back(std::move(texture));
    return static_cast<TextureIndex>(scene.textures.size()) - 1;
  }
  void look(const dvec3& from, const dvec3& at) {
    scene.sensors[0].to_world = reference::dmat4(1);
    const dvec3 forward = glm::normalize(at - from);
    const reference::Frame frame = reference::frame_around(forward);
    scene.sensors[0].to_world =
        dmat4(glm::dvec4(frame.s, 0), glm::dvec4(frame.t, 0), glm::dvec4(forward, 0), glm::dvec4(from, 1));
  }
};

inline dmat4 moved(const dvec3& by) {
  return glm::translate(dmat4(1), by);
}
inline dmat4 scaled(const dvec3& by) {
  return glm::scale(dmat4(1), by);
}
inline dmat4 turned(double degrees, const dvec3& axis) {
  return glm::rotate(dmat4(1), glm::radians(degrees), axis);
}

/// Running mean of a random variable.
class Mean {
 public:
  void add(double x) {
    ++n_;
    sum_ += x;
    squares_ += x * x;
  }
  double mean() const { return sum_ / n_; }
  double standard_error() const {
    return std::sqrt(std::max(0.0, squares_ / n_ - mean() * mean()) / std::max(1.0, n_ - 1));
  }

 private:
  double n_ = 0, sum_ = 0, squares_ = 0;
};

/// |z| < 5 has the level 6e-7 (two-sided, normal); a bias of 7.3 standard errors is seen with power 0.99. The
/// slack is for quadrature and rounding. The standard error must be below `resolution`, else the test could
/// not fail.
#define EXPECT_MEAN(mean_object, expected, resolution)                                              \
  do {                                                                                              \
    const auto& mean_ = (mean_object);                                                              \
    EXPECT_LE(mean_.standard_error(), (resolution));                                                \
    EXPECT_NEAR(mean_.mean(), (expected), 5 * mean_.standard_error() + 1e-9 + 1e-4 * (resolution)); \
  } while (0)

/// Mean and standard error of one channel over all pixels of a rendering.
struct Rendered {
  double mean = 0, standard_error = 0;
};
inline Rendered render_mean(const Scene& scene, uint64_t samples, uint32_t seed = 1, int channel = 1) {
  ReferenceOptions options;
  options.samples = samples;
  options.seed = seed;
  const ReferenceImage image = render_reference(scene, options);
  Rendered result;
  for (size_t i = 0; i < image.mean.size(); ++i) {
    result.mean += image.mean[i][channel];
    result.standard_error += image.variance[i][channel];
  }
  const double n = static_cast<double>(image.mean.size());
  return {result.mean / n, std::sqrt(result.standard_error) / n};
}

}  // namespace tachylite::test
