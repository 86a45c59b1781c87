#include "scene/field_of_view.h"

#include <cmath>

#include "base/error.h"
#include "scene/parse_value.h"

namespace tachylite {

double FieldOfView::along_x(double aspect) const {
  const double half = std::tan(angle / 2);
  if (axis == "y" || (axis == "smaller" && aspect > 1) || (axis == "larger" && aspect <= 1))
    return 2 * std::atan(half * aspect);
  if (axis == "diagonal") return 2 * std::atan(half / std::sqrt(1 + 1 / (aspect * aspect)));
  return angle;
}

FieldOfView read_field_of_view(const Plugin& plugin) {
  const std::string axis = plugin.word("fov_axis", "x", {"x", "y", "diagonal", "smaller", "larger"});
  if (plugin.has("fov")) {
    if (plugin.has("focal_length"))
      throw InputError(plugin.where("fov"), fmt::format("{} has fov as well as focal_length", plugin.type()));
    return {glm::radians(plugin.real("fov", 0, {0, 180, true, true})), axis};
  }
  std::string length = plugin.string("focal_length", "50mm");
  if (length.ends_with("mm")) length.resize(length.size() - 2);
  const auto millimetres = parse_real(length);
  if (!millimetres || *millimetres <= 0) plugin.fail("focal_length", "a length such as 50mm");
  // The diagonal of a 36 x 24 mm negative.
  return {2 * std::atan(std::sqrt(36.0 * 36 + 24 * 24) / (2 * *millimetres)), "diagonal"};
}

}  // namespace tachylite
