#include "reference/sensor.h"

namespace tachylite::reference {
namespace {

/// Offset from the pixel's centre with the density of the filter. Mitsuba's gaussian is lowered to reach 0 at
/// its radius: exp(-x^2 / (2 s^2)) - exp(-r^2 / (2 s^2)).
double sample_filter(const Film& film, Random& random) {
  const double r = film.filter_radius;
  switch (film.filter) {
    case ReconstructionFilter::kBox:
      return r * (2 * random.uniform() - 1);
    case ReconstructionFilter::kTent:
      return r * (random.uniform() - random.uniform());
    case ReconstructionFilter::kGaussian:
      for (;;) {
        const double x = r * (2 * random.uniform() - 1), a = 0.5 / sqr(film.gaussian_stddev);
        if (random.uniform() < std::exp(-a * x * x) - std::exp(-a * r * r)) return x;
      }
  }
  return 0;
}

double sample_position(const Film& film, int pixel, int begin, int size, Random& random) {
  for (;;) {
    const double position = begin + pixel + 0.5 + sample_filter(film, random);
    if (position >= begin && position < begin + size) return position;
  }
}

}  // namespace

dvec2 sample_film_position(const Film& film, int x, int y, Random& random) {
  const double film_x = sample_position(film, x, film.crop_x, film.crop_width, random);
  return {film_x, sample_position(film, y, film.crop_y, film.crop_height, random)};
}

Ray sample_camera_ray(const Sensor& sensor, const dvec2& film_position, Random& random) {
  const Film& film = sensor.film;
  const dvec2 sample = film_position / dvec2(film.width, film.height) + sensor.principal_point_offset;
  const double aspect = static_cast<double>(film.width) / film.height;
  const dvec2 screen((1 - 2 * sample.x), (1 - 2 * sample.y) / aspect);

  // A line in camera space, origin at z = 0.
  dvec3 origin(0), direction(0, 0, 1);
  if (sensor.kind == Sensor::Kind::kOrthographic) {
    origin = dvec3(screen, 0);
  } else {
    direction = dvec3(screen * std::tan(0.5 * sensor.x_fov), 1);
    if (sensor.kind == Sensor::Kind::kThinLens) {
      origin = dvec3(sensor.aperture_radius * sample_disk(random.uniform2()), 0);
      direction = direction * sensor.focus_distance - origin;
    }
  }

  // Clip it and take it to the world.
  const double near = sensor.near_clip / direction.z, far = sensor.far_clip / direction.z;
  const dvec3 world_direction = transform_vector(sensor.to_world, direction);
  const double length = glm::length(world_direction);
  // Mitsuba scales the near plane of an orthographic camera by to_world, but not the length of its rays.
  const double unit = sensor.kind == Sensor::Kind::kOrthographic ? 1 : length;
  return {transform_point(sensor.to_world, origin + near * direction), world_direction / length,
          (far - near) * unit};
}

}  // namespace tachylite::reference
