#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "image/film.h"
#include "scene/scene.h"

namespace tachylite {

/// What renders must have in common for their samples to belong to one image: attributes of their files.
using RenderIdentity = std::map<std::string, std::string>;

/// fingerprint (of the scene with all files it refers to), sensor, seed, sampler, device, driver, version.
RenderIdentity render_identity(const Scene& scene, int sensor, uint32_t seed, const std::string& sampler,
                               const std::string& device, const std::string& driver);

/// A film as it was written by render, reference or merge.
struct StoredFilm {
  std::string place;  // the file's name
  FilmBuffer film;
  std::map<std::string, std::string> metadata;
};

/// Throws InputError when the file is no image with sums.
StoredFilm read_film(const std::filesystem::path& file);

/// Throws InputError where the films cannot be of one image: another identity, size or set of channels. `who` says
/// whose `identity` and `film` are, "B.exr" or "this render".
void require_same_render(const StoredFilm& stored, const RenderIdentity& identity, const FilmBuffer& film,
                         const std::string& who);

struct MergeArguments {
  std::vector<std::filesystem::path> inputs, outputs;
  bool quiet = false;
};

/// Joins films of disjoint samples to that of all of them; in any order, with the same result. Returns the exit code.
int run_merge(const MergeArguments& arguments);

}  // namespace tachylite
