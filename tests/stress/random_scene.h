#pragma once

// Scenes made at random from everything that the scene format knows: shapes and small meshes, materials with adapters
// around them, textures, homogeneous and grid media, lights, cameras, filters and integrators. From kFirstWideSeed on
// also auxiliary channels, ways to sample light, PNG and EXR files, media within media, and scenes a thousand times
// smaller to ten thousand times larger; from kFirstNestedSeed on normal and bump maps inside one another and inside
// `twosided`, and checkerboards of textures.

#include <cstdint>
#include <string>

#include "stress/random_source.h"
#include "stress/scene_text.h"

namespace tachylite::test {

/// Seeds with one quotient share a theme (random_source.h).
constexpr uint64_t kScenesOfTheme = 16;

/// Seeds below have made their scenes since before there were others, and still do.
constexpr uint64_t kFirstWideSeed = 10'000'000;
constexpr uint64_t kFirstNestedSeed = 20'000'000;

/// The same on every machine. About the unit ball (but for what scale_scene does to it), the camera 2.5 to 5 away from
/// the centre.
SceneText random_scene(uint64_t seed);

// The parts, a file each.

struct BsdfChoice {
  bool transmits = true;   // may let light through to the other side
  bool bumped = true;      // may be a normal or bump map
  int adapters = 2;        // at most this many around each other
  bool attribute = false;  // the shape has the mesh attribute vertex_color
};
Element random_bsdf(RandomSource& random, SceneText& scene, const BsdfChoice& choice);
/// A <texture> of that name; `low`, `high`: its values. Grey where `grey`.
Element random_texture(RandomSource& random, SceneText& scene, const std::string& name, double low, double high,
                       bool grey, bool attribute = false);
/// What a `bitmap` or an `envmap` names: adds a file to the scene and returns its name. Values in [low, high]; those
/// of formats of 8 bits are cut at 1.
std::string random_image(RandomSource& random, SceneText& scene, double low, double high, bool grey, bool floats);

struct ShapeChoice {
  double low = 0.2, high = 0.8;  // size
  double reach = 1;              // centre within [-reach, reach]^3
  bool closed = false;           // a sphere, cube or closed mesh: for media
};
/// Without bsdf and emitter. Meshes may come with vertex_color: `attribute` says so.
Element random_shape(RandomSource& random, SceneText& scene, const ShapeChoice& choice, bool& attribute);

/// Adds one emitter, or a shape that emits.
void add_random_light(RandomSource& random, SceneText& scene, bool& has_environment);

/// <medium name="side">
Element random_medium(RandomSource& random, SceneText& scene, const std::string& side);
/// Adds a closed shape with a medium, and within it others that name it as their exterior.
void add_nested_media(RandomSource& random, SceneText& scene);

}  // namespace tachylite::test
