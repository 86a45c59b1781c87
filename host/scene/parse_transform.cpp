#include "scene/parse_transform.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "scene/parse_value.h"

namespace tachylite {
namespace {

using glm::dmat4;
using glm::dvec3;

double real_attribute(const XmlNode& node, std::string_view name) {
  const auto value = parse_real(node.attribute(name));
  if (!value)
    throw InputError(node.where, fmt::format("{} of <{}> is \"{}\", expected a number", name, node.tag,
                                             node.attribute(name)));
  return *value;
}

dvec3 triple_attribute(const XmlNode& node, std::string_view name) {
  const auto values = parse_reals(node.attribute(name));
  if (!values || values->size() != 3)
    throw InputError(node.where, fmt::format("{} of <{}> is \"{}\", expected three numbers", name, node.tag,
                                             node.attribute(name)));
  return {(*values)[0], (*values)[1], (*values)[2]};
}

dmat4 parse_matrix(const XmlNode& node) {
  const auto values = parse_reals(node.attribute("value"));
  if (!values || (values->size() != 16 && values->size() != 9))
    throw InputError(node.where, "<matrix> holds something else than 16 or 9 numbers");
  const size_t size = values->size() == 16 ? 4 : 3;
  dmat4 matrix{1};
  for (size_t row = 0; row < size; ++row)
    for (size_t column = 0; column < size; ++column)  // GLM indexes by column first
      matrix[static_cast<int>(column)][static_cast<int>(row)] = (*values)[row * size + column];
  return matrix;
}

dmat4 parse_rotation(const XmlNode& node) {
  const dvec3 axis = parse_vector(node);
  if (glm::length(axis) == 0) throw InputError(node.where, "<rotate> has no axis, expected e.g. y=\"1\"");
  const double angle = glm::radians(real_attribute(node, "angle"));
  return glm::rotate(dmat4(1), angle, glm::normalize(axis));
}

/// Camera frame: x left, y up, z forward.
dmat4 parse_lookat(const XmlNode& node) {
  const dvec3 origin = triple_attribute(node, "origin"), target = triple_attribute(node, "target");
  dvec3 up = node.has("up") ? triple_attribute(node, "up") : dvec3(0);
  if (glm::length(target - origin) == 0)
    throw InputError(node.where, "origin and target of <lookat> are the same");
  const dvec3 forward = glm::normalize(target - origin);
  if (up == dvec3(0)) up = std::abs(forward.x) > std::abs(forward.y) ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  const dvec3 left = glm::cross(up, forward);
  if (glm::length(left) <= 1e-12 * glm::length(up))
    throw InputError(node.where, "up of <lookat> is parallel to the viewing direction");
  const dvec3 x = glm::normalize(left);
  return {{x, 0}, {glm::cross(forward, x), 0}, {forward, 0}, {origin, 1}};
}

dmat4 parse_operation(const XmlNode& node) {
  if (!node.children.empty())
    throw InputError(node.children.front().where, fmt::format("<{}> cannot hold other elements", node.tag));
  if (node.tag == "translate") return glm::translate(dmat4(1), parse_vector(node));
  if (node.tag == "scale") return glm::scale(dmat4(1), parse_vector(node, 1));
  if (node.tag == "rotate") return parse_rotation(node);
  if (node.tag == "lookat") return parse_lookat(node);
  if (node.tag == "matrix") return parse_matrix(node);
  throw InputError(
      node.where,
      fmt::format("<{}> is no transform, expected translate, scale, rotate, lookat or matrix", node.tag));
}

}  // namespace

dvec3 parse_vector(const XmlNode& node, double absent) {
  const bool by_axis = node.has("x") || node.has("y") || node.has("z");
  if (node.has("value")) {
    if (by_axis) throw InputError(node.where, fmt::format("<{}> has value as well as x, y or z", node.tag));
    const auto values = parse_reals(node.attribute("value"));
    if (!values || (values->size() != 1 && values->size() != 3))
      throw InputError(node.where, fmt::format("value of <{}> is \"{}\", expected one or three numbers",
                                               node.tag, node.attribute("value")));
    return values->size() == 1 ? dvec3((*values)[0]) : dvec3((*values)[0], (*values)[1], (*values)[2]);
  }
  if (!by_axis) throw InputError(node.where, fmt::format("<{}> lacks x, y, z or value", node.tag));
  dvec3 vector{absent};
  if (node.has("x")) vector.x = real_attribute(node, "x");
  if (node.has("y")) vector.y = real_attribute(node, "y");
  if (node.has("z")) vector.z = real_attribute(node, "z");
  return vector;
}

dmat4 parse_transform(const XmlNode& transform) {
  dmat4 matrix{1};
  for (const XmlNode& child : transform.children) {
    child.used = true;
    matrix = parse_operation(child) * matrix;
  }
  for (int column = 0; column < 4; ++column) {
    if (matrix[column][3] != (column == 3 ? 1.0 : 0.0))
      throw InputError(transform.where, "the transform is not affine: its last row must be 0 0 0 1");
    for (int row = 0; row < 3; ++row)
      if (!std::isfinite(matrix[column][row])) throw InputError(transform.where, "the transform overflows");
  }
  // Hadamard's ratio: volume of the image of the unit cube against that of a box with the same edges.
  const glm::dmat3 linear(matrix);
  const double box = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  if (!(std::abs(glm::determinant(linear)) > 1e-12 * box))
    throw InputError(transform.where, "the transform is singular: it flattens space");
  return matrix;
}

bool is_similarity(const dmat4& transform, double tolerance) {
  const glm::dmat3 gram = glm::transpose(glm::dmat3(transform)) * glm::dmat3(transform);
  const double scale = (gram[0][0] + gram[1][1] + gram[2][2]) / 3;
  double worst = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(gram[i][j] - (i == j ? scale : 0)));
  return worst <= tolerance * scale;
}

}  // namespace tachylite
