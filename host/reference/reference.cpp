#include "reference/reference.h"

#include <atomic>

#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "reference/aov.h"
#include "reference/sensor.h"
#include "reference/world.h"
#include "shared/sampler.h"

namespace tachylite {

using namespace reference;

struct ReferenceRenderer::Impl {
  Impl(const Scene& scene, int sensor_index, uint32_t seed_in, const std::vector<std::string>& aov_list)
      : world(scene),
        sensor(scene.sensors[static_cast<size_t>(sensor_index)]),
        seed(seed_in),
        aovs(aov_list),
        film(sensor.film.crop_width, sensor.film.crop_height, extra_channels(), aovs.sample_count_channel()) {}

  std::vector<std::string> extra_channels() const {
    std::vector<std::string> names = aovs.channel_names();
    if (world.scene.integrator.moment) names.insert(names.end(), {"m2_R", "m2_G", "m2_B"});
    return names;
  }

  void add_sample(size_t index, uint64_t sample, World::Counters& counters, uint64_t& dropped) {
    const int x = static_cast<int>(index) % film.width(), y = static_cast<int>(index) / film.width();
    Random random(seed, index, sample);
    const Ray ray = sample_camera_ray(sensor, sample_film_position(sensor.film, x, y, random), random);
    const Integrator::Kind kind = world.scene.integrator.kind;
    const bool surfaces_only = kind == Integrator::Kind::kDirect || kind == Integrator::Kind::kPath;
    dvec3 radiance = surfaces_only ? trace_path(world, ray, random, counters)
                                   : trace_volpath(world, ray, sensor.medium, random, counters);
    if (!is_finite(radiance)) {
      radiance = dvec3(0);
      ++dropped;
    }
    film.add_block(index, radiance, 1);

    std::vector<double> values;
    aovs.evaluate(world, ray, values);
    if (world.scene.integrator.moment)
      for (int c = 0; c < 3; ++c) values.push_back(sqr(radiance[c]));
    for (size_t i = 0; i < values.size(); ++i) film.add_extra(index, i, values[i]);
  }

  World world;
  const Sensor& sensor;
  uint32_t seed;
  Aovs aovs;
  FilmBuffer film;
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
  parallel_for(0, impl.film.pixels(), kPixelsAtOnce, [&](size_t begin, size_t end) {
    World::Counters counters;
    uint64_t dropped = 0;
    for (size_t pixel = begin; pixel < end; ++pixel) {
      for (uint64_t s = first; s < first + count; ++s) impl.add_sample(pixel, s, counters, dropped);
    }
    impl.nonfinite += dropped;
    impl.closest_rays += counters.closest_rays;
    impl.shadow_rays += counters.shadow_rays;
  });
  impl.film.finish_blocks({first, count}, count);
}

void ReferenceRenderer::add_film(const FilmBuffer& film) { impl_->film.merge(film); }

ReferenceImage ReferenceRenderer::image() const {
  const Impl& impl = *impl_;
  ReferenceImage image{.film = impl.film};
  image.width = impl.film.width();
  image.height = impl.film.height();
  image.samples = impl.film.samples();
  for (size_t i = 0; i < impl.film.pixels(); ++i) {
    image.mean.push_back(impl.film.mean(i));
    image.variance.push_back(impl.film.variance_of_mean(i));
  }
  for (size_t c = 0; c < impl.film.extra_channels().size(); ++c) {
    image.aovs.push_back({impl.film.extra_channels()[c], {}});
    for (size_t i = 0; i < impl.film.pixels(); ++i) image.aovs[c].values.push_back(impl.film.extra_mean(i, c));
  }
  if (const std::string& name = impl.aovs.sample_count_channel(); !name.empty())
    image.aovs.push_back({name, std::vector<double>(impl.film.pixels(), static_cast<double>(image.samples))});
  image.nonfinite = impl.nonfinite;
  image.closest_rays = impl.closest_rays;
  image.shadow_rays = impl.shadow_rays;
  return image;
}

double ReferenceRenderer::relative_error() const {
  return impl_->film.has_variance() ? impl_->film.relative_error() : kInfinity;
}

ReferenceImage render_reference(const Scene& scene, const ReferenceOptions& options) {
  const Timer timer;
  ReferenceRenderer renderer(scene, options.sensor, options.seed, options.aovs);
  const Sensor& sensor = scene.sensors[static_cast<size_t>(options.sensor)];
  const uint64_t wanted =
      options.samples > 0 ? options.samples : static_cast<uint64_t>(std::max(1, sensor.sample_count));
  uint64_t done = 0;
  if (options.begun) {
    renderer.add_film(*options.begun);
    done = options.begun->samples();
  }
  constexpr uint64_t kEndSample = uint64_t{1} << gpu::kMaxSampleBits;  // as on the device
  if (wanted > kEndSample || options.first_sample > kEndSample - wanted)
    throw InputError(fmt::format("samples must lie in 1..{} together with the first sample", kEndSample));
  if (wanted > ReproducibleSums::kMaxValues)
    throw InputError(fmt::format("a film of the reference holds at most {} samples", ReproducibleSums::kMaxValues));
  constexpr double kLongPass = 1;  // s; passes of one sample are interrupted sooner
  double pass_seconds = 0;
  while (done < wanted && timer.seconds() < options.seconds) {
    const uint64_t pass = std::min<uint64_t>(pass_seconds > kLongPass ? 1 : 4, wanted - done);
    const Timer pass_timer;
    renderer.add_samples(options.first_sample + done, pass);
    pass_seconds = pass_timer.seconds();
    done += pass;
    if (options.progress && !options.progress({done, wanted, timer.seconds(), renderer.relative_error()})) {
      break;
    }
  }
  return renderer.image();
}

}  // namespace tachylite
