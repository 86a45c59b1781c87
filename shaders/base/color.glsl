// Linear colours with the primaries of Rec. 709.
#ifndef TACHYLITE_BASE_COLOR_GLSL
#define TACHYLITE_BASE_COLOR_GLSL

/// Y of CIE XYZ, white (1, 1, 1) has 1.
float luminance(vec3 rgb) { return dot(rgb, vec3(0.212671, 0.715160, 0.072169)); }

float mean_component(vec3 rgb) { return (rgb.x + rgb.y + rgb.z) * (1.0 / 3.0); }

bool is_black(vec3 rgb) { return rgb == vec3(0.0); }

#endif
