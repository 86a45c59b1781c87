// Multiple importance sampling of lights and bsdfs.
#ifndef TACHYLITE_PATH_MIS_GLSL
#define TACHYLITE_PATH_MIS_GLSL
#include "base/features.glsl"

// Power heuristic with exponent 2 (Veach 1997, section 9.2.4) as a ratio, so that large densities do not overflow.
float mis_weight(float pdf, float other) {
  float r = other / pdf;
  return 1.0 / (1.0 + r * r);
}

// Weight of light that a ray found by itself. pdf: of the ray's direction, 0 after the camera or a delta lobe, which
// no light sample competes with; light_pdf: of the light sample that could have found it.
float found_light_weight(float pdf, float light_pdf) {
  if (pdf == 0.0 || strategy == kStrategyBsdf || light_selection == kSelectNone) return 1.0;
  return strategy == kStrategyEmitter ? 0.0 : mis_weight(pdf, light_pdf);
}

#endif
