#include "pack/pack_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/pi.h"
#include "pack/envmap_distribution.h"
#include "pack/float_bits.h"
#include "pack/light_tree.h"
#include "pack/pack_area_light.h"
#include "shared/bvh.h"
#include "shared/geometry.h"
#include "shared/light.h"
#include "shared/material.h"

namespace tachylite {
namespace {

using glm::dmat3;

/// For each primitive the hit that names it, kNoHit for those that the BVH left out.
std::vector<uint32_t> hits_of_primitives(const Geometry& geometry, const Bvh8& bvh) {
  std::vector<uint32_t> hits(geometry.triangles.size() + geometry.curved.size(), gpu::kNoHit);
  for (size_t leaf = 0; leaf < bvh.leaves.size(); ++leaf) {
    const auto hit = static_cast<uint32_t>(2 * leaf);
    const glm::uvec4& info = bvh.leaves[leaf].info;
    if (info.y < hits.size()) hits[info.y] = hit + 1;
    if (info.x < hits.size()) hits[info.x] = hit;  // a lone primitive stands in both words
  }
  return hits;
}

class LightPacker {
 public:
  LightPacker(const Scene& scene, const Geometry& geometry, const PackedTextures& textures)
      : scene_(scene), geometry_(geometry), textures_(textures) {
    out_.light_of_shape.assign(scene.shapes.size(), gpu::kNoIndex);
    for (const Emitter& emitter : scene.emitters)
      sampled_emitters_ += !std::holds_alternative<DirectionalAreaEmitter>(emitter.kind);
  }

  PackedLights pack(const std::vector<uint32_t>& hits) {
    // The environment last, so that a single sampled light may be the first record.
    for (const Emitter& emitter : scene_.emitters)
      std::visit([&](const auto& kind) { add(emitter, kind, hits); }, emitter.kind);
    if (environment_) records_.push_back(*environment_);
    write();
    return std::move(out_);
  }

 private:
  bool compensates() const { return scene_.integrator.strategy == Integrator::Strategy::kMis; }

  LightRadiance radiance_of(const ColorInput& input) {
    if (input.texture == kNone) return {input.value, nullptr, gpu::kNoTexture};
    const Texture& texture = scene_.textures[static_cast<size_t>(input.texture)];
    out_.textures = true;
    return {mean_texture_color(scene_, texture), &texture, textures_.row_of_texture[static_cast<size_t>(input.texture)]};
  }

  void add(const Emitter& emitter, const AreaEmitter& area, const std::vector<uint32_t>& hits) {
    if (emitter.shape == kNone) return;
    const auto s = static_cast<size_t>(emitter.shape);
    if (area.radiance.texture == kNone && area.radiance.value == dvec3(0)) return;
    const ShapeGeometry& range = geometry_.shapes[s];
    if (range.primitive_count == 0) return;
    const auto first = hits.begin() + static_cast<std::ptrdiff_t>(range.first_primitive);
    out_.light_of_shape[s] = static_cast<uint32_t>(records_.size() * gpu::kLightRows);
    for (LightRecord& record : area_light_records(scene_, geometry_, s, radiance_of(area.radiance), sampled_emitters_,
                                                  {first, first + static_cast<std::ptrdiff_t>(range.primitive_count)}))
      records_.push_back(std::move(record));
  }

  // Shines along its normals only: neither a ray nor a light sample ever meets that direction.
  void add(const Emitter&, const DirectionalAreaEmitter&, const std::vector<uint32_t>&) {}

  void add(const Emitter&, const ConstantEmitter& constant, const std::vector<uint32_t>&) {
    LightRecord r;
    r.kind = gpu::kLightConstant;
    r.rows[0] = glm::vec4(constant.radiance, 0);
    r.infinite = true;
    // Rays sampled by the material find it perfectly; without them it must be sampled.
    const bool sampled = scene_.integrator.strategy == Integrator::Strategy::kEmitterOnly;
    r.bounds.power = sampled ? kPi * mean_component(constant.radiance) : 0;
    if (sampled) out_.kinds |= 1u << gpu::kLightsSampledConstant;
    environment_ = r;
  }

  void add(const Emitter& emitter, const EnvironmentEmitter& map, const std::vector<uint32_t>&) {
    const Bitmap& bitmap = *map.bitmap;
    const TexelFormat format = bitmap.bytes.empty() ? TexelFormat::kFloat
                               : map.srgb           ? TexelFormat::kUnorm8Srgb
                                                    : TexelFormat::kUnorm8Linear;
    std::vector<glm::vec3> radiance;
    radiance.reserve(static_cast<size_t>(bitmap.width) * static_cast<size_t>(bitmap.height));
    for (int y = 0; y < bitmap.height; ++y)
      for (int x = 0; x < bitmap.width; ++x) {
        const dvec3 c = map.scale * texel_color(bitmap, format, x, y);
        if (!std::isfinite(static_cast<float>(c.x + c.y + c.z)))
          throw InputError(emitter.where, fmt::format("{}: pixel ({}, {}) is not finite", bitmap.path, x, y));
        radiance.emplace_back(c);
      }
    dmat3 m(map.to_world);
    const double size = std::cbrt(std::abs(glm::determinant(m)));
    m /= size > 0 ? size : 1;
    const dmat3 error = glm::transpose(m) * m - dmat3(1);
    for (int i = 0; i < 3; ++i)
      if (!(glm::length(error[i]) < 1e-3))
        throw InputError(emitter.where, "the transform of an environment map must be a rotation");

    EnvironmentTables tables = build_environment(radiance, static_cast<uint32_t>(bitmap.width),
                                                 static_cast<uint32_t>(bitmap.height), compensates());
    LightRecord r;
    r.kind = gpu::kLightEnvironment;
    // Rows of the inverse of a rotation: its columns.
    r.rows[1] = glm::vec4(m[0], as_float(tables.width));
    r.rows[2] = glm::vec4(m[1], as_float(tables.height));
    r.rows[3] = glm::vec4(m[2], as_float(tables.levels_x | tables.levels_y << 8));
    r.infinite = true;
    // Half of the light comes from each surface's front, at a mean cosine of a half if it is spread out.
    r.bounds.power = kPi * tables.sampled_mean;
    out_.environment = std::move(tables.texels);
    out_.environment_cdf = std::move(tables.cdf);
    environment_ = r;
  }

  dvec3 device(const dvec3& p) const { return p - geometry_.centre; }

  // A light without extent.
  LightRecord& add_point(uint32_t kind, const dvec3& value, const dvec3& position) {
    LightRecord& r = records_.emplace_back();
    r.kind = kind;
    r.rows[0] = glm::vec4(value, 0);
    r.rows[1] = glm::vec4(position, 0);
    r.bounds.box_min = r.bounds.box_max = position;
    r.bounds.radius = 0;
    r.bounds.theta_o = kPi;
    r.bounds.theta_e = kPi / 2;
    r.bounds.power = mean_component(value);
    return r;
  }

  void add(const Emitter&, const PointEmitter& point, const std::vector<uint32_t>&) {
    if (point.intensity != dvec3(0)) add_point(gpu::kLightPoint, point.intensity, device(point.position));
  }

  void add(const Emitter&, const DirectionalEmitter& light, const std::vector<uint32_t>&) {
    if (light.irradiance == dvec3(0)) return;
    LightRecord& r = add_point(gpu::kLightDirectional, light.irradiance, -glm::normalize(light.direction));
    r.infinite = true;
  }

  // Frame of a spot or projector: rows of the inverse of its transform's linear part, and its position.
  void set_frame(LightRecord& r, const dmat4& to_world) {
    const dvec3 position = device(dvec3(to_world[3]));
    const dmat3 inverse = glm::inverse(dmat3(to_world));
    for (int i = 0; i < 3; ++i)
      r.rows[1 + i] = glm::vec4(inverse[0][i], inverse[1][i], inverse[2][i], position[i]);
    r.bounds.axis = glm::normalize(dmat3(to_world) * dvec3(0, 0, 1));
    r.bounds.theta_e = 0;
  }

  void add(const Emitter&, const SpotEmitter& spot, const std::vector<uint32_t>&) {
    if (spot.intensity == dvec3(0)) return;
    LightRecord& r = add_point(gpu::kLightSpot, spot.intensity, device(dvec3(spot.to_world[3])));
    set_frame(r, spot.to_world);
    r.bounds.theta_o = spot.cutoff_angle;
    r.rows[4] = glm::vec4(std::cos(spot.cutoff_angle), spot.cutoff_angle, std::cos(spot.beam_width),
                          spot.cutoff_angle > spot.beam_width ? 1 / (spot.cutoff_angle - spot.beam_width) : 0);
    set_texture(r, spot.texture);
    r.rows[5].y = static_cast<float>(std::tan(spot.cutoff_angle));
  }

  void add(const Emitter&, const ProjectorEmitter& projector, const std::vector<uint32_t>&) {
    const dvec3 value = projector.scale * (projector.irradiance == kNone ? projector.irradiance_value : dvec3(1));
    if (value == dvec3(0)) return;
    LightRecord& r = add_point(gpu::kLightProjector, value, device(dvec3(projector.to_world[3])));
    set_frame(r, projector.to_world);
    double aspect = 1;
    if (projector.irradiance != kNone)
      if (const auto* bitmap =
              std::get_if<BitmapTexture>(&scene_.textures[static_cast<size_t>(projector.irradiance)].kind))
        aspect = static_cast<double>(bitmap->bitmap->width) / bitmap->bitmap->height;
    const double half_x = std::tan(0.5 * projector.x_fov), half_y = half_x / aspect;
    r.bounds.theta_o = std::atan(std::hypot(half_x, half_y));
    r.bounds.power *= kPi;
    r.rows[4] = glm::vec4(1 / half_x, 1 / half_y, 0, 0);
    set_texture(r, projector.irradiance);
  }

  void set_texture(LightRecord& r, TextureIndex texture) {
    const bool textured = texture != kNone;
    out_.textures |= textured;
    r.rows[5].x = as_float(textured ? textures_.row_of_texture[static_cast<size_t>(texture)] : gpu::kNoTexture);
    if (textured)
      r.bounds.power *= std::max(1e-3, mean_component(mean_texture_color(scene_, scene_.textures[static_cast<size_t>(texture)])));
  }

  bool is_sampled(const LightRecord& r) const {
    return r.bounds.power > 0 && scene_.integrator.strategy != Integrator::Strategy::kBsdfOnly;
  }

  // Chooses the selection, writes the table and the records.
  void write() {
    out_.count = static_cast<uint32_t>(std::count_if(records_.begin(), records_.end(),
                                                     [&](const LightRecord& r) { return is_sampled(r); }));
    const auto row_of = [](size_t i) { return static_cast<uint32_t>(i * gpu::kLightRows); };
    out_.table.assign(gpu::kLightTableHeaderRows, glm::uvec4(0, 0, gpu::kNoIndex, 0));
    std::vector<glm::uvec2> where(records_.size(), glm::uvec2(0));
    if (out_.count == 0) {
      out_.selection = gpu::kSelectNone;
    } else if (out_.count == 1 && is_sampled(records_[0])) {
      out_.selection = gpu::kSelectSingle;
    } else {
      out_.selection = out_.count <= gpu::kMaxLoopLights ? gpu::kSelectLoop : gpu::kSelectTree;
      std::vector<LightBounds> leaves;
      std::vector<uint32_t> leaf_rows;
      std::vector<size_t> leaf_records;
      uint32_t units = 0;
      for (size_t i = 0; i < records_.size(); ++i) {
        const LightRecord& r = records_[i];
        if (!is_sampled(r)) continue;
        if (out_.selection == gpu::kSelectLoop || r.infinite) {
          where[i].x = units++;
          append_light_bounds(r.bounds, row_of(i), out_.table);
          if (r.infinite) out_.table[out_.table.size() - gpu::kLightNodeRows].w = std::bit_cast<uint32_t>(-1.0f);
        } else {
          leaves.push_back(r.bounds);
          leaf_rows.push_back(row_of(i));
          leaf_records.push_back(i);
        }
      }
      if (!leaves.empty()) {
        const std::vector<glm::uvec2> found = append_light_tree(leaves, leaf_rows, units, out_.table);
        for (size_t k = 0; k < found.size(); ++k) {
          where[leaf_records[k]] = found[k];
          units = std::max(units, (found[k].x & 0xffu) + 1);
        }
      }
      out_.table[0].x = units;
    }

    const size_t corners = records_.size() * gpu::kLightRows;
    out_.rows.resize(corners);
    for (size_t i = 0; i < records_.size(); ++i) {
      LightRecord& r = records_[i];
      out_.kinds |= 1u << r.kind | ((r.flags & gpu::kLightSmooth) ? 1u << gpu::kLightsSmooth : 0u);
      if (is_large_rectangle(r)) out_.kinds |= 1u << gpu::kLightsSphericalRectangles;
      r.rows[0].w = as_float(r.kind | r.flags);
      if (r.kind <= gpu::kLightCylinder) {
        r.rows[5].y = as_float(where[i].x);
        r.rows[5].w = as_float(where[i].y);
        if (!r.corners.empty()) {
          r.rows[5].z = as_float(static_cast<uint32_t>(out_.rows.size()));
          out_.rows.insert(out_.rows.end(), r.corners.begin(), r.corners.end());
        }
      }
      std::copy(std::begin(r.rows), std::end(r.rows), out_.rows.begin() + static_cast<std::ptrdiff_t>(row_of(i)));
    }
    double power = 0, sum = 0;
    for (const LightRecord& r : records_) power += r.kind <= gpu::kLightCylinder ? r.bounds.power : 0;
    if (power > 0)
      for (const LightRecord& r : records_) {
        sum += r.kind <= gpu::kLightCylinder ? r.bounds.power : 0;
        out_.emission.push_back(static_cast<float>(sum / power));
      }
    if (environment_) {
      out_.environment_row = row_of(records_.size() - 1);
      out_.table[0].z = out_.environment_row;
      out_.table[0].w = std::bit_cast<uint32_t>(static_cast<float>(environment_->bounds.power));
    }
  }

  // Sampling by solid angle costs a third of the time of a tiny scene's paths (lavapipe) and gains 5 % of the error on
  // the Cornell box, whose light has 4 % of a wall's area; it pays for lights as large as a ceiling.
  bool is_large_rectangle(const LightRecord& r) const {
    const glm::dvec3 e = geometry_.box_max - geometry_.box_min;
    const double wall = (e.x * e.y + e.y * e.z + e.z * e.x) / 3;
    return r.kind == gpu::kLightRectangle && double{r.rows[4].w} > 0.1 * wall;
  }

  const Scene& scene_;
  const Geometry& geometry_;
  const PackedTextures& textures_;
  size_t sampled_emitters_ = 0;
  std::vector<LightRecord> records_;
  std::optional<LightRecord> environment_;
  PackedLights out_;
};

}  // namespace

PackedLights pack_lights(const Scene& scene, const Geometry& geometry, const Bvh8& bvh,
                         const PackedTextures& textures) {
  return LightPacker(scene, geometry, textures).pack(hits_of_primitives(geometry, bvh));
}

}  // namespace tachylite
