#include "measure/measure_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/error.h"
#include "measure/color_map.h"
#include "measure/convergence.h"
#include "measure/image_error.h"

namespace tachylite {
namespace {

/// The draws behind a level's figures, from which those of the curve are made.
struct LevelDraws {
  Replicates rel_mse, seconds;
};

struct Track {
  const Contestant* contestant = nullptr;
  RendererMeasurement measurement;
  std::vector<LevelDraws> draws;   // as measurement.levels
  std::vector<Image> first_images;  // of the first seed, as measurement.levels
  std::vector<float> error_map;     // of pictured_samples
};

double clock_seconds(const Seconds& seconds, const MeasureOptions& options) {
  return options.cpu_clock ? seconds.cpu / options.cores : seconds.wall;
}

/// Draws are taken with a seed of their own each, so that no two figures share theirs.
uint64_t draw_seed(const std::string& name, uint64_t samples, int which) {
  return std::hash<std::string>{}(name) ^ (samples * 4 + static_cast<uint64_t>(which));
}

void add_level(Track& track, uint64_t samples, const std::vector<std::vector<double>>& errors, size_t fitted,
               std::span<const Seconds> render, std::span<const Seconds> total, const MeasureOptions& options) {
  const auto clocked = [&](std::span<const Seconds> all) {
    std::vector<double> seconds;
    for (const Seconds& s : all) seconds.push_back(clock_seconds(s, options));
    return seconds;
  };
  const auto mean = [](std::span<const Seconds> all) {
    Seconds sum;
    for (const Seconds& s : all) sum = {sum.cpu + s.cpu, sum.wall + s.wall};
    const double n = static_cast<double>(all.size());
    return Seconds{sum.cpu / n, sum.wall / n};
  };
  const std::string& name = track.contestant->name;
  LevelDraws draws{bootstrap_blocks(errors, fitted, draw_seed(name, samples, 0)),
                   bootstrap_mean(clocked(render), draw_seed(name, samples, 1))};
  LevelMeasurement level;
  level.samples = samples;
  level.rel_mse = estimate(draws.rel_mse);
  level.seconds = estimate(draws.seconds);
  level.total_seconds = estimate(bootstrap_mean(clocked(total), draw_seed(name, samples, 2)));
  level.efficiency =
      estimate(combine(draws.rel_mse, draws.seconds, [](double error, double seconds) { return 1 / (error * seconds); }));
  level.render = mean(render);
  level.total = mean(total);
  track.measurement.levels.push_back(level);
  track.draws.push_back(std::move(draws));
}

/// Times to the target errors, on the curve and on each of its draws.
void add_times(Track& track) {
  RendererMeasurement& m = track.measurement;
  if (m.levels.size() < 2) return;
  std::vector<TimedError> curve(m.levels.size());
  for (size_t i = 0; i < curve.size(); ++i) curve[i] = {m.levels[i].seconds.value, m.levels[i].rel_mse.value};
  if (!std::all_of(curve.begin(), curve.end(), [](const TimedError& p) { return p.seconds > 0 && p.error > 0; })) return;
  m.exponent = convergence_exponent(curve);
  for (double target : kTargetErrors) {
    const TimeToError reached = time_to_error(curve, target);
    Replicates replicates{reached.seconds, {}};
    for (size_t r = 0; r < kReplicates; ++r) {
      std::vector<TimedError> drawn(curve.size());
      for (size_t i = 0; i < curve.size(); ++i)
        drawn[i] = {track.draws[i].seconds.drawn[r], std::max(track.draws[i].rel_mse.drawn[r], 1e-30)};
      replicates.drawn.push_back(time_to_error(drawn, target).seconds);
    }
    m.times.push_back({target, estimate(replicates), reached.extrapolated});
  }
}

void check_size(const Image& image, const std::string& name, SceneMeasurement& result) {
  if (result.width == 0) result.width = image.width, result.height = image.height;
  if (image.width != result.width || image.height != result.height)
    throw InputError(fmt::format("{} is {} x {} pixels, but {} x {} are expected", name, image.width, image.height,
                                 result.width, result.height));
}

std::array<double, 3> mean_color(const Image& image) {
  std::array<double, 3> mean{};
  for (size_t c = 0; c < 3; ++c)
    mean[c] = std::accumulate(image.channels[c].begin(), image.channels[c].end(), 0.0) /
              static_cast<double>(image.channels[c].size());
  return mean;
}

void add_pictures(SceneMeasurement& result, std::span<const Track> tracks, const Image& best, uint64_t pictured) {
  for (const Track& track : tracks)
    for (size_t i = 0; i < track.first_images.size(); ++i) {
      const uint64_t samples = track.measurement.levels[i].samples;
      if (samples == pictured || (&track == tracks.data() && i == 0))
        result.pictures.push_back({fmt::format("{}, {} samples", track.contestant->name, samples), track.first_images[i]});
    }
  result.pictures.push_back({"best known", best});
  for (const Track& track : tracks)
    result.pictures.push_back({fmt::format("error of {}, {} samples", track.contestant->name, pictured),
                               color_map(result.width, result.height, track.error_map)});
}

}  // namespace

std::vector<uint64_t> sample_levels(const MeasureOptions& options) {
  std::vector<uint64_t> levels;
  for (uint64_t samples = options.least_samples; samples <= options.most_samples; samples *= 2) levels.push_back(samples);
  return levels;
}

void measure_scene(SceneMeasurement& result, std::span<const Contestant> contestants, const Image* reference,
                   const MeasureOptions& options) {
  const std::vector<uint64_t> levels = sample_levels(options);
  const auto takes_part = [](const Contestant& contestant, uint64_t samples) {
    return contestant.most_samples == 0 || samples <= contestant.most_samples;
  };
  uint64_t pictured = 0;  // the most samples that all take
  double all = 0, done = 0;
  for (uint64_t samples : levels) {
    const auto taking = std::count_if(contestants.begin(), contestants.end(),
                                      [&](const Contestant& c) { return takes_part(c, samples); });
    all += static_cast<double>(samples) * static_cast<double>(taking);
    if (static_cast<size_t>(taking) == contestants.size()) pictured = samples;
  }
  if (pictured == 0) throw InputError("there is no number of samples that all renderers take part in");

  std::vector<Track> tracks(contestants.size());
  for (size_t t = 0; t < tracks.size(); ++t) {
    tracks[t].contestant = &contestants[t];
    tracks[t].measurement.name = contestants[t].name;
  }
  if (reference) check_size(*reference, "the reference", result);
  std::optional<ErrorScale> scale;
  if (reference) scale.emplace(*reference);
  result.seeds = options.seeds;
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    std::vector<std::vector<Image>> images(tracks.size());
    std::vector<std::vector<Seconds>> render(tracks.size()), total(tracks.size());
    for (int s = 0; s < options.seeds; ++s)
      for (size_t t = 0; t < tracks.size(); ++t) {
        const Contestant& contestant = contestants[t];
        if (!takes_part(contestant, *level)) continue;
        const uint32_t seed = options.first_seed + static_cast<uint32_t>(s);
        if (options.progress)
          options.progress(fmt::format("{}: {} samples, seed {}", contestant.name, *level, seed), done / all);
        TimedImage timed = contestant.render(*level, seed);
        check_size(timed.image, "the image of " + contestant.name, result);
        images[t].push_back(std::move(timed.image));
        render[t].push_back(timed.render);
        total[t].push_back(timed.total);
        done += static_cast<double>(*level) / options.seeds;
      }
    if (!scale) scale.emplace(mean_of(images[0]));
    for (size_t t = 0; t < tracks.size(); ++t) {
      if (images[t].empty()) continue;
      Track& track = tracks[t];
      if (track.measurement.levels.empty()) track.measurement.mean = mean_color(mean_of(images[t]));
      add_level(track, *level,
                reference ? errors_against(images[t], *reference, *scale) : deviations(images[t], *scale), reference ? 1 : 2,
                render[t], total[t], options);
      track.first_images.push_back(images[t][0]);
      if (*level == pictured)
        track.error_map = reference ? error_map(images[t], scale->image(), *scale, false)
                                    : error_map(images[t], mean_of(images[t]), *scale, true);
    }
  }
  result.epsilon = scale->epsilon();
  for (Track& track : tracks) {
    std::reverse(track.measurement.levels.begin(), track.measurement.levels.end());
    std::reverse(track.draws.begin(), track.draws.end());
    std::reverse(track.first_images.begin(), track.first_images.end());
    add_times(track);
    result.renderers.push_back(track.measurement);
  }
  add_pictures(result, tracks, scale->image(), pictured);
}

}  // namespace tachylite
