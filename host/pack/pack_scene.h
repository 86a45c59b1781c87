#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "accel/bvh.h"
#include "base/bulk_vector.h"
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

  BulkVector<glm::uvec4> triangles;    // shared/geometry.h
  BulkVector<glm::vec4> normals;
  std::vector<glm::vec4> curved;
  PageVector<glm::vec4> attributes;
  PageVector<glm::vec2> uvs;
  std::vector<glm::uvec4> shapes;
  std::vector<glm::uvec4> materials;   // shared/material.h
  std::vector<glm::uvec4> textures;    // shared/texture.h
  PageVector<uint32_t> texels8;        // RGBA8
  PageVector<glm::uvec2> texels16;     // RGBA16F
  PageVector<glm::vec4> texels32;      // RGBA32F
  std::vector<glm::vec4> lights;       // shared/light.h
  std::vector<glm::uvec4> light_table;
  std::vector<float> emission;
  PageVector<glm::vec4> environment;
  PageVector<glm::vec4> environment_cdf;
  std::vector<glm::vec4> media;
  PageVector<float> grids;

  glm::dvec3 centre{0};                // device space = world space - centre
  double bvh_seconds = 0, pack_seconds = 0;
  uint64_t host_bytes() const;
};

/// Throws InputError (file:line of the object) for what the device cannot render.
PackedScene pack_scene(const Scene& scene, int sensor = 0);

}  // namespace tachylite
