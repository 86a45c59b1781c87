#pragma once

#include <glm/glm.hpp>

#include "scene/xml_node.h"

namespace tachylite {

/// The children of <transform> in document order, the first one acting first. Throws InputError when a number
/// is missing or broken, or when the result is not affine or (nearly) singular.
glm::dmat4 parse_transform(const XmlNode& transform);

/// Attributes x, y, z, each `absent` when not given, or `value` with one number for all or three numbers.
glm::dvec3 parse_vector(const XmlNode& node, double absent = 0);

/// |a . b| and the ratio of lengths of the images of x, y, z as far as they tell a similarity (rotation,
/// uniform scale, mirroring): true when both agree within `tolerance`.
bool is_similarity(const glm::dmat4& transform, double tolerance = 1e-4);

}  // namespace tachylite
