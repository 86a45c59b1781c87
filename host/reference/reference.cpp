#include "reference/reference.h"

#include <atomic>

#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "reference/aov.h"
#include "reference/sensor.h"
#include "reference/world.h"

namespace tachylite {

using namespace reference;

struct ReferenceRenderer::Impl {
  struct Pixel {
    dvec3 sum{0}, sum_of_squares{0};
    std::vector<double> aovs;
  };

  Impl(const Scene& scene, int sensor_index, uint32_t seed_in, const std::vector<std::string>& aov_list)
      : world(scene),
        sensor(scene.sensors[static_cast<size_t>(sensor_index)]),
        seed(seed_in),
        aovs(aov_list) {
    const Film& film = sensor.film;
    pixels.resize(static_cast<size_t>(film.crop_width) * static_cast<size_t>(film.crop_height));
    for (Pixel& pixel : pixels) pixel.aovs.resize(aovs.channel_names().size());
  }

  void add_sample(size_t index, uint64_t sample, World::Counters& counters, uint64_t& dropped) {
    const Film& film = sensor.film;
    const int x = static_cast<int>(index) % film.crop_width, y = static_cast<int>(index) / film.crop_width;
    Random random(seed, index, sample);
    const Ray ray = sample_camera_ray(sensor, sample_film_position(film, x, y, random), random);
    const Integrator::Kind kind = world.scene.integrator.kind;
    const bool surfaces_only = kind == Integrator::Kind::kDirect || kind == Integrator::Kind::kPath;
    dvec3 radiance = surfaces_only ? trace_path(world, ray, random, counters)
                                   : trace_volpath(world, ray, sensor.medium, random, counters);
    if (!is_finite(radiance)) {
      radiance = dvec3(0);
      ++dropped;
    }
    Pixel& pixel = pixels[index];
    pixel.sum += radiance;
    pixel.sum_of_squares += radiance * radiance;

    std::vector<double> values;
    aovs.evaluate(world, ray, values);
    for (size_t i = 0; i < values.size(); ++i) pixel.aovs[i] += values[i];
  }

  /// Of the mean; from the sums of squares, unbiased.
  dvec3 variance(const Pixel& pixel) const {
    if (samples < 2) return dvec3(0);
    const double n = static_cast<double>(samples);
    const dvec3 mean = pixel.sum / n;
    return glm::max(dvec3(0), pixel.sum_of_squares / n - mean * mean) / (n - 1);
  }

  World world;
  const Sensor& sensor;
  uint32_t seed;
  Aovs aovs;
  std::vector<Pixel> pixels;
  uint64_t samples = 0;
  std::atomic<uint64_t> nonfinite{0}, closest_rays{0}, shadow_rays{0};
};

ReferenceRenderer::ReferenceRenderer(const Scene& scene, int sensor, uint32_t seed,
                                     const std::vector<std::string>& aovs) {
  if (sensor < 0 || static_cast<size_t>(sensor) >= scene.sensors.size()) {
    throw InputError(scene.path + ": has no sensor " + std::to_string(sensor) + ", expected one below " +
                     std::to_string(scene.sensors.size()));
  }
  std::vector<std::string> all = scene.integrator.aovs;
  all.insert(all.end(), aovs.begin(), aovs.end());
  impl_ = std::make_unique<Impl>(scene, sensor, seed, all);
}
ReferenceRenderer::~ReferenceRenderer() = default;

void ReferenceRenderer::add_samples(uint64_t first, uint64_t count) {
  Impl& impl = *impl_;
  constexpr size_t kPixelsAtOnce = 64;
  parallel_for(0, impl.pixels.size(), kPixelsAtOnce, [&](size_t begin, size_t end) {
    World::Counters counters;
    uint64_t dropped = 0;
    for (size_t pixel = begin; pixel < end; ++pixel) {
      for (uint64_t s = first; s < first + count; ++s) impl.add_sample(pixel, s, counters, dropped);
    }
    impl.nonfinite += dropped;
    impl.closest_rays += counters.closest_rays;
    impl.shadow_rays += counters.shadow_rays;
  });
  impl.samples += count;
}

ReferenceImage ReferenceRenderer::image() const {
  const Impl& impl = *impl_;
  ReferenceImage image;
  image.width = impl.sensor.film.crop_width;
  image.height = impl.sensor.film.crop_height;
  image.samples = impl.samples;
  for (const std::string& name : impl.aovs.channel_names()) image.aovs.push_back({name, {}});
  const double n = static_cast<double>(std::max<uint64_t>(impl.samples, 1));
  for (const Impl::Pixel& pixel : impl.pixels) {
    image.mean.push_back(pixel.sum / n);
    image.variance.push_back(impl.variance(pixel));
    for (size_t i = 0; i < image.aovs.size(); ++i) image.aovs[i].values.push_back(pixel.aovs[i] / n);
  }
  if (const std::string& name = impl.aovs.sample_count_channel(); !name.empty())
    image.aovs.push_back({name, std::vector<double>(impl.pixels.size(), static_cast<double>(impl.samples))});
  image.nonfinite = impl.nonfinite;
  image.closest_rays = impl.closest_rays;
  image.shadow_rays = impl.shadow_rays;
  return image;
}

double ReferenceRenderer::relative_error() const {
  const Impl& impl = *impl_;
  if (impl.samples < 2) return kInfinity;
  double variance = 0, mean = 0;
  for (const Impl::Pixel& pixel : impl.pixels) {
    variance += luminance(impl.variance(pixel));
    mean += luminance(pixel.sum);
  }
  const double pixels = static_cast<double>(impl.pixels.size());
  mean /= pixels * static_cast<double>(impl.samples);
  if (!(mean > 0)) return variance > 0 ? kInfinity : 0;
  return std::sqrt(variance / pixels) / mean;
}

ReferenceImage render_reference(const Scene& scene, const ReferenceOptions& options) {
  const Timer timer;
  ReferenceRenderer renderer(scene, options.sensor, options.seed, options.aovs);
  const Sensor& sensor = scene.sensors[static_cast<size_t>(options.sensor)];
  const uint64_t wanted =
      options.samples > 0 ? options.samples : static_cast<uint64_t>(std::max(1, sensor.sample_count));
  uint64_t done = 0;
  while (done < wanted && timer.seconds() < options.seconds) {
    const uint64_t pass = std::min<uint64_t>(4, wanted - done);
    renderer.add_samples(options.first_sample + done, pass);
    done += pass;
    if (options.progress && !options.progress({done, wanted, timer.seconds(), renderer.relative_error()})) {
      break;
    }
  }
  return renderer.image();
}

Image to_image(const ReferenceImage& reference, bool moment) {
  Image image;
  image.width = reference.width;
  image.height = reference.height;
  const auto add = [&](const std::string& name, const auto& value) {
    std::vector<float>& channel = image.add(name);
    for (size_t i = 0; i < channel.size(); ++i) channel[i] = static_cast<float>(value(i));
  };
  const double n = static_cast<double>(reference.samples);
  for (int c = 0; c < 3; ++c) {
    const std::string name(1, "RGB"[c]);
    const auto& mean = reference.mean;
    const auto& variance = reference.variance;
    add(name, [&](size_t i) { return mean[i][c]; });
    add("variance." + name, [&](size_t i) { return variance[i][c]; });
    if (moment) add("m2_" + name, [&](size_t i) { return variance[i][c] * (n - 1) + sqr(mean[i][c]); });
  }
  for (const ReferenceImage::Channel& aov : reference.aovs)
    add(aov.name, [&](size_t i) { return aov.values[i]; });
  return image;
}

}  // namespace tachylite
