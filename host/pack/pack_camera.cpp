#include "pack/pack_camera.h"

#include <cmath>

namespace tachylite {

void pack_camera(const Sensor& sensor, const glm::dvec3& centre, gpu::RenderParams& params) {
  const Film& film = sensor.film;
  gpu::CameraParams& camera = params.camera;
  const bool orthographic = sensor.kind == Sensor::Kind::kOrthographic;

  const auto axis = [&](int column) {
    const glm::dvec3 a(sensor.to_world[column]);
    // An orthographic film is scaled by to_world; directions of the others are unit.
    return orthographic && column < 2 ? a : glm::normalize(a);
  };
  camera.right = glm::vec4(glm::vec3(-axis(0)), 0);
  camera.up = glm::vec4(glm::vec3(axis(1)), 0);
  camera.forward = glm::vec4(glm::vec3(axis(2)), 0);
  // Rays begin at near_clip of the camera's own space, which an orthographic to_world scales, but are far - near long
  // in the world, as Mitsuba's.
  const glm::dvec3 depth(sensor.to_world[2]);
  const glm::dvec3 moved = orthographic ? sensor.near_clip * (depth - glm::normalize(depth)) : glm::dvec3(0);
  camera.position = glm::vec4(glm::vec3(glm::dvec3(sensor.to_world[3]) + moved - centre), 1);

  // Film position in pixels of the full film (x right, y down) -> plane z = 1 (right, up).
  const double half_width = orthographic ? 1.0 : std::tan(0.5 * sensor.x_fov);
  const double half_height = half_width * film.height / film.width;
  const glm::dvec2 principal = sensor.principal_point_offset;
  camera.scale_offset = glm::vec4(2 * half_width / film.width, -2 * half_height / film.height,
                                  half_width * (2 * principal.x - 1), half_height * (1 - 2 * principal.y));
  camera.near_clip = static_cast<float>(sensor.near_clip);
  camera.far_clip = static_cast<float>(sensor.far_clip);
  camera.aperture_radius = static_cast<float>(sensor.aperture_radius);
  camera.focus_distance = static_cast<float>(sensor.focus_distance);

  params.width = static_cast<uint32_t>(film.crop_width);
  params.height = static_cast<uint32_t>(film.crop_height);
  params.crop_x = static_cast<uint32_t>(film.crop_x);
  params.crop_y = static_cast<uint32_t>(film.crop_y);
  params.film_width = static_cast<uint32_t>(film.width);
  params.tiles_x = (params.width + gpu::kTileSize - 1) / gpu::kTileSize;
  params.tile_count = params.tiles_x * ((params.height + gpu::kTileSize - 1) / gpu::kTileSize);
  params.filter_radius = static_cast<float>(film.filter_radius);
  params.filter_stddev = static_cast<float>(film.gaussian_stddev);
}

}  // namespace tachylite
