#include "reference/medium/phase_function.h"

#include "reference/medium/henyey_greenstein.h"

namespace tachylite::reference {

double eval_phase(const PhaseFunction& phase, const dvec3& wo, const dvec3& wi) {
  if (const auto* hg = std::get_if<HenyeyGreensteinPhase>(&phase.kind)) {
    return eval_henyey_greenstein(hg->g, -glm::dot(wo, wi));
  }
  if (const auto* blend = std::get_if<BlendPhase>(&phase.kind)) {
    return lerp(eval_phase(*blend->first, wo, wi), eval_phase(*blend->second, wo, wi), blend->weight);
  }
  return 1 / (4 * kPi);
}

dvec3 sample_phase(const PhaseFunction& phase, const dvec3& wo, Random& random) {
  if (const auto* hg = std::get_if<HenyeyGreensteinPhase>(&phase.kind)) {
    const double c = sample_henyey_greenstein(hg->g, random.uniform());
    const double s = std::sqrt(std::max(0.0, 1 - c * c)), phi = 2 * kPi * random.uniform();
    return frame_around(-wo).to_world({s * std::cos(phi), s * std::sin(phi), c});
  }
  if (const auto* blend = std::get_if<BlendPhase>(&phase.kind)) {
    return sample_phase(random.uniform() < blend->weight ? *blend->second : *blend->first, wo, random);
  }
  return sample_sphere(random.uniform2());
}

}  // namespace tachylite::reference
