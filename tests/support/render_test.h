#pragma once

// Scenes as text, rendered on the test device.

#include <string>
#include <utility>
#include <vector>

#include "image/verify.h"
#include "pack/pack_scene.h"
#include "scene/scene.h"
#include "support/device_test.h"
#include "wavefront/renderer.h"

namespace tachylite::test {

/// Reads a scene given as the elements inside <scene>. `files`: name and content of the files that it refers to.
Scene scene_from_elements(const std::string& elements,
                          const std::vector<std::pair<std::string, std::string>>& files = {});

/// A sensor at `origin` that looks at `target`, with a box filter.
std::string sensor_element(int width, int height, const std::string& origin = "0, 0, 4",
                           const std::string& target = "0, 0, 0", double fov = 40);

/// An open Cornell box of rectangles and cubes, [-1, 1]^3, seen from +z, with an integrator of that depth.
std::string cornell_elements(int size, int max_depth = 8);

struct DeviceRender {
  FilmBuffer film;
  RenderStatistics statistics;
  std::vector<std::string> stages_run, stages_skipped;
};
DeviceRender render_on_device(const Scene& scene, const RenderOptions& options, vulkan::Device& on = device());

/// Mean of the image's pixels and the standard error of that mean.
struct ImageMean {
  glm::dvec3 value{0}, error{0};
};
ImageMean image_mean(const FilmBuffer& film);

/// Expects that device and CPU reference agree on the scene (image/verify.h): a test of level 1e-4 with the power that
/// `options` ask for. Nothing may be dropped as not finite or for lack of room.
void expect_agreement(const Scene& scene, const VerifyOptions& options);
/// The same of two scenes that must look alike, one for the device (samples and seed of `render` are set) and one for
/// the judge.
void expect_agreement(const Scene& scene, const Scene& judged_by, const VerifyOptions& options,
                      RenderOptions render = {});

}  // namespace tachylite::test
