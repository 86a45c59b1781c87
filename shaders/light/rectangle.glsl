// Area lights on rectangles: uniform in solid angle, after Urena, Fajardo and King 2013, "An Area-Preserving
// Parametrization for Spherical Rectangles". Differences from the paper: the solid angle is a sum of two triangles'
// (Van Oosterom and Strackee 1983), which keeps its digits when it is small; the angle k of the paper's table 1 is
// never formed, only its cosine and sine, which are algebraic; x_u is solved without 1 - c_u^2.
// Rectangles that subtend less than kMinSolidAngle, or whose plane (nearly) holds p, are sampled uniformly in area; so
// are all in scenes where none is large (kLightsSphericalRectangles), which then have no code for solid angles.
#ifndef TACHYLITE_LIGHT_RECTANGLE_GLSL
#define TACHYLITE_LIGHT_RECTANGLE_GLSL
#include "base/math.glsl"
#include "light/record.glsl"

// Below it the position is uncertain by 2e-7 / solid angle of the rectangle's size, and the gain is nil.
const float kMinSolidAngle = 3e-3;

// The rectangle [x0, x1] x [y0, y1] at z = -h, h >= 0, seen from the origin. Lengths are relative to the size of
// the whole, so that fourth powers of them stay within float's range.
struct RectangleView {
  vec3 x, y, z;  // unit axes
  float x0, x1, y0, y1, h;
  vec4 r;        // distances of the corners 00, 10, 01, 11
  float solid_angle;
  bool by_area;
};

// v0: relative to p.
RectangleView view_rectangle(vec3 v0, vec3 e1, vec3 e2, vec3 n) {
  RectangleView v;
  float lx = length(e1), ly = length(e2);
  v.x = e1 / lx;
  v.y = e2 / ly;
  float scale = 1.0 / (lx + ly + abs(v0.x) + abs(v0.y) + abs(v0.z));
  float z0 = dot(v0, n) * scale;
  v.z = z0 > 0.0 ? -n : n;
  v.h = abs(z0);
  v.x0 = dot(v0, v.x) * scale;
  v.y0 = dot(v0, v.y) * scale;
  lx *= scale;
  ly *= scale;
  v.x1 = v.x0 + lx;
  v.y1 = v.y0 + ly;
  float h2 = v.h * v.h, xx0 = v.x0 * v.x0, xx1 = v.x1 * v.x1, yy0 = v.y0 * v.y0, yy1 = v.y1 * v.y1;
  v.r = sqrt(vec4(xx0 + yy0, xx1 + yy0, xx0 + yy1, xx1 + yy1) + h2);
  float volume = v.h * lx * ly, xx = v.x0 * v.x1 + h2, yy = v.y0 * v.y1 + h2;
  float across = v.x0 * v.x1 + v.y0 * v.y1 + h2;  // dot(00, 11)
  // Triangles (00, 10, 11) and (00, 11, 01).
  float lower = v.r.x * v.r.y * v.r.w + (xx + yy0) * v.r.w + (xx1 + yy) * v.r.x + across * v.r.y;
  float upper = v.r.x * v.r.w * v.r.z + across * v.r.z + (xx + yy1) * v.r.x + (xx0 + yy) * v.r.w;
  v.solid_angle = 2.0 * (xatan2(volume, lower) + xatan2(volume, upper));
  v.by_area = !has_light(kLightsSphericalRectangles) || v.solid_angle < kMinSolidAngle || v.h < 1e-4 * (lx + ly);
  return v;
}

float pdf_rectangle(RectangleView v, float area, vec3 to) {
  return v.by_area ? pdf_of_area(area, to, v.z) : 1.0 / v.solid_angle;
}

LightPoint sample_rectangle(RectangleView v, vec3 v0, vec3 e1, vec3 e2, vec3 n, float area, vec2 u) {
  // Angles between the planes through the origin and the sides: of the corners 01 (g2) and 00 (g3).
  float hx0 = v.x0 * v.x0 + v.h * v.h, hy0 = sqrt(v.y0 * v.y0 + v.h * v.h), hy1 = sqrt(v.y1 * v.y1 + v.h * v.h);
  float cos_g2 = v.x0 * v.y1, sin_g2 = v.h * v.r.z, cos_g3 = -v.x0 * v.y0, sin_g3 = v.h * v.r.x;
  float scale = 1.0 / (hx0 * hy0 * hy1);
  // k = 2 pi - g2 - g3
  float cos_k = (cos_g2 * cos_g3 - sin_g2 * sin_g3) * scale, sin_k = -(sin_g2 * cos_g3 + cos_g2 * sin_g3) * scale;
  float a = u.x * v.solid_angle, cos_a = cos(a), sin_a = sin(a);
  float cos_au = cos_a * cos_k - sin_a * sin_k, sin_au = sin_a * cos_k + cos_a * sin_k;
  float b0 = -v.y0 / hy0, b1 = v.y1 / hy1, c0 = v.h / hy0;
  float fu = (cos_au * b0 - b1) / sin_au;
  float x = v.h / sqrt(max((abs(fu) - c0) * (abs(fu) + c0), 1e-30));
  x = clamp(fu < 0.0 ? -x : x, v.x0, v.x1);
  float d2 = x * x + v.h * v.h;
  float h0 = v.y0 * inversesqrt(d2 + v.y0 * v.y0), h1 = v.y1 * inversesqrt(d2 + v.y1 * v.y1);
  float hv = h0 + u.y * (h1 - h0);
  float y = clamp(hv * sqrt(d2 / max((1.0 - hv) * (1.0 + hv), 1e-30)), v.y0, v.y1);
  vec2 st = vec2((x - v.x0) / (v.x1 - v.x0), (y - v.y0) / (v.y1 - v.y0));

  st = clamp(v.by_area ? u : st, 0.0, 1.0);
  vec3 to = v0 + st.x * e1 + st.y * e2;
  return LightPoint(to, n, pdf_rectangle(v, area, to), st);
}

#endif
