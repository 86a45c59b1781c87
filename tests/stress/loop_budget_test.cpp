// Rays of thousands of steps: Mesa 22.3.6 ends the loops of an invocation after 65,535 iterations. The image is right, or
// the render fails and says so; never a wrong image.

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "reference/reference.h"
#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

// Returns whether the driver could do it.
bool expect_right_or_refused(const std::string& name, const Scene& scene, double expected) {
  RenderOptions options;
  options.samples = 4;
  try {
    const FilmBuffer film = render_on_device(scene, options).film;
    EXPECT_LT(worst_pixel(expected)(film), 2e-6) << name;
    fmt::print("stress | {} | rendered\n", name);
    return true;
  } catch (const RenderError& error) {
    EXPECT_NE(std::string(error.what()).find("loops"), std::string::npos) << error.what();
    fmt::print("stress | {} | refused: {}\n", name, error.what());
    return false;
  }
}

using LoopBudget = DeviceTest;

TEST_F(LoopBudget, ThousandsOfSteps) {
  // Needles from corner to corner: all of their boxes hold the whole cube, and rays beside the diagonal meet all boxes
  // and none of the needles.
  for (const int count : {500, 30000}) {
    std::string obj;
    for (int i = 0; i < count; ++i)
      obj += fmt::format("v -1 -1 {0}\nv 1 1 {1}\nv 1 1 {2}\nf {3} {4} {5}\n", -1 + 1e-5 * i, 1 - 1e-5 * i, 1.00001 - 1e-5 * i,
                         3 * i + 1, 3 * i + 2, 3 * i + 3);
    const Scene scene = scene_from_elements(
        R"(<integrator type="direct"/>)" + sensor_element(32, 32, "0.5, -0.5, 4", "0.5, -0.5, 0", 6) +
            R"(<shape type="obj"><string name="filename" value="m.obj"/></shape><emitter type="constant"/>)",
        {{"m.obj", obj}});
    const bool done = expect_right_or_refused(fmt::format("{} needles whose boxes all overlap", count), scene, 1);
    EXPECT_TRUE(done || count > 1000);
    Scene small = scene;  // or the reference tests each needle for each of 1,024 rays
    Film& film = small.sensors[0].film;
    film.width = film.height = film.crop_width = film.crop_height = 8;
    const double error = worst_pixel(1)(render_reference(small, {.samples = 1}).film);
    EXPECT_LT(error, 2e-6) << count;
    fmt::print("stress | {} needles | reference {:.1e}\n", count, error);
  }
}

}  // namespace
}  // namespace tachylite::test
