#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "shared/features.h"

namespace tachylite {

/// A group of materials that one shade_surface pipeline serves: those with the same leaf types, flags and textured
/// inputs. bsdfs = 1 << kBsdfNull alone: only `null`.
struct MaterialClass {
  uint32_t bsdfs = 0;       // set of 1 << kBsdf...
  uint32_t flags = 0;       // kMaterial...
  uint32_t max_leaves = 0;  // other than null, in one list
  uint32_t textured = 0;    // kFeatureTexturedInputs
  bool operator==(const MaterialClass&) const = default;
};

/// What a scene needs, computed once from its packed form: decides which kernels exist, what they are compiled for
/// and which buffers are allocated.
struct FeatureSet {
  bool curved = false, triangles = false, walls = false, vertex_normals = false, vertex_uv = false;
  std::vector<MaterialClass> classes;
  uint32_t camera = gpu::kCameraPerspective, filter = gpu::kFilterBox;
  uint32_t max_depth = 0xffffffffu, roulette_depth = 5, strategy = gpu::kStrategyMis;
  bool hide_emitters = false;
  uint32_t lights = 0;                        // set of 1 << kLight...
  uint32_t selection = gpu::kSelectNone;
  bool light_textures = false;
  uint32_t textures = 0;                      // kTextures...
  uint32_t media = 0;                         // kMedia...
  uint32_t camera_medium = 0xffffu;
  bool shadow_null = false;
  uint32_t aovs = 0;
  uint32_t focusers = 0;                      // spheres in RenderParams::focusers

  bool has_light(uint32_t kind) const { return (lights >> kind) & 1u; }
  bool area_lights() const;   // some shape emits: the stage shade_emitter exists
  bool has_media() const;     // the stages sample_medium and shade_medium exist
  bool environment() const;   // constant or envmap: the stage shade_escaped exists

  /// Values of all specialization constants but those of a material class and of the sampler.
  std::map<uint32_t, uint32_t> constants() const;
  /// The same with the constants of class `index`.
  std::map<uint32_t, uint32_t> class_constants(size_t index) const;
  /// A class that has what any class has: kernels compiled for it serve the materials of all.
  MaterialClass union_class() const;
  /// constants() with those of union_class().
  std::map<uint32_t, uint32_t> union_constants() const;
  /// "area lights", "8-bit sRGB textures", ... for people: what is there, and what is not.
  std::vector<std::string> present() const, absent() const;
};

}  // namespace tachylite
