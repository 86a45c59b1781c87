// Rooms whose walls all emit 1 and reflect all: every path of 24 edges, whatever it does, sums to 24 exactly, so a
// single ray that leaks out, is shadowed by its own surface, or gets a wrong weight shows in its pixel. With bsdf
// sampling alone there is no variance: the bound is rounding.

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "reference/reference.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

constexpr int kSize = 64;
constexpr int kDepth = 24;
constexpr uint32_t kSeed = 2;
constexpr double kBound = 2e-6;

const std::string kGlow = R"(<bsdf type="diffuse"><float name="reflectance" value="1"/></bsdf><emitter type="area">
<float name="radiance" value="1"/></emitter>)";

std::string camera(double scale) {
  return fmt::format(R"(<integrator type="path"><integer name="max_depth" value="{}"/>
<integer name="rr_depth" value="100000"/></integrator>
<sensor type="perspective"><float name="fov" value="120"/><float name="near_clip" value="{}"/>
<float name="far_clip" value="{}"/><transform name="to_world"><lookat origin="{}, {}, 0" target="0, 0, {}" up="0, 1, 0"/>
</transform><film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/>
<rfilter type="box"/></film></sensor>)",
                     kDepth, 1e-3 * scale, 1e4 * scale, 0.2 * scale, 0.1 * scale, -scale, kSize, kSize);
}

// A sphere of triangles that are nowhere coplanar.
std::string sphere_obj(int rings, int segments) {
  std::string obj = "v 0 0 1\n";
  for (int r = 1; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      const double theta = M_PI * r / rings, phi = 2 * M_PI * s / segments;
      obj += fmt::format("v {} {} {}\n", std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                         std::cos(theta));
    }
  obj += "v 0 0 -1\n";
  const auto at = [&](int r, int s) { return 2 + (r - 1) * segments + s % segments; };
  const int last = 2 + (rings - 1) * segments;
  for (int s = 0; s < segments; ++s) {
    obj += fmt::format("f 1 {} {}\n", at(1, s), at(1, s + 1));
    for (int r = 1; r + 1 < rings; ++r) {
      obj += fmt::format("f {} {} {}\n", at(r, s), at(r + 1, s), at(r + 1, s + 1));
      obj += fmt::format("f {} {} {}\n", at(r, s), at(r + 1, s + 1), at(r, s + 1));
    }
    obj += fmt::format("f {} {} {}\n", at(rings - 1, s), last, at(rings - 1, s + 1));
  }
  return obj;
}

struct Room {
  const char* name;
  std::string shapes;  // {0}: the scale
};
const std::vector<Room>& rooms() {
  static const std::vector<Room> kRooms = {
      {"Cube", R"(<shape type="cube"><boolean name="flip_normals" value="true"/><transform name="to_world">
<rotate x="1" y="2" z="3" angle="40"/><scale value="{0}"/></transform>)" + kGlow + "</shape>"},
      {"Mesh", R"(<shape type="obj"><string name="filename" value="m.obj"/><boolean name="flip_normals" value="true"/>
<boolean name="face_normals" value="true"/><transform name="to_world"><scale value="{0}"/></transform>)" + kGlow +
                   "</shape>"},
      {"Sphere", R"(<shape type="sphere"><boolean name="flip_normals" value="true"/><transform name="to_world">
<scale value="{0}"/></transform>)" + kGlow + "</shape>"},
      {"Barrel", R"(<shape type="cylinder"><boolean name="flip_normals" value="true"/><point name="p0" z="-1"/>
<point name="p1" z="1"/><transform name="to_world"><scale value="{0}"/></transform>)" + kGlow + R"(</shape>
<shape type="disk"><transform name="to_world"><scale value="1.01"/><translate z="-1"/><scale value="{0}"/></transform>)" +
                     kGlow + R"(</shape><shape type="disk"><boolean name="flip_normals" value="true"/>
<transform name="to_world"><scale value="1.01"/><translate z="1"/><scale value="{0}"/></transform>)" + kGlow +
                     "</shape>"},
  };
  return kRooms;
}

/// TACHYLITE_ROOM_SAMPLES: so many a pixel, to count what is rarer.
uint64_t room_samples() {
  const char* wanted = std::getenv("TACHYLITE_ROOM_SAMPLES");
  return wanted ? std::strtoull(wanted, nullptr, 10) : 16;
}

/// `lost`: the share of rays that may be.
void expect_even_light(const std::string& name, const FilmBuffer& film, double lost) {
  int wrong = 0;
  double worst = 0;
  for (size_t i = 0; i < film.pixels(); ++i) {
    const double error = std::abs(film.mean(i).x / kDepth - 1);
    worst = std::max(worst, error);
    wrong += error > kBound;
  }
  const double rays = static_cast<double>(film.pixels() * film.samples() * kDepth), mean = lost * rays;
  fmt::print("stress | {} | bound {:.1e} | {:.1e} | {} of {} pixels beyond, of {:.1e} rays\n", name, kBound, worst,
             wrong, film.pixels(), rays);
  EXPECT_LE(wrong, mean + 5 * std::sqrt(mean)) << name << ", worst " << worst;
}

FilmBuffer on_device(const Scene& scene, KernelStructure structure) {
  RenderOptions options;
  options.samples = room_samples();
  options.seed = kSeed;
  options.structure = structure;
  DeviceRender render = render_on_device(scene, options);
  EXPECT_EQ(render.statistics.nonfinite, 0u);
  EXPECT_EQ(render.statistics.overflow, 0u);
  return std::move(render.film);
}

class ClosedRoom : public DeviceTest, public ::testing::WithParamInterface<std::tuple<size_t, double>> {};

TEST_P(ClosedRoom, EveryPathSumsToTheSame) {
  const auto [index, scale] = GetParam();
  Scene scene = scene_from_elements(camera(scale) + fmt::format(fmt::runtime(rooms()[index].shapes), scale),
                                    {{"m.obj", sphere_obj(40, 60)}});
  scene.integrator.strategy = Integrator::Strategy::kBsdfOnly;
  const std::string name = fmt::format("closed room, {}, {:.0e}", rooms()[index].name, scale);
  // A direction whose sample is 0 lies in the surface, and its path ends: 2^-23 of all, none of this seed's first 16.
  // And of what begins within a rounding of an edge, some begins beyond the next face: one of 4e8 rays was seen to.
  const double lost = 5e-9 + (room_samples() > 16 ? 0x1p-23 : 0);
  expect_even_light(name + ", stages", on_device(scene, KernelStructure::kStages), lost);
  if (index == 0) expect_even_light(name + ", one kernel", on_device(scene, KernelStructure::kFused), lost);
  Film& film = scene.sensors[0].film;
  film.width = film.height = film.crop_width = film.crop_height = kSize / 4;
  expect_even_light(name + ", reference", render_reference(scene, {.samples = 4}).film, 0);
}

INSTANTIATE_TEST_SUITE_P(Scales, ClosedRoom,
                         ::testing::Combine(::testing::Range(size_t{0}, rooms().size()),
                                            ::testing::Values(1e-4, 1.0, 1e6)),
                         [](const auto& parameter) {
                           const double scale = std::get<1>(parameter.param);
                           return std::string(rooms()[std::get<0>(parameter.param)].name) +
                                  (scale < 1 ? "Tiny" : scale > 1 ? "Huge" : "Unit");
                         });

using Placement = DeviceTest;

// Moving a scene far away changes nothing: geometry is recentred in double before it is rounded.
TEST_F(Placement, FarFromTheOriginIsTheSame) {
  const Scene near = scene_from_elements(cornell_elements(32));
  Scene far = near;
  const glm::dvec3 offset(3e5, -2e5, 1e5);
  for (Shape& shape : far.shapes) shape.to_world[3] += glm::dvec4(offset, 0);
  far.sensors[0].to_world[3] += glm::dvec4(offset, 0);
  const auto expect_same = [&](const char* by, const FilmBuffer& a, const FilmBuffer& b) {
    int different = 0;
    for (size_t i = 0; i < a.pixels(); ++i)
      different += glm::length(a.mean(i) - b.mean(i)) > 1e-3 * glm::length(a.mean(i));
    EXPECT_LE(different, 32 * 32 / 50) << by;
    fmt::print("stress | a Cornell box moved by 4e5 | {} | {} of 1024 pixels differ\n", by, different);
  };
  RenderOptions options;
  options.samples = 8;
  options.structure = KernelStructure::kStages;
  expect_same("stages", render_on_device(near, options).film, render_on_device(far, options).film);
  expect_same("reference", render_reference(near, {.samples = 8}).film, render_reference(far, {.samples = 8}).film);
}

}  // namespace
}  // namespace tachylite::test
