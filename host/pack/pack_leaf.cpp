#include "pack/pack_leaf.h"

#include "base/error.h"

namespace tachylite {
namespace {

class LeafWriter {
 public:
  LeafWriter(uint32_t type, std::span<const uint32_t> row_of_texture) : row_of_texture_(row_of_texture) {
    leaf_.type = type;
  }
  void input(const ColorInput& input) { add(input.value, input.texture); }
  void input(const ScalarInput& input) { add(dvec3(input.value), input.texture); }
  void constants(double x, double y = 0, double z = 0, double w = 0) { leaf_.rows.push_back(float_row(x, y, z, w)); }
  PackedLeaf& leaf() { return leaf_; }

 private:
  void add(const dvec3& value, TextureIndex texture) {
    const bool textured = texture != kNone;
    if (textured) {
      leaf_.textured |= 1u << leaf_.rows.size();
      leaf_.flags |= gpu::kMaterialTextured;
    }
    leaf_.rows.push_back(
        input_row(value, textured ? row_of_texture_[static_cast<size_t>(texture)] : gpu::kNoTexture));
  }
  std::span<const uint32_t> row_of_texture_;
  PackedLeaf leaf_;
};

bool is_black(const ColorInput& input) { return input.texture == kNone && input.value == dvec3(0); }

struct LeafPacker {
  const Bsdf& bsdf;
  std::span<const uint32_t> row_of_texture;

  std::optional<PackedLeaf> operator()(const DiffuseBsdf& b) const {
    LeafWriter writer(gpu::kBsdfDiffuse, row_of_texture);
    writer.input(b.reflectance);
    writer.leaf().flags |= gpu::kMaterialSmooth;
    writer.leaf().scatters = !is_black(b.reflectance);
    return writer.leaf();
  }
  template <class T>
  std::optional<PackedLeaf> operator()(const T&) const {
    throw InputError(bsdf.where, "bsdf \"" + bsdf.plugin + "\" is not supported yet");
  }
};

}  // namespace

std::optional<PackedLeaf> pack_leaf(const Bsdf& bsdf, std::span<const uint32_t> row_of_texture) {
  return std::visit(LeafPacker{bsdf, row_of_texture}, bsdf.kind);
}

}  // namespace tachylite
