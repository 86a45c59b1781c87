#pragma once

#include <string>
#include <vector>

#include "support/test_mesh.h"

namespace tachylite::bench {

struct Camera {
  glm::vec3 eye{0}, target{0};
  float fov_degrees = 60;  // of the square image's width
  uint32_t resolution = 512;
};

struct RectangleLight {
  glm::vec3 corner{0}, edge_u{0}, edge_v{0};
};

/// A closed scene made in code: every ray from the inside hits something. z is up.
struct BenchScene {
  std::string name;
  test::TestMesh mesh;
  Camera camera;
  RectangleLight light;  // where shadow rays end; lies in front of the ceiling
};

/// "cornell": 38 triangles, the box closed behind the camera. "plates": 38, twelve tilted squares in a cube. "room":
/// 240 thousand triangles, 60 displaced spheres, boxes and thin columns. "big": the same with spheres of 32 thousand
/// triangles each, 1.9 million in all. Throws std::invalid_argument for another name.
BenchScene make_scene(const std::string& name);
std::vector<std::string> scene_names();
/// Those whose primitives can be constants of kernels (pack/bake_geometry.h). They are centred at the origin, as
/// packing does it.
std::vector<std::string> tiny_scene_names();

}  // namespace tachylite::bench
