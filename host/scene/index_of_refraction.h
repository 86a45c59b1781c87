#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <glm/glm.hpp>

namespace tachylite {

/// Index of refraction of a named dielectric ("bk7", "water", in any case), as tabulated by Mitsuba.
std::optional<double> find_index_of_refraction(std::string name);

/// eta and k of a named conductor as linear Rec.709 ("Au", "Cu_palik"...: Mitsuba's names, which are those of files);
/// "none" is a perfect mirror (0 and 1).
struct ConductorIndex {
  glm::dvec3 eta, k;
};
std::optional<ConductorIndex> find_conductor(std::string_view name);
/// All their names, but for second ones with _palik.
std::string list_conductors();

}  // namespace tachylite
