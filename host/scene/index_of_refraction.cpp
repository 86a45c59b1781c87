#include "scene/index_of_refraction.h"

#include <algorithm>
#include <cctype>
#include <map>

namespace tachylite {

std::optional<double> find_index_of_refraction(std::string name) {
  static const std::map<std::string, double> table{
      {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
      {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
      {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
      {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
      {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
      {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
      {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
      {"pet", 1.5750},      {"diamond", 2.419},
  };
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto found = table.find(name);
  return found == table.end() ? std::nullopt : std::optional(found->second);
}

std::optional<ConductorIndex> find_conductor(const std::string& name) {
  // Tabulated spectra integrated against the CIE 1931 curves without an illuminant, negative results set to
  // 0.
  static const std::map<std::string, ConductorIndex> table{
      {"none", {glm::dvec3(0), glm::dvec3(1)}},
      {"a-C", {{2.94405, 2.22714, 1.96816}, {.88746, .79930, .81529}}},
      {"Ag", {{.15528, .11673, .13839}, {4.82835, 3.12222, 2.14690}}},
      {"Al", {{1.65750, .88040, .52124}, {9.22381, 6.26950, 4.83700}}},
      {"Au", {{.14304, .37531, 1.44205}, {3.98300, 2.38556, 1.60336}}},
      {"Cr", {{4.36967, 2.91651, 1.65490}, {5.20655, 4.23131, 3.75470}}},
      {"Cu", {{.20101, .92375, 1.10222}, {3.91326, 2.45305, 2.14209}}},
      {"Ni_palik", {{2.36730, 1.66337, 1.46708}, {4.49881, 3.05015, 2.34544}}},
      {"W", {{4.37082, 3.30025, 2.99841}, {3.50064, 2.60487, 2.27323}}},
  };
  const auto found = table.find(name);
  return found == table.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace tachylite
