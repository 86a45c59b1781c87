#pragma once

#include <string>
#include <vector>

namespace tachylite {

/// One auxiliary output: its kind (kAov... of shared/aov.h) and the names of its EXR channels.
struct Aov {
  uint32_t kind = 0;
  std::vector<std::string> channels;  // "albedo.R", "albedo.G", "albedo.B"
};

/// Each specification is "type" or, with a name of its own, "name:type" as in Mitsuba's `aov` integrator. Types:
/// albedo .R .G .B; depth .Z, or .T after a name as in Mitsuba's files; position, normal (or sh_normal), geo_normal,
/// dp_du, dp_dv .X .Y .Z; uv .U .V; prim_index, shape_index, sample_count .I. Those that are asked for twice are given
/// once. Throws InputError on other types, and where two share a name.
std::vector<Aov> parse_aovs(const std::vector<std::string>& specifications);

/// Takes sample_count out of a list, for it is not a mean over samples. Returns its channel; empty: not asked for.
std::string take_sample_count(std::vector<Aov>& aovs);

/// The channels m2_R, m2_G, m2_B of the `moment` integrator: mean squares of the samples.
Aov moment_aov();

}  // namespace tachylite
