#include "bench/diffuse_scene.h"

#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "support/render_test.h"

namespace tachylite::bench {

Scene diffuse_scene(const BenchScene& scene, uint32_t max_depth) {
  std::string obj;
  for (const glm::vec3& v : scene.mesh.vertices) obj += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
  // The last two triangles are the light.
  for (size_t i = 0; i + 2 < scene.mesh.triangles.size(); ++i) {
    const glm::uvec3 t = scene.mesh.triangles[i] + 1u;
    obj += fmt::format("f {} {} {}\n", t.x, t.y, t.z);
  }
  const auto& [corner, u, v] = scene.light;
  const glm::vec3 centre = corner + 0.5f * (u + v), n = glm::normalize(glm::cross(u, v));
  const Camera& c = scene.camera;
  return test::scene_from_elements(
      fmt::format(R"(<integrator type="path"><integer name="max_depth" value="{}"/>
<integer name="rr_depth" value="1000"/></integrator>
<sensor type="perspective"><float name="fov" value="{}"/><transform name="to_world">
<lookat origin="{}, {}, {}" target="{}, {}, {}" up="0, 0, 1"/></transform><film type="hdrfilm">
<integer name="width" value="{}"/><integer name="height" value="{}"/><rfilter type="box"/></film></sensor>
<shape type="obj"><string name="filename" value="mesh.obj"/><boolean name="face_normals" value="true"/>
<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.7, 0.7"/></bsdf></bsdf></shape>)",
                  max_depth, c.fov_degrees, c.eye.x, c.eye.y, c.eye.z, c.target.x, c.target.y, c.target.z, c.resolution,
                  c.resolution) +
          fmt::format(R"(<shape type="rectangle"><transform name="to_world">
<matrix value="{} {} {} {} {} {} {} {} {} {} {} {} 0 0 0 1"/></transform>
<emitter type="area"><rgb name="radiance" value="10, 10, 10"/></emitter></shape>)",
                      u.x / 2, v.x / 2, n.x, centre.x, u.y / 2, v.y / 2, n.y, centre.y, u.z / 2, v.z / 2, n.z,
                      centre.z),
      {{"mesh.obj", obj}});
}

BakedGeometry bake_scene(const BenchScene& scene) {
  const PackedScene packed = pack_scene(diffuse_scene(scene, 1));
  const std::optional<BakedGeometry> baked = bake_geometry(packed);
  if (!baked || packed.centre != glm::dvec3(0)) throw std::invalid_argument(scene.name + " is not a tiny scene");
  return *baked;
}

}  // namespace tachylite::bench
