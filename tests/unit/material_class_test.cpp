// The most kinds of material that a scene may have: 255 are packed, one more is refused, and the words that the stages
// count by do not overlap at that number. Packing alone.

#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "pack/pack_material.h"
#include "shared/counters.h"
#include "shared/geometry.h"

namespace tachylite {
namespace {

// One word each: lengths of queues, counts, three arguments of each dispatch, in that order; the last queue is that of
// collisions in media.
static_assert(gpu::kQueueSurface > gpu::kQueueEscaped && gpu::kQueueEscaped > gpu::kQueueEmitter &&
              gpu::kQueueEmitter > gpu::kQueueShadow && gpu::kQueueShadow > gpu::kQueueRays1 &&
              gpu::kQueueRays1 > gpu::kQueueRays0);
static_assert(gpu::kQueueSurface + gpu::kMaxClasses < gpu::kMaxQueues);
static_assert(gpu::kCounterPlace >= gpu::kCounterQueue + 2 * gpu::kMaxQueues);
static_assert(gpu::kCounterPlace + gpu::kMaxQueues <= gpu::kCounterClosestTotal && gpu::kCounterClosestTotal < gpu::kCounterShadowTotal &&
              gpu::kCounterShadowTotal < gpu::kCounterNonfinite && gpu::kCounterNonfinite < gpu::kCounterOverflow &&
              gpu::kCounterOverflow < gpu::kCounterUnfinished &&
              gpu::kCounterUnfinished < gpu::kCounterArguments);
static_assert(gpu::kDispatchClosest < gpu::kDispatchShadow && gpu::kDispatchShadow < gpu::kDispatchQueue);
static_assert(gpu::kCounterArguments + 4 * (gpu::kDispatchQueue + gpu::kMaxQueues) <= gpu::kCounterWords);
// A hit keeps its class in 8 bits, one value of which means none.
static_assert(gpu::kMaxClasses <= gpu::kClassNone && gpu::kClassNone <= 255);

/// The 255 blends of some of eight bsdfs, each a class of its own, on a shape each.
Scene scene_of_all_blends() {
  Scene scene;
  const std::vector<BsdfKind> kinds = {DiffuseBsdf{},    RoughDiffuseBsdf{}, ConductorBsdf{},  RoughConductorBsdf{},
                                       DielectricBsdf{}, PlasticBsdf{},      BlinnPhongBsdf{}, MicrofacetBsdf{}};
  for (const BsdfKind& kind : kinds) scene.bsdfs.push_back({.kind = kind});
  const auto add_shape = [&](BsdfIndex bsdf) {
    scene.shapes.emplace_back();
    scene.shapes.back().bsdf = bsdf;
  };
  for (unsigned subset = 1; subset < 256; ++subset) {
    BsdfIndex blend = kNone;
    for (unsigned i = 0; i < kinds.size(); ++i) {
      if ((subset >> i & 1) == 0) continue;
      const auto next = static_cast<BsdfIndex>(i);
      if (blend != kNone) scene.bsdfs.push_back({.kind = BlendBsdf{blend, next, 0.5}});
      blend = blend == kNone ? next : static_cast<BsdfIndex>(scene.bsdfs.size()) - 1;
    }
    add_shape(blend);
  }
  return scene;
}

TEST(MaterialClasses, TheMostThatMayBe) {
  const Scene scene = scene_of_all_blends();
  const PackedMaterials packed = pack_materials(scene, {});
  ASSERT_EQ(packed.classes.size(), gpu::kMaxClasses);
  std::set<uint32_t> classes;
  for (const Shape& shape : scene.shapes) classes.insert(packed.class_of_bsdf[static_cast<size_t>(shape.bsdf)]);
  EXPECT_EQ(classes.size(), gpu::kMaxClasses);
  EXPECT_FALSE(classes.contains(gpu::kClassNone));
}

TEST(MaterialClasses, OneMoreIsRefused) {
  Scene scene = scene_of_all_blends();
  const auto file = std::make_shared<const std::string>("scene.xml");
  scene.bsdfs.push_back({.where = {file, 7}, .kind = NullBsdf{}});
  scene.shapes.emplace_back();
  scene.shapes.back().bsdf = static_cast<BsdfIndex>(scene.bsdfs.size()) - 1;
  try {
    pack_materials(scene, {});
    FAIL() << "packed";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "scene.xml:7: more than 255 kinds of material (sets of bsdfs that are shaded together)");
  }
  // A class that is there already is no new one.
  scene.bsdfs.back().kind = DiffuseBsdf{0.9};
  EXPECT_EQ(pack_materials(scene, {}).classes.size(), gpu::kMaxClasses);
}

}  // namespace
}  // namespace tachylite
