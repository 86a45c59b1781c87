// A mesh with vertex normals that emits. Mitsuba converts area to solid angle by the shading normal when it samples such
// a light, so that its light and bsdf samples disagree, and what it converges to depends on the density that it weighs
// them by: uniform choice among all emitters, uniform in the mesh's area. Device and reference, which may sample
// otherwise, must converge to the same: by quadrature over the mesh.

#include <cmath>

#include <fmt/format.h>

#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

using glm::dvec3;

constexpr double kAlbedo = 0.5;
constexpr dvec3 kVertices[] = {{0.2, -0.3, 0.05}, {0.25, 0.4, 0.05}, {0.2, 0.1, 0.6}};
constexpr dvec3 kNormals[] = {{-1, 2, 0}, {-1, -2, 0.5}, {-0.3, 0, -1}};

std::string mesh_obj() {
  std::string obj;
  for (const dvec3& p : kVertices) obj += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  for (const dvec3& n : kNormals) obj += fmt::format("vn {} {} {}\n", n.x, n.y, n.z);
  return obj + "f 1//1 2//2 3//3\n";
}

/// Radiance that leaves the origin of a diffuse plane z = 0, by power-heuristic MIS with those densities: with w of the
/// light's sample, kAlbedo / pi times the integral over the mesh of cos_p (w |cos_s| + (1 - w) |cos_g|) / d^2.
double expected(int emitters) {
  const dvec3 e1 = kVertices[1] - kVertices[0], e2 = kVertices[2] - kVertices[0], across = glm::cross(e1, e2);
  const double area = glm::length(across) / 2;
  constexpr int kSteps = 400;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps - i; ++j)
      for (int half = 0; half < (i + j == kSteps - 1 ? 1 : 2); ++half) {  // the centres of a small square's two halves
        const double b1 = (i + (1 + half) / 3.0) / kSteps, b2 = (j + (1 + half) / 3.0) / kSteps;
        const dvec3 to = kVertices[0] + b1 * e1 + b2 * e2, d = glm::normalize(to);
        const dvec3 n = glm::normalize((1 - b1 - b2) * glm::normalize(kNormals[0]) + b1 * glm::normalize(kNormals[1]) +
                                       b2 * glm::normalize(kNormals[2]));
        const double d2 = glm::dot(to, to), cos_s = -glm::dot(n, d), cos_g = std::abs(glm::dot(across, d)) / (2 * area);
        if (cos_s <= 0 || d.z <= 0) continue;
        const double ratio = area * emitters * cos_s / d2 * d.z / M_PI, w = 1 / (1 + ratio * ratio);
        sum += d.z * (w * cos_s + (1 - w) * cos_g) / d2;
      }
  return kAlbedo / M_PI * sum * area / (kSteps * kSteps);
}

using SmoothLight = DeviceTest;

TEST_F(SmoothLight, WeighsAsMitsubaDoes) {
  for (const int emitters : {1, 3}) {
    std::string scene = R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>)" +
                        sensor_element(16, 16, "-1, 0, 1", "0, 0, 0", 0.2) + fmt::format(R"(
<shape type="rectangle"><bsdf type="diffuse"><float name="reflectance" value="{}"/></bsdf></shape>
<shape type="obj"><string name="filename" value="m.obj"/><emitter type="area"><float name="radiance" value="1"/></emitter>
</shape>)", kAlbedo);
    for (int i = 1; i < emitters; ++i)  // below the plane
      scene += R"(<emitter type="point"><point name="position" x="0" y="0" z="-1"/></emitter>)";
    expect_stress(scene_from_elements(scene, {{"m.obj", mesh_obj()}}),
                  {.name = fmt::format("smooth mesh that emits, {} emitters", emitters), .samples = 2048, .bound = 1e-3,
                   .error = mean_beyond_noise(dvec3(expected(emitters)))});
  }
}

}  // namespace
}  // namespace tachylite::test
