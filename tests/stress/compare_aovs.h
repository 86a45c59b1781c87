#pragma once

// Whether auxiliary channels of two renderers agree. Their images hold no variances, so each is rendered several times.

#include <array>
#include <string>

#include "image/image.h"

namespace tachylite::test {

constexpr size_t kAovReplicates = 8;
using AovReplicates = std::array<Image, kAovReplicates>;

/// The replicates' means, in blocks of 8 x 8 pixels and in all of them, lie no further apart than 8 standard errors and
/// 1e-4 of the largest value of the channel and its siblings (.X, .Y, .Z). Noise comes from edges and from what varies
/// within a pixel. The error of a block may hang on few values: with 7 degrees of freedom 8 are exceeded with
/// probability 9e-5. Returns a line on the channel that is furthest off; empty: none.
std::string compare_aovs(const AovReplicates& a, const AovReplicates& b);

}  // namespace tachylite::test
