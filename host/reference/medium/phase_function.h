#pragma once

// Phase functions. wo points back to where the light path came from (to the viewer), wi on to where it goes
// (to the light), so the cosine between the directions of travel is -dot(wo, wi). All are sampled perfectly:
// the value is the density [1/sr].

#include "reference/random.h"
#include "scene/scene.h"

namespace tachylite::reference {

double eval_phase(const PhaseFunction& phase, const dvec3& wo, const dvec3& wi);
dvec3 sample_phase(const PhaseFunction& phase, const dvec3& wo, Random& random);

}  // namespace tachylite::reference
