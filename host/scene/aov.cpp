#include "scene/aov.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "base/error.h"
#include "shared/aov.h"

namespace tachylite {
namespace {

struct Type {
  const char* name;
  uint32_t kind;
  const char* suffixes;  // one letter a channel
};
constexpr std::array kTypes = {
    Type{"albedo", gpu::kAovAlbedo, "RGB"},        Type{"depth", gpu::kAovDepth, "T"},
    Type{"position", gpu::kAovPosition, "XYZ"},    Type{"uv", gpu::kAovUv, "UV"},
    Type{"geo_normal", gpu::kAovGeoNormal, "XYZ"}, Type{"sh_normal", gpu::kAovShNormal, "XYZ"},
    Type{"normal", gpu::kAovShNormal, "XYZ"},      Type{"dp_du", gpu::kAovDpDu, "XYZ"},
    Type{"dp_dv", gpu::kAovDpDv, "XYZ"},           Type{"prim_index", gpu::kAovPrimIndex, "I"},
    Type{"shape_index", gpu::kAovShapeIndex, "I"},
};

}  // namespace

std::vector<Aov> parse_aovs(const std::vector<std::string>& specifications) {
  std::vector<Aov> aovs;
  for (const std::string& list : specifications) {
    std::istringstream items(list);
    for (std::string item; std::getline(items, item, ',');) {
      const size_t colon = item.find(':');
      const std::string name = item.substr(0, colon);
      const std::string type = colon == std::string::npos ? name : item.substr(colon + 1);
      const auto found =
          std::find_if(kTypes.begin(), kTypes.end(), [&](const Type& t) { return type == t.name; });
      if (found == kTypes.end())
        throw InputError(
            fmt::format("unknown AOV '{}', expected albedo, depth, position, uv, geo_normal, sh_normal, "
                        "dp_du, dp_dv, prim_index or shape_index",
                        type));
      Aov aov{found->kind, {}};
      for (const char* suffix = found->suffixes; *suffix; ++suffix)
        aov.channels.push_back(name + "." + *suffix);
      aovs.push_back(aov);
    }
  }
  return aovs;
}

Aov moment_aov() {
  return {gpu::kAovMoment, {"m2_R", "m2_G", "m2_B"}};
}

}  // namespace tachylite
