#include "scene/ply_attributes.h"

#include <algorithm>
#include <array>

#include "image/ldr.h"

namespace tachylite {
namespace {

/// Indices of the properties of these names, or nothing if one is missing.
std::vector<size_t> find_all(const PlyElement& element, std::array<const char*, 3> names) {
  std::vector<size_t> columns;
  for (const char* name : names)
    if (const int i = element.find(name); i >= 0 && !element.properties[static_cast<size_t>(i)].is_list)
      columns.push_back(static_cast<size_t>(i));
  return columns.size() == names.size() ? columns : std::vector<size_t>();
}

/// "flow_x" -> "flow", 'x'; no letter when it is no part of an attribute.
std::pair<std::string, char> split_name(const PlyProperty& property) {
  const size_t underscore = property.name.rfind('_');
  if (property.is_list || underscore == property.name.npos || underscore == 0 ||
      underscore + 2 != property.name.size())
    return {"", '\0'};
  return {property.name.substr(0, underscore), property.name.back()};
}

}  // namespace

std::vector<PlyAttribute> find_ply_attributes(const PlyElement& element, const char* prefix) {
  std::vector<PlyAttribute> found;
  const auto add = [&](const std::string& name, std::vector<size_t> columns) {
    found.push_back({{prefix + name, static_cast<int>(columns.size()), {}}, std::move(columns)});
  };
  auto color = find_all(element, {"r", "g", "b"});
  if (color.empty()) color = find_all(element, {"red", "green", "blue"});
  if (!color.empty()) add("color", color);

  for (size_t first = 0, next = 0; first < element.properties.size(); first = std::max(next, first + 1)) {
    const auto [name, letter] = split_name(element.properties[first]);
    for (const std::string_view sequence : {"xyz", "rgb", "012", "123"}) {
      if (letter != sequence[0]) continue;
      next = first;
      while (next < element.properties.size() && next - first < 3 &&
             split_name(element.properties[next]) == std::pair(name, sequence[next - first]))
        ++next;
      if (next - first == 2) continue;  // neither a number nor a colour
      std::vector<size_t> columns;
      for (size_t i = first; i < next; ++i) columns.push_back(i);
      add(sequence == "rgb" ? name + "_color" : name, columns);
    }
  }
  return found;
}

void append_row(PlyAttribute& target, const PlyElement& element, const std::vector<double>& row) {
  for (const size_t column : target.columns) {
    const double largest = largest_integer(element.properties[column].type);
    const auto value = static_cast<float>(largest > 0 ? std::max(row[column], 0.0) / largest : row[column]);
    target.attribute.values.push_back(largest > 0 ? srgb_to_linear(value) : value);
  }
}

}  // namespace tachylite
