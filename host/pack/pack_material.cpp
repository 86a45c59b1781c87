#include "pack/pack_material.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>

#include "base/check.h"
#include "base/error.h"
#include "pack/pack_leaf.h"
#include "shared/counters.h"
#include "shared/geometry.h"
#include "shared/material.h"

namespace tachylite {
namespace {

struct Weight {
  ScalarInput input;
  bool complement = false;
};
struct Frame {
  uint32_t kind = gpu::kFrameNone, options = 0;
  TextureIndex texture = kNone;
  double scale = 1;
};
/// A leaf with all that the adapters around it said.
struct FlatLeaf {
  PackedLeaf leaf;
  std::vector<Weight> weights;
  uint32_t mirrors = 0;
  uint32_t sides = 0;         // kSide...
  std::vector<Frame> frames;  // from outside in
};
enum Side { kFront = 1, kBack = 2 };
/// What the adapters on the way down from the root say.
struct Context {
  std::vector<Weight> weights;
  uint32_t mirrors = 0;
  std::vector<Frame> frames;
  // Of the surface, and of the frames inside the maps: where a viewer sees it.
  std::array<int, gpu::kMostFrames + 1> sides = {kFront | kBack, kFront | kBack, kFront | kBack};
};
struct FlatMaterial {
  std::array<std::vector<std::shared_ptr<const FlatLeaf>>, 2> lists;  // in front, behind
  bool has_null = false;  // a part beside the leaves
};

class Flattener {
 public:
  Flattener(const Scene& scene, std::span<const uint32_t> row_of_texture)
      : scene_(scene), row_of_texture_(row_of_texture) {}

  FlatMaterial flatten(BsdfIndex root) {
    material_ = {};
    visit(root, {});
    for (const auto& list : material_.lists)
      if (list.size() > gpu::kMaterialMaxLeaves)
        throw InputError(scene_.bsdfs[static_cast<size_t>(root)].where,
                         fmt::format("a material blends {} bsdfs, expected at most {}", list.size(),
                                     gpu::kMaterialMaxLeaves));
    return std::move(material_);
  }

 private:
  void visit(BsdfIndex index, const Context& context) {
    CHECK(index >= 0 && static_cast<size_t>(index) < scene_.bsdfs.size());
    const Bsdf& bsdf = scene_.bsdfs[static_cast<size_t>(index)];
    std::visit([&](const auto& kind) { visit_kind(bsdf, kind, context); }, bsdf.kind);
  }

  template <class Kind>
  void visit_kind(const Bsdf& bsdf, const Kind&, const Context& context) {
    std::optional<PackedLeaf> leaf = pack_leaf(bsdf, row_of_texture_);
    if (leaf)
      add(std::move(*leaf), context);
    else
      material_.has_null = true;
  }
  void visit_kind(const Bsdf&, const NullBsdf&, const Context&) { material_.has_null = true; }
  void visit_kind(const Bsdf& bsdf, const PaperBsdf& paper, const Context& context) {
    if (weighted(context, {paper.transparency, false})) material_.has_null = true;
    std::optional<Context> opaque = weighted(context, {paper.transparency, true});
    if (!opaque) return;
    Bsdf diffuse = bsdf;
    diffuse.kind = DiffuseBsdf{paper.reflectance};
    mirror(*opaque);
    add(*pack_leaf(diffuse, row_of_texture_), *opaque);
  }
  void visit_kind(const Bsdf&, const MaskBsdf& mask, const Context& context) {
    if (weighted(context, {mask.opacity, true})) material_.has_null = true;
    if (std::optional<Context> opaque = weighted(context, {mask.opacity, false})) visit(mask.child, *opaque);
  }
  void visit_kind(const Bsdf&, const BlendBsdf& blend, const Context& context) {
    if (std::optional<Context> first = weighted(context, {blend.weight, true})) visit(blend.first, *first);
    if (std::optional<Context> second = weighted(context, {blend.weight, false})) visit(blend.second, *second);
  }
  void visit_kind(const Bsdf&, const TwoSidedBsdf& two_sided, const Context& context) {
    Context front = context;
    if (two_sided.front == two_sided.back || two_sided.back == kNone) {
      mirror(front);
      return visit(two_sided.front, front);
    }
    // Two children: the viewer's side of the surface, or of the frame inside the map, picks one. Where a `twosided` has
    // mirrored there already, it is always the front.
    const size_t depth = context.frames.size();
    if ((context.mirrors & gpu::kMirrorOuter << depth) != 0) return visit(two_sided.front, front);
    Context back = front;
    front.sides[depth] &= kFront;
    back.sides[depth] &= kBack;
    mirror(back);
    if (front.sides[depth] != 0) visit(two_sided.front, front);
    if (back.sides[depth] != 0) visit(two_sided.back, back);
  }
  void visit_kind(const Bsdf& bsdf, const NormalMapBsdf& map, const Context& context) {
    visit_framed(bsdf, map.child, {gpu::kFrameNormalMap, frame_options(map), map.normalmap, 1.0}, context);
  }
  void visit_kind(const Bsdf& bsdf, const BumpMapBsdf& map, const Context& context) {
    visit_framed(bsdf, map.child, {gpu::kFrameBumpMap, frame_options(map), map.height, map.scale}, context);
  }

  template <class Map>
  static uint32_t frame_options(const Map& map) {
    return (map.flip_invalid_normals ? gpu::kFrameFlipInvalid : 0u) |
           (map.use_shadowing_function ? gpu::kFrameShadowing : 0u);
  }
  void visit_framed(const Bsdf& bsdf, BsdfIndex child, const Frame& frame, Context context) {
    if (context.frames.size() == gpu::kMostFrames)
      throw InputError(bsdf.where, fmt::format("normal and bump maps inside one another: expected at most {}",
                                               gpu::kMostFrames));
    context.frames.push_back(frame);
    visit(child, context);
  }

  /// Context for a child with one more weight; none where that weight is the constant 0.
  static std::optional<Context> weighted(Context context, const Weight& weight) {
    if (weight.input.texture == kNone) {
      const double value = std::clamp(weight.input.value, 0.0, 1.0);
      if (value == (weight.complement ? 1.0 : 0.0)) return std::nullopt;
      if (value == (weight.complement ? 0.0 : 1.0)) return context;
    }
    context.weights.push_back(weight);
    return context;
  }
  static void mirror(Context& context) {
    static_assert(gpu::kMirrorInner == gpu::kMirrorOuter << 1 && gpu::kMirrorInnermost == gpu::kMirrorOuter << 2);
    context.mirrors |= gpu::kMirrorOuter << context.frames.size();
  }
  void add(PackedLeaf leaf, const Context& context) {
    static_assert(gpu::kSideFrontInner == kFront && gpu::kSideBackInner == kBack &&
                  gpu::kSideFrontInnermost == kFront << 2 && gpu::kSideBackInnermost == kBack << 2);
    const auto restricted = [&](size_t depth) {
      const int sides = context.sides[depth];
      return static_cast<uint32_t>(sides == (kFront | kBack) ? 0 : sides);
    };
    auto flat = std::make_shared<const FlatLeaf>(FlatLeaf{std::move(leaf), context.weights, context.mirrors,
                                                          restricted(1) | restricted(2) << 2, context.frames});
    if (context.sides[0] & kFront) material_.lists[0].push_back(flat);
    if (context.sides[0] & kBack) material_.lists[1].push_back(flat);
  }

  const Scene& scene_;
  std::span<const uint32_t> row_of_texture_;
  FlatMaterial material_;
};

/// What kernels must be compiled for to shade it; no value: it absorbs everything.
std::optional<MaterialClass> class_of(const FlatMaterial& material) {
  MaterialClass result;
  bool scatters = material.has_null, any_leaf = false;
  uint32_t outer = 0, not_outer = 0;
  if (material.has_null) {
    result.bsdfs |= 1u << gpu::kBsdfNull;
    result.flags |= gpu::kMaterialNull;
  }
  for (const auto& list : material.lists) {
    result.max_leaves = std::max(result.max_leaves, static_cast<uint32_t>(list.size()));
    for (const auto& flat : list) {
      any_leaf = true;
      scatters |= flat->leaf.scatters;
      result.bsdfs |= 1u << flat->leaf.type;
      result.flags |= flat->leaf.flags;
      result.textured |= flat->leaf.textured;
      if (!flat->weights.empty()) result.flags |= gpu::kMaterialHasWeights;
      for (const Weight& weight : flat->weights)
        if (weight.input.texture != kNone) {
          result.textured |= gpu::kTexturedWeights;
          result.flags |= gpu::kMaterialTextured;
        }
      if (!flat->frames.empty())
        result.flags |= gpu::kMaterialHasFrames | gpu::kMaterialTextured | gpu::kMaterialTangent;
      if (flat->frames.size() > 1) result.flags |= gpu::kMaterialNestedFrames;
      if (flat->sides != 0) result.flags |= gpu::kMaterialMapSides;
      (flat->mirrors & gpu::kMirrorOuter ? outer : not_outer) += 1;
    }
  }
  // Then there are leaves for the other side, too; single leaves are always seen.
  CHECK((result.flags & gpu::kMaterialMapSides) == 0 || result.max_leaves > 1);
  if (!scatters) return std::nullopt;
  if (material.lists[0] != material.lists[1] || (outer != 0 && not_outer != 0))
    result.flags |= gpu::kMaterialSides;
  else if (any_leaf && not_outer == 0)
    result.flags |= gpu::kMaterialTwoSided;
  return result;
}

class MaterialWriter {
 public:
  MaterialWriter(std::span<const uint32_t> row_of_texture, std::vector<glm::uvec4>& rows)
      : row_of_texture_(row_of_texture), rows_(rows) {}

  /// Returns the material's row.
  uint32_t write(const FlatMaterial& material, uint32_t flags) {
    const size_t head = rows_.size();
    rows_.emplace_back();
    const uint32_t front = write_list(material.lists[0]);
    const uint32_t behind = material.lists[0] == material.lists[1] ? front : write_list(material.lists[1]);
    rows_[head] = {static_cast<uint32_t>(material.lists[0].size() | material.lists[1].size() << 8), flags, front,
                   behind};
    return static_cast<uint32_t>(head);
  }

 private:
  uint32_t texture_row(TextureIndex texture) const {
    return texture == kNone ? gpu::kNoTexture : row_of_texture_[static_cast<size_t>(texture)];
  }
  uint32_t write_list(const std::vector<std::shared_ptr<const FlatLeaf>>& list) {
    const auto first = static_cast<uint32_t>(rows_.size());
    for (const auto& leaf : list) write_leaf(*leaf);
    return first;
  }
  void write_leaf(const FlatLeaf& flat) {
    const size_t head = rows_.size();
    rows_.emplace_back();
    rows_.insert(rows_.end(), flat.leaf.rows.begin(), flat.leaf.rows.end());
    uint32_t kinds = 0, shift = 0;
    for (const Frame& frame : flat.frames) {
      rows_.push_back(float_row(frame.scale));
      rows_.back().w = texture_row(frame.texture);
      kinds |= (frame.kind | frame.options << 8) << shift;
      shift += 16;
    }
    const auto first_weight = static_cast<uint32_t>(rows_.size() - head);
    for (const Weight& weight : flat.weights)
      rows_.push_back(input_row(dvec3(weight.input.value), texture_row(weight.input.texture) |
                                                               (weight.complement ? gpu::kInputComplement : 0u)));
    rows_[head] = {flat.leaf.type | flat.mirrors << 8 | flat.sides << gpu::kSideShift | flat.leaf.options << 16,
                   static_cast<uint32_t>(flat.weights.size()) | first_weight << 16,
                   kinds, static_cast<uint32_t>(rows_.size() - head)};
  }

  std::span<const uint32_t> row_of_texture_;
  std::vector<glm::uvec4>& rows_;
};

}  // namespace

PackedMaterials pack_materials(const Scene& scene, std::span<const uint32_t> row_of_texture) {
  CHECK_EQ(row_of_texture.size(), scene.textures.size());
  PackedMaterials packed;
  packed.row_of_bsdf.assign(scene.bsdfs.size(), gpu::kNoIndex);
  packed.class_of_bsdf.assign(scene.bsdfs.size(), gpu::kClassNone);
  Flattener flattener(scene, row_of_texture);
  MaterialWriter writer(row_of_texture, packed.rows);
  for (const Shape& shape : scene.shapes) {
    const auto bsdf = static_cast<size_t>(shape.bsdf);
    CHECK_LT(bsdf, scene.bsdfs.size());
    if (packed.row_of_bsdf[bsdf] != gpu::kNoIndex) continue;
    const FlatMaterial material = flattener.flatten(shape.bsdf);
    const std::optional<MaterialClass> material_class = class_of(material);
    packed.row_of_bsdf[bsdf] = writer.write(material, material_class ? material_class->flags : 0u);
    if (!material_class) continue;
    const auto found = std::find(packed.classes.begin(), packed.classes.end(), *material_class);
    packed.class_of_bsdf[bsdf] = static_cast<uint32_t>(found - packed.classes.begin());
    if (found == packed.classes.end()) packed.classes.push_back(*material_class);
    static_assert(gpu::kMaxClasses <= gpu::kClassNone);
    if (packed.classes.size() > gpu::kMaxClasses)
      throw InputError(scene.bsdfs[bsdf].where,
                       fmt::format("more than {} kinds of material (sets of bsdfs that are shaded together)",
                                   gpu::kMaxClasses));
  }
  return packed;
}

std::string bsdf_kernel_variant(const MaterialClass& c) {
  static constexpr const char* kNames[] = {
      "_diffuse",          "_diffuse", "_rough_diffuse", "_conductor",  "_rough_conductor", "_dielectric",  "_thin_dielectric",
      "_rough_dielectric", "_plastic", "_rough_plastic", "_principled", "_principled_thin", "_blinn_phong", "_microfacet"};
  constexpr uint32_t kPrincipled = 1u << gpu::kBsdfPrincipled | 1u << gpu::kBsdfPrincipledThin;
  const uint32_t types = c.bsdfs & ~(1u << gpu::kBsdfNull);  // none: null alone, for which any variant does
  if (c.flags & gpu::kMaterialNestedFrames) return "";
  const bool textured = c.textured != 0 || (c.flags & gpu::kMaterialHasFrames) != 0;
  if (c.max_leaves <= 1 && std::popcount(types) <= 1)
    return std::string(kNames[types == 0 ? 0 : std::countr_zero(types)]) + (textured ? "_textured" : "");
  if (!textured) return "_mixture";
  return (types & kPrincipled) == 0 ? "_mixture_textured" : "";
}

}  // namespace tachylite
