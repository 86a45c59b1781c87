#pragma once

#include "reference/random.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// Henyey and Greenstein 1941: p = (1 - g^2) / (4 pi (1 + g^2 - 2 g c)^(3/2)) [1/sr], c the cosine between
/// the directions of travel before and after; g > 0 scatters forward. |g| < 1.
double eval_henyey_greenstein(double g, double cos_theta);
/// c with the density 2 pi p.
double sample_henyey_greenstein(double g, double u);

}  // namespace tachylite::reference
