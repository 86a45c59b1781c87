#pragma once

// Vectors, frames and the elementary warps of the reference. Everything is double precision.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/glm.hpp>

namespace tachylite::reference {

using glm::dmat3;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline double sqr(double x) {
  return x * x;
}
inline double lerp(double a, double b, double t) {
  return a + (b - a) * t;
}
inline double max_component(const dvec3& v) {
  return std::max({v.x, v.y, v.z});
}
inline double max_abs(const dvec3& v) {
  return max_component(glm::abs(v));
}
inline bool is_black(const dvec3& v) {
  return v == dvec3(0);
}
inline bool is_finite(const dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Weights of Rec.709; a colour asked for a scalar counts as this.
inline double luminance(const dvec3& c) {
  return 0.212671 * c.x + 0.715160 * c.y + 0.072169 * c.z;
}

inline dvec3 transform_point(const dmat4& m, const dvec3& p) {
  return dvec3(m * dvec4(p, 1));
}
inline dvec3 transform_vector(const dmat4& m, const dvec3& v) {
  return dmat3(m) * v;
}

/// A right-handed orthonormal frame; local coordinates have n as +z.
struct Frame {
  dvec3 s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};
  dvec3 to_local(const dvec3& v) const { return {glm::dot(v, s), glm::dot(v, t), glm::dot(v, n)}; }
  dvec3 to_world(const dvec3& v) const { return v.x * s + v.y * t + v.z * n; }
};

/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3. Mitsuba's tangents of surfaces
/// without uv.
inline Frame frame_around(const dvec3& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

/// The frame of unit normal n whose s lies along the part of `tangent` perpendicular to n; any s if there is
/// none.
inline Frame frame_around(const dvec3& n, const dvec3& tangent) {
  const dvec3 s = tangent - n * glm::dot(n, tangent);
  const double length = glm::length(s);
  if (!(length > 1e-12 * glm::length(tangent))) return frame_around(n);
  return {s / length, glm::cross(n, s / length), n};
}

// Warps of uniform numbers u in [0,1)^2.

/// Uniform on the unit disk, density 1/pi.
inline dvec2 sample_disk(const dvec2& u) {
  const double r = std::sqrt(u.x), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi)};
}
/// Directions of the upper hemisphere with density cos(theta)/pi w.r.t. solid angle.
inline dvec3 sample_cosine_hemisphere(const dvec2& u) {
  const dvec2 d = sample_disk(u);
  return {d, std::sqrt(std::max(0.0, 1 - u.x))};
}
inline double pdf_cosine_hemisphere(double cos_theta) {
  return std::max(0.0, cos_theta) / kPi;
}
/// Uniform directions, density 1/(4 pi) w.r.t. solid angle.
inline dvec3 sample_sphere(const dvec2& u) {
  const double z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Weight of technique a against b (Veach and Guibas 1995, power heuristic with exponent 2), for densities of
/// the same measure. Infinite or zero densities are served.
inline double power_heuristic(double a, double b) {
  if (a <= 0) return 0;
  const double r = b / a;
  return 1 / (1 + r * r);
}

}  // namespace tachylite::reference
