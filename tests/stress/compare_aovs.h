#pragma once

// Whether auxiliary channels of two renderers agree. Their images hold no variances, so each is rendered several times.

#include <array>
#include <functional>
#include <string>

#include "image/film.h"

namespace tachylite::test {

constexpr size_t kAovReplicates = 8;
using AovReplicates = std::array<Image, kAovReplicates>;

/// The replicates' means, in blocks of 8 x 8 pixels and in all of them, lie no further apart than 8 standard errors and
/// 1e-4 of the largest value of the channel and its siblings (.X, .Y, .Z). Noise comes from edges and from what varies
/// within a pixel. The error of a block may hang on few values: with 7 degrees of freedom 8 are exceeded with
/// probability 9e-5. Returns a line on the channel that is furthest off; empty: none.
std::string compare_aovs(const AovReplicates& a, const AovReplicates& b);

/// Second moments of paths are a renderer's own: they go by how it samples. But they are the mean squares of its
/// samples, which images of the first 1, 2, 3 ... samples tell, up to rounding. Returns the worst of the pixels where
/// they are not; empty: none. `render` gives the film of the first so many samples of a scene with moments.
std::string check_moments(const std::function<FilmBuffer(uint64_t samples)>& render);

}  // namespace tachylite::test
