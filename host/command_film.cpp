#include "command_film.h"

#include <algorithm>
#include <cstdlib>
#include <regex>

#include "base/error.h"
#include "base/fingerprint.h"
#include "base/log.h"
#include "command_output.h"
#include "image/exr.h"

namespace tachylite {
namespace {

constexpr const char* kIdentityKeys[] = {"fingerprint", "sensor", "seed", "sampler", "device", "driver", "version"};

/// Samples that both have.
std::vector<SampleRange> common_ranges(const FilmBuffer& a, const FilmBuffer& b) {
  std::vector<SampleRange> common;
  for (const SampleRange& x : a.ranges())
    for (const SampleRange& y : b.ranges()) {
      const uint64_t first = std::max(x.first, y.first), end = std::min(x.end(), y.end());
      if (first < end) common.push_back({first, end - first});
    }
  return common;
}

RenderIdentity identity_of(const StoredFilm& stored) {
  RenderIdentity identity;
  for (const char* key : kIdentityKeys) {
    const auto found = stored.metadata.find(key);
    if (found == stored.metadata.end()) throw InputError(fmt::format("{}: has no attribute {}", stored.place, key));
    identity.insert(*found);
  }
  return identity;
}

}  // namespace

RenderIdentity render_identity(const Scene& scene, int sensor, uint32_t seed, const std::string& sampler,
                               const std::string& device, const std::string& driver) {
  Fingerprint fingerprint;
  fingerprint.add(scene.description);
  for (const std::string& file : scene.files) fingerprint.add_file(file);
  // Lavapipe's name ends with the width of its vectors, on which no bit of an image depends.
  static const std::regex width(", [0-9]+ bits\\)$");
  return {{"fingerprint", fingerprint.text()},
          {"sensor", std::to_string(sensor)},
          {"seed", std::to_string(seed)},
          {"sampler", sampler},
          {"device", std::regex_replace(device, width, ")")},
          {"driver", driver},
          {"version", TACHYLITE_VERSION}};
}

StoredFilm read_film(const std::filesystem::path& file) {
  const Image image = read_exr(file);
  return {file.string(), FilmBuffer::from_image(image, file.string()), image.metadata};
}

void require_same_render(const StoredFilm& stored, const RenderIdentity& identity, const FilmBuffer& film,
                         const std::string& who) {
  for (const auto& [key, value] : identity_of(stored)) {
    const std::string name = key == "fingerprint" ? "scene" : key;
    if (identity.at(key) != value)
      throw InputError(key == "fingerprint"
                           ? fmt::format("{}: is of another scene than {}", stored.place, who)
                           : fmt::format("{}: {} is {}, that of {} {}", stored.place, name, value, who, identity.at(key)));
  }
  if (stored.film.width() != film.width() || stored.film.height() != film.height())
    throw InputError(fmt::format("{}: has {} x {} pixels, {} {} x {}", stored.place, stored.film.width(),
                                 stored.film.height(), who, film.width(), film.height()));
  std::vector<std::string> a = stored.film.extra_channels(), b = film.extra_channels();
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  if (a != b)
    throw InputError(fmt::format("{}: has the channels ({}), {} ({})", stored.place, fmt::join(a, " "), who,
                                 fmt::join(b, " ")));
}

int run_merge(const MergeArguments& arguments) {
  const OutputFiles outputs = check_outputs(arguments.outputs, {});
  StoredFilm merged = read_film(arguments.inputs.front());
  const RenderIdentity identity = identity_of(merged);
  double seconds = std::atof(merged.metadata["seconds"].c_str());
  for (size_t i = 1; i < arguments.inputs.size(); ++i) {
    const StoredFilm next = read_film(arguments.inputs[i]);
    require_same_render(next, identity, merged.film, merged.place);
    if (const std::vector<SampleRange> common = common_ranges(merged.film, next.film); !common.empty())
      throw InputError(fmt::format("{}: samples {} are in files before it, too", next.place, format_ranges(common)));
    if (merged.film.blocks() + next.film.blocks() > ReproducibleSums::kMaxValues)
      throw InputError(fmt::format("{}: with it and the files before it a pixel would have {} blocks of samples, but its "
                                   "sums hold at most {}",
                                   next.place, merged.film.blocks() + next.film.blocks(), ReproducibleSums::kMaxValues));
    merged.film.merge(next.film);
    const auto found = next.metadata.find("seconds");
    if (found != next.metadata.end()) seconds += std::atof(found->second.c_str());
  }
  Image image = merged.film.to_image(true);
  merged.metadata["spp"] = fmt::format("{}", merged.film.samples());
  merged.metadata["first_sample"] = fmt::format("{}", merged.film.ranges().front().first);
  merged.metadata["seconds"] = fmt::format("{:.3f}", seconds);
  image.metadata.merge(merged.metadata);
  write_outputs(outputs, image);
  const bool whole = merged.film.ranges().size() == 1;
  log_info(fmt::format("samples {}{}, {}", format_ranges(merged.film.ranges()), whole ? "" : " (with gaps)",
                       outputs.front().string()));
  return 0;
}

}  // namespace tachylite
