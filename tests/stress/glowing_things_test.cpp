// A closed room in which everything emits 1 and reflects half, with things in it that are hard to hit, to leave or to
// bound. Every path sums to 1 + 1/2 + 1/4 + ... exactly (closed_room_test.cpp): the bound is rounding.

#include <cmath>

#include <fmt/format.h>

#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

constexpr int kSize = 48;
constexpr int kDepth = 20;
const double kSum = 2 - std::ldexp(1.0, 1 - kDepth);

const std::string kGlow = R"(<bsdf type="diffuse"/><emitter type="area"><float name="radiance" value="1"/></emitter>)";

// `scale`: of the room, a sphere or a box around the origin; the camera looks from (0.2, 0.1, 0.9) at `target`.
std::string room(double scale, const std::string& target, double fov, const std::string& kind = "cube") {
  return fmt::format(R"(<integrator type="path"><integer name="max_depth" value="{}"/>
<integer name="rr_depth" value="100000"/></integrator>
<sensor type="perspective"><float name="fov" value="{}"/><float name="near_clip" value="{}"/>
<float name="far_clip" value="{}"/><transform name="to_world"><lookat origin="{}, {}, {}" target="{}" up="0, 1, 0"/>
</transform><film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/>
<rfilter type="box"/></film></sensor>
<shape type="{}"><boolean name="flip_normals" value="true"/><transform name="to_world"><scale value="{}"/></transform>{}</shape>
)",
                     kDepth, fov, 1e-6 * scale, 1e4 * scale, 0.2 * scale, 0.1 * scale, 0.9 * scale, target, kSize, kSize,
                     kind, scale, kGlow);
}

std::string thing(const std::string& type, const std::string& transform, const std::string& more = "") {
  return fmt::format(R"(<shape type="{}">{}<transform name="to_world">{}</transform>{}</shape>
)",
                     type, more, transform, kGlow);
}

void expect_even(const std::string& name, const std::string& elements,
                 const std::vector<std::pair<std::string, std::string>>& files = {}) {
  Scene scene = scene_from_elements(elements, files);
  scene.integrator.strategy = Integrator::Strategy::kBsdfOnly;
  expect_stress(scene, {.name = name, .samples = 8, .bound = 2e-6, .error = worst_pixel(kSum), .both_structures = true});
}

using GlowingThings = DeviceTest;

TEST_F(GlowingThings, Slivers) {
  for (const char* size : {R"(y="2e-4" z="2e-4")", R"(y="2e-4" z="4e-6")"}) {
    std::string scene = room(1, "0, 0, 0", 60);
    for (int i = 0; i < 24; ++i)
      scene += thing("cube", fmt::format(R"(<scale x="0.4" {}/><rotate x="1" y="{}" z="2" angle="{}"/>
<translate x="{}" y="{}" z="{}"/>)", size, i % 5, 37 * i, 0.03 * (i % 7) - 0.1, 0.04 * (i % 5) - 0.1, -0.05 * (i % 4)));
    expect_even(fmt::format("boxes, half sides 0.4, {}", size), scene);
  }
  // A box with a row of vertices 6e-7 beside an edge of length 0.8: a strip of triangles of aspect 1e6.
  std::string obj;
  for (const double z : {-0.2, 0.2})
    for (const double y : {-0.3, 0.3 - 6e-7, 0.3})
      for (const double x : {-0.4, 0.4}) obj += fmt::format("v {} {:.9f} {}\n", x, y, z);
  const auto at = [](int x, int y, int z) { return 1 + x + 2 * y + 6 * z; };
  const auto quad = [&](bool turned, int a, int b, int c, int d) {
    obj += turned ? fmt::format("f {} {} {}\nf {} {} {}\n", c, b, a, d, c, a) : fmt::format("f {} {} {}\nf {} {} {}\n", a, b, c, a, c, d);
  };
  for (int end = 0; end < 2; ++end) {
    for (int y = 0; y < 2; ++y) {
      quad(end == 0, at(0, y, end), at(1, y, end), at(1, y + 1, end), at(0, y + 1, end));
      quad(end == 0, at(end, y, 0), at(end, y + 1, 0), at(end, y + 1, 1), at(end, y, 1));
    }
    quad(end == 0, at(0, 2 * end, 0), at(0, 2 * end, 1), at(1, 2 * end, 1), at(1, 2 * end, 0));
  }
  for (const int angle : {0, 23})
    expect_even(fmt::format("a box with strips of aspect 1e6, turned by {}", angle), room(1, "0, 0, 0", 50) +
                thing("obj", fmt::format(R"(<rotate x="1" y="3" angle="{}"/>)", angle),
                      R"(<string name="filename" value="m.obj"/><boolean name="face_normals" value="true"/>)"), {{"m.obj", obj}});
}

TEST_F(GlowingThings, TouchingBoxes) {
  // 27 cubes face to face: each inner face lies on another one that looks the other way.
  std::string scene = room(1, "0, 0, 0", 50);
  for (int i = 0; i < 27; ++i)
    scene += thing("cube", fmt::format(R"(<scale value="0.1"/><translate x="{}" y="{}" z="{}"/>
<rotate x="1" y="2" z="3" angle="30"/>)", 0.2 * (i % 3 - 1), 0.2 * (i / 3 % 3 - 1), 0.2 * (i / 9 - 1)));
  expect_even("27 boxes face to face", scene);
}

TEST_F(GlowingThings, OverlappingAndDuplicate) {
  std::string scene = room(1, "0, 0, 0", 50);
  for (int i = 0; i < 5; ++i) scene += thing("cube", R"(<scale value="0.2"/><rotate y="1" angle="20"/>)");
  scene += thing("cube", R"(<scale x="0.4" y="0.2" z="0.1"/><rotate y="1" angle="20"/>)");
  scene += thing("cube", R"(<scale x="0.1" y="0.2" z="0.4"/><rotate y="1" angle="20"/>)");
  expect_even("coplanar overlapping faces, five times the same box", scene);
}

TEST_F(GlowingThings, DegenerateTriangles) {
  // A tetrahedron with each face twice, and triangles without area: points, lines, repeated vertices.
  const std::string obj = "v 0 0 0.5\nv 0.5 0 -0.3\nv -0.3 0.4 -0.3\nv -0.3 -0.4 -0.3\nv 0.1 0 0.18\nv 0.1 0 0.18\n"
                          "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n"
                          "f 1 1 1\nf 1 2 2\nf 1 5 2\nf 5 6 1\nf 5 5 6\nf 2 3 2\n";
  expect_even("degenerate and duplicate triangles",
              room(1, "0, 0, 0", 50) + thing("obj", R"(<scale value="0.8"/>)", R"(<string name="filename" value="m.obj"/><boolean name="face_normals" value="true"/>)"),
              {{"m.obj", obj}});
}

TEST_F(GlowingThings, SpheresFrom1eMinus6To1e6) {
  // A room of radius 1e6; a sphere of 1e-6 that fills the view, beside others of 1e-6, 1 and 1e5.
  std::string scene = room(1e6, "0, 0, 0", 60, "sphere") + thing("sphere", R"(<scale value="1e5"/><translate x="3e5"/>)") +
                      thing("sphere", R"(<scale value="1"/><translate y="-5e5"/>)");
  expect_even("sphere of 1e5 and of 1 in one of 1e6", scene);
  std::string near = fmt::format(R"(<integrator type="path"><integer name="max_depth" value="{}"/>
<integer name="rr_depth" value="100000"/></integrator>
<sensor type="perspective"><float name="fov" value="30"/><float name="near_clip" value="1e-7"/>
<float name="far_clip" value="1e9"/><transform name="to_world"><lookat origin="0, 0, 4e-6" target="0, 0, 0" up="0, 1, 0"/>
</transform><film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/>
<rfilter type="box"/></film></sensor>)", kDepth, kSize, kSize);
  near += thing("sphere", R"(<scale value="1e6"/>)", R"(<boolean name="flip_normals" value="true"/>)") +
          thing("sphere", R"(<scale value="1e-6"/>)") + thing("sphere", R"(<scale value="1e-6"/><translate x="2e-6"/>)") +
          thing("sphere", R"(<scale value="1"/><translate x="3"/>)");
  expect_even("spheres of 1e-6 that touch, seen from 4e-6, in one of 1e6", near);
}

TEST_F(GlowingThings, HugeBesideTiny) {
  std::string scene = room(1e4, "0, 0, 0", 60);
  for (int i = 0; i < 12; ++i)
    scene += thing("cube", fmt::format(R"(<scale value="{}"/><rotate x="1" y="1" angle="{}"/><translate x="{}" y="{}"/>)",
                                       std::pow(10.0, i % 7 - 3), 25 * i, 800 * (i % 4) - 1200, 900 * (i / 4) - 900));
  expect_even("boxes of 1e-3 to 1e3 in a room of 1e4", scene);
}

TEST_F(GlowingThings, CylindersFromWallToWall) {
  // Their ends lie outside the room.
  std::string scene = room(1, "0, 0, 0", 50);
  for (int i = 0; i < 9; ++i)
    scene += thing("cylinder", fmt::format(R"(<scale x="{0}" y="{0}" z="2.4"/><translate z="-1.2"/>
<rotate x="1" y="{1}" angle="90"/><translate x="{2}" z="{3}"/>)", std::pow(10.0, -1 - i % 5), 0, 0.2 * (i - 4), 0.1 * (i % 3)));
  expect_even("cylinders of radius 1e-5 to 0.1", scene);
}

}  // namespace
}  // namespace tachylite::test
