#pragma once

#include "scene/parse_spectrum.h"
#include "scene/scene_loader.h"

namespace tachylite {

/// <float>, <rgb>, <srgb> or <spectrum> as linear Rec.709 within the range of its use; `owner` names the
/// plugin in messages. A constant <spectrum> is that number in all channels, but on an emitter it is the
/// colour of the constant spectrum, as scene-format of Mitsuba 3 has it.
dvec3 parse_color(SceneLoader& loader, const XmlNode& node, const std::string& owner, ColorUse use);

/// Rec.709 luminance.
double luminance(const dvec3& rgb);

}  // namespace tachylite
