#include "scene/aov.h"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>

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
    Type{"albedo", gpu::kAovAlbedo, "RGB"},
    Type{"depth", gpu::kAovDepth, "Z"},  // the name that compositors know
    Type{"position", gpu::kAovPosition, "XYZ"},
    Type{"uv", gpu::kAovUv, "UV"},
    Type{"geo_normal", gpu::kAovGeoNormal, "XYZ"},
    Type{"sh_normal", gpu::kAovShNormal, "XYZ"},
    Type{"normal", gpu::kAovShNormal, "XYZ"},
    Type{"dp_du", gpu::kAovDpDu, "XYZ"},
    Type{"dp_dv", gpu::kAovDpDv, "XYZ"},
    Type{"prim_index", gpu::kAovPrimIndex, "I"},
    Type{"shape_index", gpu::kAovShapeIndex, "I"},
    Type{"sample_count", gpu::kAovSampleCount, "I"},
};

Aov parse_aov(const std::string& specification) {
  const size_t colon = specification.find(':');
  const bool named = colon != std::string::npos;
  const std::string name = specification.substr(0, colon), type = named ? specification.substr(colon + 1) : name;
  const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&](const Type& t) { return type == t.name; });
  if (found == kTypes.end()) {
    const auto names = [](const Type& t) { return t.name; };
    std::vector<std::string> known;
    std::transform(kTypes.begin(), kTypes.end(), std::back_inserter(known), names);
    throw InputError(fmt::format("there is no AOV {}, expected one of: {}", type, fmt::join(known, ", ")));
  }
  Aov aov{found->kind, {}};
  const char* suffixes = named && found->kind == gpu::kAovDepth ? "T" : found->suffixes;
  for (const char* suffix = suffixes; *suffix; ++suffix) aov.channels.push_back(name + "." + *suffix);
  return aov;
}

}  // namespace

std::vector<Aov> parse_aovs(const std::vector<std::string>& specifications) {
  std::vector<Aov> aovs;
  for (const std::string& specification : specifications) {
    const Aov aov = parse_aov(specification);
    const auto same_name = std::find_if(aovs.begin(), aovs.end(), [&](const Aov& other) {
      return std::find_first_of(aov.channels.begin(), aov.channels.end(), other.channels.begin(), other.channels.end()) !=
             aov.channels.end();
    });
    if (same_name == aovs.end())
      aovs.push_back(aov);
    else if (same_name->kind != aov.kind)
      throw InputError(fmt::format("two AOVs would be the channel {}", aov.channels[0]));
  }
  return aovs;
}

std::string take_sample_count(std::vector<Aov>& aovs) {
  std::string channel;
  std::erase_if(aovs, [&](const Aov& aov) {
    if (aov.kind == gpu::kAovSampleCount) channel = aov.channels[0];
    return aov.kind == gpu::kAovSampleCount;
  });
  return channel;
}

Aov moment_aov() {
  return {gpu::kAovMoment, {"m2_R", "m2_G", "m2_B"}};
}

}  // namespace tachylite
