#include "pack/feature_set.h"

#include <algorithm>

#include "shared/aov.h"
#include "shared/material.h"
#include "shared/medium.h"
#include "shared/texture.h"

namespace tachylite {
namespace {

struct Named {
  bool present;
  const char* name;
};

std::vector<Named> named_features(const FeatureSet& f) {
  const auto light = [&](uint32_t kind) { return f.has_light(kind); };
  const auto material = [&](uint32_t flag) {
    return std::any_of(f.classes.begin(), f.classes.end(), [&](const MaterialClass& c) { return (c.flags & flag) != 0; });
  };
  return {{f.triangles, "triangles"},
          {f.walls, "walls outside of the tree"},
          {f.curved, "spheres, disks and cylinders"},
          {f.vertex_normals, "vertex normals"},
          {f.vertex_uv, "texture coordinates"},
          {(f.textures & gpu::kTexturesBitmap) != 0, "bitmap textures"},
          {(f.textures & gpu::kTexturesCheckerboard) != 0, "checkerboards"},
          {(f.textures & gpu::kTexturesNested) != 0, "checkerboards of textures"},
          {(f.textures & gpu::kTexturesAttribute) != 0, "mesh attributes"},
          {material(gpu::kMaterialHasWeights), "blended or masked materials"},
          {material(gpu::kMaterialHasFrames), "normal or bump maps"},
          {material(gpu::kMaterialNestedFrames), "maps inside maps"},
          {f.classes.size() > 1, "several material classes"},
          {f.area_lights(), "area lights"},
          {light(gpu::kLightPoint), "point lights"},
          {light(gpu::kLightSpot), "spot lights"},
          {light(gpu::kLightDirectional), "directional lights"},
          {light(gpu::kLightProjector), "projectors"},
          {light(gpu::kLightConstant), "constant environment"},
          {light(gpu::kLightEnvironment), "environment map"},
          {f.selection > gpu::kSelectSingle, "choice among lights"},
          {f.camera == gpu::kCameraThinLens, "lens"},
          {f.roulette_depth < f.max_depth, "Russian roulette"},
          {(f.media & gpu::kMediaHomogeneous) != 0, "homogeneous media"},
          {(f.media & gpu::kMediaGrids) != 0, "media on grids"},
          {(f.media & gpu::kMediaColouredSigma) != 0, "coloured grids of extinction"},
          {(f.media & gpu::kMediaAlbedoGrids) != 0, "grids of albedo"},
          {(f.media & gpu::kMediaRepeated) != 0, "grids that repeat"},
          {(f.media & gpu::kMediaNearest) != 0, "grids without interpolation"},
          {(f.media & gpu::kMediaDense) != 0, "dense media on grids"},
          {(f.media & gpu::kMediaChromatic) != 0, "coloured extinction"},
          {(f.media & gpu::kMediaBlended) != 0, "blended phase functions"},
          {(f.media & gpu::kMediaSegments) != 0, "point lights along segments"},
          {f.shadow_null, "shadow rays through surfaces"},
          {f.aovs != 0, "auxiliary channels"}};
}

void set_class(std::map<uint32_t, uint32_t>& constants, const MaterialClass& c) {
  constants[gpu::kFeatureBsdfs] = c.bsdfs;
  constants[gpu::kFeatureMaterial] = c.flags;
  constants[gpu::kFeatureMaxLeaves] = c.max_leaves;
  constants[gpu::kFeatureTexturedInputs] = c.textured;
}

}  // namespace

bool FeatureSet::area_lights() const {
  return has_light(gpu::kLightTriangles) || has_light(gpu::kLightRectangle) || has_light(gpu::kLightSphere) ||
         has_light(gpu::kLightDisk) || has_light(gpu::kLightCylinder);
}

bool FeatureSet::has_media() const { return (media & (gpu::kMediaHomogeneous | gpu::kMediaGrids)) != 0; }

bool FeatureSet::environment() const {
  return has_light(gpu::kLightConstant) || has_light(gpu::kLightEnvironment);
}

std::map<uint32_t, uint32_t> FeatureSet::constants() const {
  return {{gpu::kFeatureCurved, curved},
          {gpu::kFeatureTriangles, triangles},
          {gpu::kFeatureWalls, walls},
          {gpu::kFeatureFocusers, focusers},
          {gpu::kFeatureVertexNormals, vertex_normals},
          {gpu::kFeatureVertexUv, vertex_uv},
          {gpu::kFeatureClassCount, static_cast<uint32_t>(classes.size())},
          {gpu::kFeatureCamera, camera},
          {gpu::kFeatureFilter, filter},
          {gpu::kFeatureMaxDepth, max_depth},
          {gpu::kFeatureRouletteDepth, roulette_depth},
          {gpu::kFeatureHideEmitters, hide_emitters},
          {gpu::kFeatureStrategy, strategy},
          {gpu::kFeatureLights, lights},
          {gpu::kFeatureSelection, selection},
          {gpu::kFeatureLightTextures, light_textures},
          {gpu::kFeatureTextures, textures},
          {gpu::kFeatureMedia, media},
          {gpu::kFeatureCameraMedium, camera_medium},
          {gpu::kFeatureShadowNull, shadow_null},
          {gpu::kFeatureAov, aovs}};
}

std::map<uint32_t, uint32_t> FeatureSet::class_constants(size_t index) const {
  std::map<uint32_t, uint32_t> values = constants();
  set_class(values, classes[index]);
  values[gpu::kFeatureClass] = static_cast<uint32_t>(index);
  return values;
}

MaterialClass FeatureSet::union_class() const {
  MaterialClass all;
  bool one_sided = false;
  for (const MaterialClass& c : classes) {
    all.bsdfs |= c.bsdfs;
    all.flags |= c.flags;
    all.max_leaves = std::max(all.max_leaves, c.max_leaves);
    all.textured |= c.textured;
    one_sided |= c.max_leaves > 0 && (c.flags & (gpu::kMaterialTwoSided | gpu::kMaterialSides)) == 0;
  }
  // Where only some materials mirror, the leaves tell.
  if ((all.flags & gpu::kMaterialTwoSided) != 0 && (one_sided || (all.flags & gpu::kMaterialSides) != 0))
    all.flags = (all.flags & ~gpu::kMaterialTwoSided) | gpu::kMaterialSides;
  return all;
}

std::map<uint32_t, uint32_t> FeatureSet::union_constants() const {
  std::map<uint32_t, uint32_t> values = constants();
  MaterialClass all = union_class();
  if (aovs & (1u << gpu::kAovDpDu | 1u << gpu::kAovDpDv)) all.flags |= gpu::kMaterialTangent;
  set_class(values, all);
  return values;
}

std::vector<std::string> FeatureSet::present() const {
  std::vector<std::string> names;
  for (const Named& n : named_features(*this))
    if (n.present) names.push_back(n.name);
  return names;
}

std::vector<std::string> FeatureSet::absent() const {
  std::vector<std::string> names;
  for (const Named& n : named_features(*this))
    if (!n.present) names.push_back(n.name);
  return names;
}

}  // namespace tachylite
