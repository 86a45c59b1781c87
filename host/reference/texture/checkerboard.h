#pragma once

#include "reference/math.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// What the square at uv shows. As a colour: color0 where frac(u) and frac(v) are on the same side of one half, color1
/// elsewhere. As a scalar it is the other way round. That is how Mitsuba 3 does it, and images show it.
inline const ColorInput& square_as_color(const CheckerboardTexture& texture, const dvec2& uv) {
  const dvec2 f = uv - glm::floor(uv);
  return (f.x > 0.5) == (f.y > 0.5) ? texture.color0 : texture.color1;
}
inline const ColorInput& square_as_scalar(const CheckerboardTexture& texture, const dvec2& uv) {
  return &square_as_color(texture, uv) == &texture.color0 ? texture.color1 : texture.color0;
}

}  // namespace tachylite::reference
