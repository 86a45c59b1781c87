#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "scene/scene.h"

namespace tachylite {

struct MeshRequest {
  enum class Format { kObj, kPly };
  std::filesystem::path file;
  Format format = Format::kObj;
  bool flip_tex_coords = false;  // v becomes 1 - v
  bool face_normals = false;     // vertex normals are neither kept nor computed
  /// Linear part of to_world where it matters for computed normals, which Mitsuba weights by angles in world
  /// space: when it is no similarity, or mirrors.
  std::optional<dmat3> to_world;
};

/// Reads the file; without face_normals, vertices that have no normal get one (compute_normals).
/// Throws InputError "file:line: ..." on anything broken; a returned mesh has triangles, valid indices and
/// only finite numbers.
std::shared_ptr<const Mesh> load_mesh(const MeshRequest& request);

/// The formats; normals of length zero stand for missing ones.
/// Polygons are cut into fans around their first corner, as Mitsuba does. OBJ vertices are the distinct
/// combinations of position, texture coordinate and normal.
Mesh read_obj(const std::filesystem::path& file, bool flip_tex_coords, bool skip_normals);
Mesh read_ply(const std::filesystem::path& file, bool flip_tex_coords, bool skip_normals);

/// Fills normals that are missing or zero with the mean of the normals of the triangles around the vertex,
/// weighted by their angle there (Thuermer and Wuethrich 1998, "Computing vertex normals from polygonal
/// facets").
void compute_normals(Mesh& mesh, const std::optional<dmat3>& to_world);

}  // namespace tachylite
