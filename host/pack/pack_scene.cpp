#include "pack/pack_scene.h"

#include <algorithm>
#include <bit>

#include <glm/gtc/matrix_access.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "pack/find_focusers.h"
#include "pack/pack_camera.h"
#include "pack/pack_geometry.h"
#include "pack/pack_light.h"
#include "pack/pack_material.h"
#include "pack/pack_medium.h"
#include "pack/pack_texture.h"
#include "shared/aov.h"
#include "shared/baked.h"
#include "shared/geometry.h"
#include "shared/material.h"
#include "shared/medium.h"

namespace tachylite {
namespace {

using glm::dvec3;
using glm::uvec4;
using glm::vec4;

// What some kernel reads of vertices: their places are in the tree's leaves.
void put_vertices(Geometry& geometry, PackedScene& out) {
  const size_t count = geometry.vertices.size();
  if (out.features.vertex_uv) out.uvs = std::move(geometry.uvs);
  if (!out.features.vertex_normals) return;
  out.normals.resize(count);
  parallel_for(0, count, kMeshGrain, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) out.normals[i] = vec4(geometry.normals[i], 0);
  });
}

void put_primitives(const Geometry& geometry, PackedScene& out) {
  if (out.features.vertex_normals || !out.uvs.empty()) {
    out.triangles.resize(geometry.triangles.size());
    parallel_for(0, geometry.triangles.size(), kMeshGrain, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) out.triangles[i] = uvec4(geometry.triangles[i], 0);
    });
  }
  for (const CurvedPrimitive& curved : geometry.curved)
    for (int r = 0; r < 3; ++r) out.curved.push_back(vec4(glm::row(curved.object_to_world, r)));
}

bool is_volumetric(const Integrator& integrator) {
  return integrator.kind == Integrator::Kind::kVolpath || integrator.kind == Integrator::Kind::kVolpathMis;
}

// What of media and null surfaces paths and shadow rays meet; nothing with integrators that ignore them.
void set_media_features(const Scene& scene, const Sensor& sensor, const PackedMedia& media, FeatureSet& features) {
  if (!is_volumetric(scene.integrator)) return;
  features.shadow_null = std::any_of(features.classes.begin(), features.classes.end(), [](const MaterialClass& c) {
    return (c.flags & gpu::kMaterialNull) != 0;
  });
  features.media = media.kinds;
  if (media.kinds != 0 || features.shadow_null) features.media |= gpu::kMediaPaths;
  features.camera_medium = media.index(sensor.medium);
}

// Whether light is sampled along segments: in homogeneous media, from lights without extent that a loop can choose
// among.
bool samples_segments(const FeatureSet& features) {
  const bool points = features.has_light(gpu::kLightPoint) || features.has_light(gpu::kLightSpot) ||
                      features.has_light(gpu::kLightProjector);
  return points && (features.media & gpu::kMediaHomogeneous) && features.strategy != gpu::kStrategyBsdf &&
         (features.selection == gpu::kSelectSingle || features.selection == gpu::kSelectLoop);
}

// Leaves name class and emission, so that intersect_closest sorts paths with one load, and the shape.
void mark_leaves(const Scene& scene, const Geometry& geometry, const std::vector<uint32_t>& class_of_shape,
                 const std::vector<bool>& shape_emits, PackedScene& out) {
  const auto mark = [&](uvec4& info) {
    const bool curved = (info.z & gpu::kLeafKindMask) != gpu::kLeafTriangles;
    const uint32_t shape = curved ? geometry.shape_of_curved[info.x - geometry.triangles.size()]
                                  : geometry.shape_of_triangle[info.x];
    info.z |= class_of_shape[shape] << gpu::kLeafClassShift;
    if (shape_emits[shape]) info.z |= gpu::kLeafEmits;
    info.w |= shape * gpu::kShapeRows << gpu::kLeafShapeShift;
    if (scene.shapes[shape].emitter != kNone) info.z |= gpu::kLeafHides;
    // Curved primitives are found by their rows.
    if (curved) info.x = (info.x - static_cast<uint32_t>(geometry.triangles.size())) * gpu::kCurvedRows;
  };
  parallel_for(0, out.bvh.leaves.size(), kMeshGrain, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      mark(out.bvh.leaves[i].info);
      if (i >= out.bvh.first_wall) out.bvh.leaves[i].info.z |= gpu::kLeafWall;
    }
  });
}

// The auxiliary channels that the integrator asks for.
std::vector<Aov> scene_aovs(const Scene& scene, std::string* sample_count_channel = nullptr) {
  std::vector<Aov> aovs = parse_aovs(scene.integrator.aovs);
  if (scene.integrator.moment) aovs.push_back(moment_aov());
  const std::string count = take_sample_count(aovs);
  if (sample_count_channel) *sample_count_channel = count;
  return aovs;
}

bool aov_needs_uv(const std::vector<Aov>& aovs) {
  return std::any_of(aovs.begin(), aovs.end(), [](const Aov& aov) {
    return aov.kind == gpu::kAovUv || aov.kind == gpu::kAovDpDu || aov.kind == gpu::kAovDpDv;
  });
}

void set_path_features(const Scene& scene, FeatureSet& features) {
  const Integrator& integrator = scene.integrator;
  features.max_depth = integrator.max_depth < 0 ? 0xffffffffu : static_cast<uint32_t>(integrator.max_depth);
  if (integrator.kind == Integrator::Kind::kDirect) features.max_depth = std::min(features.max_depth, 2u);
  features.roulette_depth = static_cast<uint32_t>(std::max(1, integrator.rr_depth));
  features.hide_emitters = integrator.hide_emitters;
  features.strategy = static_cast<uint32_t>(integrator.strategy);
  for (const Aov& aov : scene_aovs(scene)) features.aovs |= 1u << aov.kind;
}

}  // namespace

uint64_t PackedScene::host_bytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(bvh.nodes) + bytes(bvh.leaves) + bytes(triangles) + bytes(uvs) +
         bytes(normals) + bytes(curved) + bytes(attributes) + bytes(shapes) + bytes(materials) + bytes(textures) +
         bytes(texels8) + bytes(texels16) + bytes(texels32) + bytes(lights) + bytes(emission) + bytes(light_table) + bytes(environment) +
         bytes(environment_cdf) + bytes(media) + bytes(grids);
}

PackedScene pack_scene(const Scene& scene, int sensor_index) {
  if (sensor_index < 0 || static_cast<size_t>(sensor_index) >= scene.sensors.size())
    throw InputError(fmt::format("{}: there is no sensor {}; the scene has {}", scene.path, sensor_index,
                                 scene.sensors.size()));
  const Sensor& sensor = scene.sensors[static_cast<size_t>(sensor_index)];
  Timer timer;
  PackedScene out;
  FeatureSet& features = out.features;

  // Geometry, textures and materials.
  Geometry geometry = pack_geometry(scene);
  out.centre = geometry.centre;
  PackedTextures textures = pack_textures(scene, geometry);
  PackedMaterials materials = pack_materials(scene, textures.row_of_texture);
  features.classes = materials.classes;
  features.textures = textures.kinds;
  features.triangles = !geometry.triangles.empty();
  features.curved = !geometry.curved.empty();
  features.vertex_normals = !geometry.normals.empty();
  PackedMedia media;
  if (is_volumetric(scene.integrator)) media = pack_media(scene, sensor, geometry.centre);
  set_media_features(scene, sensor, media, features);
  const bool surface_uv = std::any_of(features.classes.begin(), features.classes.end(), [](const MaterialClass& c) {
    return (c.flags & (gpu::kMaterialTextured | gpu::kMaterialTangent)) != 0;
  });
  const bool aov_uv = aov_needs_uv(scene_aovs(scene));

  // The tree; hits name leaves, so lights are packed after it.
  Timer bvh_timer;
  const BvhInput input{geometry.vertices, geometry.triangles, geometry.curved, geometry.shape_of_triangle};
  // Rays that pass what they meet know of the tree alone.
  BvhSettings settings;
  if (features.media == 0 && !scene.integrator.hide_emitters) settings.most_walls = gpu::kMaxWalls;
  out.bvh = build_bvh8(input, settings);
  features.walls = out.bvh.first_wall < out.bvh.leaves.size();
  out.bvh_seconds = bvh_timer.seconds();
  PackedLights lights = pack_lights(scene, geometry, out.bvh, textures);
  features.lights = lights.kinds;
  features.selection = lights.selection;
  features.light_textures = lights.textures;
  features.vertex_uv = surface_uv || lights.textures || aov_uv;

  // Shapes.
  std::vector<uint32_t> class_of_shape(scene.shapes.size());
  std::vector<bool> shape_emits(scene.shapes.size());
  for (size_t s = 0; s < scene.shapes.size(); ++s) {
    const Shape& shape = scene.shapes[s];
    const ShapeGeometry& range = geometry.shapes[s];
    const auto bsdf = static_cast<size_t>(shape.bsdf);
    class_of_shape[s] = materials.class_of_bsdf[bsdf];
    shape_emits[s] = lights.light_of_shape[s] != gpu::kNoIndex;
    uint32_t flags = 0;
    if (range.flip_normals) flags |= gpu::kShapeFlipNormals;
    if (range.has_uv) flags |= gpu::kShapeHasUv;
    if (range.has_normals) flags |= gpu::kShapeHasNormals;
    if (shape.is_medium_boundary) flags |= gpu::kShapeIsBoundary;
    out.shapes.push_back(uvec4(materials.row_of_bsdf[bsdf], lights.light_of_shape[s], flags,
                               media.index(shape.interior) | media.index(shape.exterior) << 16));
    const uint32_t triangles = std::holds_alternative<RectangleShape>(shape.kind) ? 2 : 1;  // a primitive
    out.shapes.push_back(uvec4(range.first_primitive, range.primitive_count, gpu::kNoIndex, triangles));
  }
  const std::vector<vec4> focusers = find_focusers(geometry, class_of_shape, features.classes);
  std::copy(focusers.begin(), focusers.end(), out.params.focusers);
  features.focusers = static_cast<uint32_t>(focusers.size());
  mark_leaves(scene, geometry, class_of_shape, shape_emits, out);
  put_vertices(geometry, out);
  put_primitives(geometry, out);

  out.materials = std::move(materials.rows);
  out.textures = std::move(textures.rows);
  out.texels8 = std::move(textures.texels8);
  out.texels16 = std::move(textures.texels16);
  out.texels32 = std::move(textures.texels32);
  out.attributes = std::move(textures.attributes);
  out.lights = std::move(lights.rows);
  out.light_table = std::move(lights.table);
  out.emission = std::move(lights.emission);
  out.environment = std::move(lights.environment);
  out.environment_cdf = std::move(lights.environment_cdf);
  out.media = std::move(media.rows);
  out.grids = std::move(media.grids);

  // Camera, film and paths.
  pack_camera(sensor, geometry.centre, out.params);
  features.camera = static_cast<uint32_t>(sensor.kind);
  features.filter = static_cast<uint32_t>(sensor.film.filter);
  set_path_features(scene, features);
  if (samples_segments(features)) features.media |= gpu::kMediaSegments;
  out.aovs = scene_aovs(scene, &out.sample_count_channel);
  out.params.class_count = static_cast<uint32_t>(features.classes.size());
  out.pack_seconds = timer.seconds() - out.bvh_seconds;
  return out;
}

}  // namespace tachylite
