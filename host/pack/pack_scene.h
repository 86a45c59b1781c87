#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "accel/bvh.h"
#include "pack/feature_set.h"
#include "scene/aov.h"
#include "scene/scene.h"
#include "shared/render_params.h"

namespace tachylite {

/// The scene as arrays of the records in shaders/shared, ready for upload; empty arrays are not uploaded.
struct PackedScene {
  gpu::RenderParams params{};  // camera, film, lights; wave-dependent members are filled by the renderer
  FeatureSet features;
  std::vector<Aov> aovs;       // extra channels of the image, in order
  std::string sample_count_channel;  // empty: none
  Bvh8 bvh;

  std::vector<glm::uvec4> triangles;   // shared/geometry.h
  std::vector<glm::vec4> normals, curved, attributes;
  std::vector<glm::vec2> uvs;
  std::vector<glm::uvec4> shapes;
  std::vector<glm::uvec4> materials;   // shared/material.h
  std::vector<glm::uvec4> textures;    // shared/texture.h
  std::vector<uint32_t> texels8;       // RGBA8
  std::vector<glm::uvec2> texels16;    // RGBA16F
  std::vector<glm::vec4> texels32;     // RGBA32F
  std::vector<glm::vec4> lights;       // shared/light.h
  std::vector<glm::uvec4> light_table;
  std::vector<float> emission;
  std::vector<glm::vec4> environment;
  std::vector<glm::vec4> environment_cdf;
  std::vector<glm::vec4> media;
  std::vector<float> grids;

  glm::dvec3 centre{0};                // device space = world space - centre
  double bvh_seconds = 0, pack_seconds = 0;
  uint64_t host_bytes() const;
};

/// Throws InputError (file:line of the object) for what the device cannot render.
PackedScene pack_scene(const Scene& scene, int sensor = 0);

}  // namespace tachylite
