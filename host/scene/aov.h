#pragma once

#include <string>
#include <vector>

namespace tachylite {

/// One auxiliary output: its kind (kAov... of shared/aov.h) and the names of its EXR channels.
struct Aov {
  uint32_t kind = 0;
  std::vector<std::string> channels;  // "albedo.R", "albedo.G", "albedo.B"
};

/// Each specification is "type" or "name:type" as in Mitsuba's `aov` integrator, several joined by commas. Types:
/// albedo .R .G .B; depth .T; position, geo_normal, sh_normal (or normal), dp_du, dp_dv .X .Y .Z; uv .U .V;
/// prim_index, shape_index .I. Throws InputError on others.
std::vector<Aov> parse_aovs(const std::vector<std::string>& specifications);

/// The channels m2_R, m2_G, m2_B of the `moment` integrator: mean squares of the samples.
Aov moment_aov();

}  // namespace tachylite
