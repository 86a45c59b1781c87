#include "scene/index_of_refraction.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>

#include <fmt/format.h>

namespace tachylite {
namespace {

struct Conductor {
  std::string_view name;
  glm::dvec3 eta, k;
};

// Tabulated spectra (luxpop.com, after Palik 1998, "Handbook of Optical Constants of Solids", and CXRO and LLNL's
// scattering factors) integrated against the CIE 1931 curves without an illuminant, negative results set to 0. Where
// the data end within the visible range the spectrum is 0 beyond: so AlSb, which reflects all red. Most but the eight
// of shared/scene-format.md, Ir's eta and TiN's k are as Tungsten (Bitterli 2014) integrated the same data, which
// differs from Mitsuba's sum of 1000 steps by up to 7e-4.
const Conductor kConductors[] = {
    {"none", {0, 0, 0}, {1, 1, 1}},
    {"a-C", {2.94405, 2.22714, 1.96816}, {.88746, .79930, .81529}},
    {"Ag", {.15528, .11673, .13839}, {4.82835, 3.12222, 2.14690}},
    {"Al", {1.65750, .88040, .52124}, {9.22381, 6.26950, 4.83700}},
    {"AlAs", {3.6051, 3.23294, 2.21756}, {.000667, 0, .00743}},
    {"AlSb", {0, 4.14275, 4.66977}, {0, .09377, 1.30074}},
    {"Au", {.14304, .37531, 1.44205}, {3.98300, 2.38556, 1.60336}},
    {"Be", {4.18506, 3.18506, 2.78409}, {3.83544, 3.01013, 2.86901}},
    {"Cr", {4.36967, 2.91651, 1.65490}, {5.20655, 4.23131, 3.75470}},
    {"CsI", {2.1449, 1.70232, 1.66242}, {0, 0, 0}},
    {"Cu", {.20101, .92375, 1.10222}, {3.91326, 2.45305, 2.14209}},
    {"Cu2O", {3.54928, 2.95206, 2.73692}, {.11322, .19467, .60017}},
    {"Cu_palik", {.21268, .91999, 1.10241}, {3.92156, 2.45715, 2.13665}},
    {"CuO", {3.24538, 2.44963, 2.19741}, {.52027, .57074, .71723}},
    {"d-C", {2.71125, 2.31858, 2.22886}, {0, 0, 0}},
    {"Hg", {2.39893, 1.44003, .90955}, {6.32763, 4.37194, 3.42179}},
    {"HgTe", {4.77953, 3.231, 2.66003}, {1.63198, 1.58082, 1.72958}},
    {"Ir", {3.0863, 2.08219, 1.61791}, {5.59215, 4.06718, 3.26726}},
    {"K", {.06405, .04641, .03818}, {2.10422, 1.34894, .91321}},
    {"Li", {.26579, .19561, .22092}, {3.54017, 2.31113, 1.66859}},
    {"MgO", {2.08959, 1.65072, 1.59488}, {0, 0, 0}},
    {"Mo", {4.4837, 3.52546, 2.77608}, {4.11113, 3.42087, 3.1506}},
    {"Na_palik", {.06027, .05614, .06199}, {3.17929, 2.11248, 1.57909}},
    {"Nb", {3.42014, 2.79019, 2.39559}, {3.44138, 2.73764, 2.57991}},
    {"Ni_palik", {2.36730, 1.66337, 1.46708}, {4.49881, 3.05015, 2.34544}},
    {"Rh", {2.5858, 1.86019, 1.55443}, {6.78229, 4.70295, 3.97609}},
    {"Se", {4.05926, 2.84269, 2.82076}, {.75438, .63852, .52159}},
    {"Se-e", {5.72427, 4.1654, 4.08161}, {.87137, 1.10528, 1.56478}},
    {"SiC", {3.17235, 2.52597, 2.47936}, {7e-7, 0, 1e-5}},
    {"SnTe", {4.52519, 1.98115, 1.28168}, {0, 0, 0}},
    {"Ta", {2.06258, 2.39309, 2.62807}, {2.40805, 1.74137, 1.94704}},
    {"Te", {7.39084, 4.4821, 2.63707}, {3.25614, 3.52739, 3.29217}},
    {"Te-e", {7.50904, 4.29646, 2.36987}, {5.58421, 4.94762, 3.99751}},
    {"ThF4", {1.83072, 1.44223, 1.38765}, {0, 0, 0}},
    {"TiC", {3.70047, 2.83744, 2.5823}, {3.26569, 2.35156, 2.17279}},
    {"TiN", {1.64847, 1.15045, 1.37978}, {3.36833, 1.9435, 1.10207}},
    {"TiO2", {3.45662, 2.80171, 2.90515}, {.000103, 0, .000636}},
    {"TiO2-e", {3.10656, 2.51316, 2.58238}, {2.9e-5, 0, .000178}},
    {"V_palik", {4.27751, 3.51315, 2.76113}, {3.49118, 2.88936, 3.1117}},
    {"VC", {3.65757, 2.75273, 2.53268}, {3.06835, 2.19867, 1.96318}},
    {"VN", {2.8656, 2.11918, 1.94008}, {3.03233, 2.05611, 1.61629}},
    {"W", {4.37082, 3.30025, 2.99841}, {3.50064, 2.60487, 2.27323}},
};

/// What Mitsuba has under two names: the one with _palik means the same.
std::string_view without_palik(std::string_view name) {
  constexpr std::string_view kSuffix = "_palik";
  constexpr std::string_view kNoSecondName[] = {"a-C", "Ag", "Al", "Au", "Cr", "W", "none"};
  if (!name.ends_with(kSuffix)) return name;
  name.remove_suffix(kSuffix.size());
  return std::ranges::find(kNoSecondName, name) == std::end(kNoSecondName) ? name : std::string_view();
}

}  // namespace

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

std::optional<ConductorIndex> find_conductor(std::string_view name) {
  for (const std::string_view word : {name, without_palik(name)}) {
    const auto found = std::ranges::find(kConductors, word, &Conductor::name);
    if (found != std::end(kConductors)) return ConductorIndex{found->eta, found->k};
  }
  return std::nullopt;
}

std::string list_conductors() {
  std::string list;
  for (const Conductor& conductor : kConductors) list += fmt::format("{}{}", list.empty() ? "" : ", ", conductor.name);
  return list;
}

}  // namespace tachylite
