#pragma once

// Asks shaders/bsdf on the device: what it samples, and what it evaluates. The shading frame is the world's; wo and wi
// point away from the surface, wo to the viewer.

#include <bit>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "pack/pack_material.h"
#include "pack/pack_texture.h"
#include "scene/scene.h"
#include "vulkan/buffer.h"
#include "vulkan/kernel.h"

namespace tachylite::test {

struct BsdfQuery {
  int bsdf = 0;            // index into the scene's bsdfs
  glm::vec3 wo{0, 0, 1};
  glm::vec3 wi{0};         // where to evaluate; zero: in the sampled direction
  glm::vec2 u{0.5};
  float u_lobe = 0.5f;
  float texture_u = 0.5f;  // texture point (texture_u, 1/2)
};
struct BsdfAnswer {
  glm::vec3 wi;             // sampled
  float pdf;                // w.r.t. solid angle
  glm::vec3 weight;
  float eta;
  glm::vec3 f;              // evaluated: f |cos_wi|
  float f_pdf;
  glm::vec3 null_transmission;
  uint32_t flags;           // of the sample
  bool delta() const { return (flags & 1u) != 0; }
};
static_assert(sizeof(BsdfAnswer) == 64);

class BsdfProbe {
 public:
  /// Every bsdf of the scene can be asked for. Textures must be checkerboards.
  explicit BsdfProbe(Scene scene);
  ~BsdfProbe();

  std::vector<BsdfAnswer> ask(std::span<const BsdfQuery> queries);
  const PackedMaterials& materials() const { return materials_; }
  const MaterialClass& material_class(int bsdf) const;

 private:
  struct ClassKernel;
  ClassKernel& kernel(uint32_t material_class);

  Scene scene_;
  PackedMaterials materials_;
  PackedTextures textures_;
  vulkan::Buffer rows_, texture_rows_;
  std::vector<std::unique_ptr<ClassKernel>> kernels_;  // of each class, made on first use
};

/// A scene of these bsdfs, each on a shape of its own.
Scene scene_of_bsdfs(const std::vector<BsdfKind>& kinds);

}  // namespace tachylite::test
