#pragma once

#include <optional>
#include <string>

#include <glm/glm.hpp>

namespace tachylite {

/// Index of refraction of a named dielectric ("bk7", "water", in any case), as tabulated by Mitsuba.
std::optional<double> find_index_of_refraction(std::string name);

/// eta and k of a named conductor as linear Rec.709 ("Au", "Cu"...); "none" is a perfect mirror (0 and 1).
struct ConductorIndex {
  glm::dvec3 eta, k;
};
std::optional<ConductorIndex> find_conductor(const std::string& name);

}  // namespace tachylite
