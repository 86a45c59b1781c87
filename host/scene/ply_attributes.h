#pragma once

#include "scene/ply_header.h"
#include "scene/scene.h"

namespace tachylite {

/// An attribute of a mesh and the properties that it consists of.
struct PlyAttribute {
  MeshAttribute attribute;
  std::vector<size_t> columns;
};

/// Attributes among the properties, by Mitsuba's rules of naming: r g b (or red green blue) is `color`; one
/// or three neighbours that share what stands before the last underscore, and go on as _x _y _z, _0 _1 _2 or
/// _1 _2 _3 bear that name, as _r _g _b that name with _color. `prefix` ("vertex_", "face_") comes first.
/// Others are left out.
std::vector<PlyAttribute> find_ply_attributes(const PlyElement& element, const char* prefix);

/// Adds the values of one row. Integers count as fractions of the largest one, encoded as sRGB.
void append_row(PlyAttribute& target, const PlyElement& element, const std::vector<double>& row);

}  // namespace tachylite
