#include "pack/pack_medium.h"

#include <algorithm>
#include <limits>
#include <map>

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "pack/float_bits.h"
#include "pack/majorant_grid.h"
#include "shared/medium.h"

namespace tachylite {
namespace {

using glm::dvec3;
using glm::dvec4;
using glm::vec4;

vec4 row(const dvec3& v, uint32_t word = 0) { return vec4(glm::vec3(v), as_float(word)); }

class MediumPacker {
 public:
  explicit MediumPacker(const dvec3& centre) : centre_(centre) {}

  void add(const Medium& medium) {
    const size_t first = media_.size();
    media_.resize(first + gpu::kMediumRows, vec4(0));
    vec4* rows = &media_[first];
    const uint32_t first_lobe = static_cast<uint32_t>(lobes_.size());
    double before = 0;
    add_lobes(medium.phase, 1, before);
    const uint32_t count = static_cast<uint32_t>(lobes_.size()) - first_lobe;
    if (count > gpu::kMaxLobes)
      throw InputError(medium.phase.where, fmt::format("a phase function blends {} lobes, at most {} are supported",
                                                       count, gpu::kMaxLobes));
    if (count > 1) kinds |= gpu::kMediaBlended;
    lobe_rows_.push_back(first_lobe);

    if (const auto* homogeneous = std::get_if<HomogeneousMedium>(&medium.kind)) {
      const dvec3& sigma_t = homogeneous->sigma_t;
      rows[0] = row(sigma_t, gpu::kMediumHomogeneous | count << 8);
      rows[1] = row(homogeneous->albedo);
      kinds |= gpu::kMediaHomogeneous;
      if (sigma_t.x != sigma_t.y || sigma_t.x != sigma_t.z) kinds |= gpu::kMediaChromatic;
      return;
    }
    const auto& grid = std::get<HeterogeneousMedium>(medium.kind);
    kinds |= gpu::kMediaGrids;
    rows[0] = row(dvec3(0), gpu::kMediumGrid | count << 8);
    dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (int corner = 0; corner < 8; ++corner) {
      const dvec3 p = dvec3(grid_to_world(grid.sigma_t) * dvec4(corner & 1, (corner >> 1) & 1, corner >> 2, 1));
      low = glm::min(low, p - centre_);
      high = glm::max(high, p - centre_);
    }
    rows[2] = vec4(glm::vec3(low), static_cast<float>(grid.scale));
    rows[3] = row(high);
    put_majorants(grid, glm::vec3(low), glm::vec3(high), rows[1]);
    if (put_volume(grid.sigma_t, rows + gpu::kMediumSigmaRow) == 3) kinds |= gpu::kMediaColouredSigma;
    if (put_volume(grid.albedo, rows + gpu::kMediumAlbedoRow) > 0) kinds |= gpu::kMediaAlbedoGrids;
  }

  /// Medium without effect.
  static bool is_nothing(const Medium& medium) {
    if (const auto* homogeneous = std::get_if<HomogeneousMedium>(&medium.kind)) return homogeneous->sigma_t == dvec3(0);
    const auto& grid = std::get<HeterogeneousMedium>(medium.kind);
    return !(grid.scale * largest_value(grid.sigma_t) > 0);
  }

  std::vector<vec4> take_rows() {
    const auto first = static_cast<uint32_t>(media_.size());
    for (size_t m = 0; m < lobe_rows_.size(); ++m) media_[m * gpu::kMediumRows + 1].w = as_float(first + lobe_rows_[m]);
    media_.insert(media_.end(), lobes_.begin(), lobes_.end());
    return std::move(media_);
  }

  PageVector<float> grids;
  uint32_t kinds = 0;

 private:
  void add_lobes(const PhaseFunction& phase, double weight, double& before) {
    if (const auto* blend = std::get_if<BlendPhase>(&phase.kind)) {
      if (blend->weight < 1) add_lobes(*blend->first, weight * (1 - blend->weight), before);
      if (blend->weight > 0) add_lobes(*blend->second, weight * blend->weight, before);
      return;
    }
    const auto* hg = std::get_if<HenyeyGreensteinPhase>(&phase.kind);
    before += weight;
    lobes_.push_back(row(dvec3(before, weight, hg ? hg->g : 0.0)));
  }

  /// Returns its channels, 0 where it is constant.
  uint32_t put_volume(const Volume& volume, vec4* rows) {
    if (!volume.grid) {
      rows[0] = row(volume.constant);
      return 0;
    }
    const Grid& grid = *volume.grid;
    if (std::max({grid.nx, grid.ny, grid.nz}) > 0xffff)
      throw InputError(volume.where, fmt::format("{}: a grid of {} x {} x {} is too large, at most 65535 a side",
                                                 grid.path, grid.nx, grid.ny, grid.nz));
    const dmat4 to_index = glm::scale(dmat4(1), dvec3(grid.nx, grid.ny, grid.nz)) *
                           glm::inverse(grid_to_world(volume)) * glm::translate(dmat4(1), centre_);
    for (int r = 0; r < 3; ++r) rows[r] = vec4(glm::row(to_index, r));
    const uint32_t channels = grid.channels < 3 ? 1 : 3;
    const uint32_t filtering = volume.filter == FilterType::kNearest ? gpu::kVolumeNearest : gpu::kVolumeTrilinear;
    if (filtering == gpu::kVolumeNearest) kinds |= gpu::kMediaNearest;
    const uint32_t wrap = volume.wrap == WrapMode::kRepeat   ? gpu::kVolumeRepeat
                          : volume.wrap == WrapMode::kMirror ? gpu::kVolumeMirror
                                                             : gpu::kVolumeClamp;
    if (wrap != gpu::kVolumeClamp) kinds |= gpu::kMediaRepeated;
    rows[3] = vec4(as_float(static_cast<uint32_t>(grid.nx) | static_cast<uint32_t>(grid.ny) << 16),
                   as_float(static_cast<uint32_t>(grid.nz) | channels << 16 | filtering << 24 | wrap << 28),
                   as_float(first_value(volume, channels)), 0);
    return channels;
  }

  void put_majorants(const HeterogeneousMedium& medium, const dvec3& low, const dvec3& high, vec4& row) {
    const MajorantGrid majorants = bound_volume(medium.sigma_t, low + centre_, high + centre_);
    check_grids_size(medium.sigma_t, majorants.values.size());
    row.x = as_float(static_cast<uint32_t>(grids.size()));
    const glm::uvec3 n(majorants.cells);
    row.y = as_float(n.x | n.y << 8 | n.z << 16);
    const double most = medium.scale * *std::ranges::max_element(majorants.values);
    if (most * glm::length(high - low) > double{gpu::kMostMajorantDepth}) kinds |= gpu::kMediaDense;
    // A little too large, so that no float product of scale and value is above it.
    for (const double value : majorants.values)
      grids.push_back(static_cast<float>(medium.scale * value * (1 + 1e-6)));
  }

  void check_grids_size(const Volume& volume, size_t more) const {
    if (grids.size() + more > static_cast<size_t>(std::numeric_limits<int32_t>::max()))
      throw InputError(volume.where, "the grids of the scene hold more than 2^31 values");
  }

  /// Where the grid's values begin; each grid is stored once.
  uint32_t first_value(const Volume& volume, uint32_t channels) {
    const Grid& grid = *volume.grid;
    const auto [found, is_new] = first_of_grid_.try_emplace(&grid, grids.size());
    if (!is_new) return static_cast<uint32_t>(found->second);
    const size_t stride = static_cast<size_t>(grid.channels), voxels = grid.values.size() / stride;
    check_grids_size(volume, voxels * channels);
    for (size_t v = 0; v < voxels; ++v)
      for (size_t c = 0; c < channels; ++c) grids.push_back(grid.values[v * stride + c]);
    return static_cast<uint32_t>(found->second);
  }

  dvec3 centre_;
  std::vector<vec4> media_, lobes_;
  std::vector<uint32_t> lobe_rows_;  // of each medium, counted from the first lobe
  std::map<const Grid*, size_t> first_of_grid_;
};

}  // namespace

uint32_t PackedMedia::index(MediumIndex medium) const {
  return medium == kNone || index_of_medium.empty() ? gpu::kNoMedium : index_of_medium[static_cast<size_t>(medium)];
}

PackedMedia pack_media(const Scene& scene, const Sensor& sensor, const dvec3& centre) {
  std::vector<bool> used(scene.media.size());
  const auto use = [&](MediumIndex medium) {
    if (medium != kNone) used[static_cast<size_t>(medium)] = true;
  };
  use(sensor.medium);
  for (const Shape& shape : scene.shapes) {
    use(shape.interior);
    use(shape.exterior);
  }
  PackedMedia out;
  MediumPacker packer(centre);
  uint32_t count = 0;
  for (size_t m = 0; m < scene.media.size(); ++m) {
    const bool kept = used[m] && !MediumPacker::is_nothing(scene.media[m]);
    if (kept && count == gpu::kNoMedium)
      throw InputError(scene.media[m].where, fmt::format("more than {} media", gpu::kNoMedium));
    if (kept) packer.add(scene.media[m]);
    out.index_of_medium.push_back(kept ? count++ : gpu::kNoMedium);
  }
  out.rows = packer.take_rows();
  out.grids = std::move(packer.grids);
  out.kinds = packer.kinds;
  return out;
}

}  // namespace tachylite
