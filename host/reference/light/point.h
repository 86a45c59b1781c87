#pragma once

// Emitters without extent: point, spot, projector, directional. `weight` of their samples is the irradiance
// on a surface that faces them; pdf is 1.

#include <optional>

#include "reference/light/light.h"

namespace tachylite::reference {

/// intensity / r^2.
std::optional<LightSample> sample_point_light(const PointEmitter& emitter, const dvec3& receiver);

/// Along local +z. The falloff is linear in the angle theta: 1 up to beam_width, then (cutoff - theta) /
/// (cutoff - beam_width), 0 beyond; times intensity / r^2. The texture is looked up at
/// uv = 1/2 + (x, y) / (2 z tan(cutoff)) of the local direction.
std::optional<LightSample> sample_spot_light(const SpotEmitter& emitter, const Scene& scene,
                                             const dvec3& receiver);

/// A pinhole camera run backwards, along local +z with +x to the left of its image, x_fov wide, as high as
/// the texture's aspect asks. Irradiance on a surface facing it: pi scale E(uv) / (z^2 cos theta), z and
/// theta of the receiver in its space; so a screen at z = 1 gets the irradiance pi scale E.
std::optional<LightSample> sample_projector_light(const ProjectorEmitter& emitter, const Scene& scene,
                                                  const dvec3& receiver);

std::optional<LightSample> sample_directional_light(const DirectionalEmitter& emitter);

}  // namespace tachylite::reference
