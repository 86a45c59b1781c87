#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// The AOV albedo, for denoisers, in [0, 1]: diffuse reflectance or base colour; of metals the reflectance at normal
/// incidence, of glass 1, of what is partly not there the part that is. from_front: the side that is seen.
dvec3 albedo_bsdf(BsdfIndex bsdf, const ShadingPoint& point, bool from_front);

}  // namespace tachylite::reference
