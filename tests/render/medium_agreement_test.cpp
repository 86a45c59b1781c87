// Media on the device and by the CPU reference agree: image/verify.h, level 1e-4 a scene (found twice at 1e-2); a bias
// of 2 % of the mean of any channel, or of 15 % of the median block, is seen with probability 0.95.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render_test.h"

namespace tachylite::test {
namespace {

constexpr int kSize = 16;

std::string volpath(int max_depth) {
  return fmt::format(R"(<integrator type="volpath"><integer name="max_depth" value="{}"/></integrator>)", max_depth);
}

const std::string kSensor = sensor_element(kSize, kSize, "0, 1.5, 5", "0, -0.2, 0", 45);
const std::string kFloor =
    R"(<shape type="rectangle"><transform name="to_world"><scale value="3"/><rotate x="1" angle="-90"/>
<translate y="-1"/></transform><bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf></shape>)";
const std::string kLamp = R"(<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/>
<translate y="2.5"/></transform><emitter type="area"><rgb name="radiance" value="8, 7, 6"/></emitter></shape>)";
const std::string kPoint = R"(<emitter type="point"><point name="position" x="2" y="3" z="2"/>
<rgb name="intensity" value="12, 10, 8"/></emitter>)";
const std::string kSky = R"(<emitter type="constant"><rgb name="radiance" value="0.4, 0.5, 0.6"/></emitter>)";

std::string medium(const char* name, const char* sigma_t, double scale, const char* phase) {
  return fmt::format(R"(<medium name="{}" type="homogeneous"><rgb name="sigma_t" value="{}"/>
<rgb name="albedo" value="0.9, 0.8, 0.6"/><float name="scale" value="{}"/>{}</medium>)",
                     name, sigma_t, scale, phase);
}
std::string ball(double radius, const std::string& inside, const char* bsdf = R"(<bsdf type="null"/>)") {
  return fmt::format(R"(<shape type="sphere"><float name="radius" value="{}"/>{}{}</shape>)", radius, bsdf, inside);
}

const char* kForward = R"(<phase type="hg"><float name="g" value="0.7"/></phase>)";
const char* kBlend = R"(<phase type="blendphase"><float name="weight" value="0.3"/>
<phase type="hg"><float name="g" value="0.8"/></phase><phase type="hg"><float name="g" value="-0.5"/></phase></phase>)";
const char* kColours = "1, 0.5, 0.2";

struct MediumScene {
  const char* name;
  std::string elements;
  bool grid = false;  // replace all media by grids
};

const std::vector<MediumScene>& scenes() {
  static const std::vector<MediumScene> kScenes = {
      {"ColoursAndForward", volpath(12) + kSensor + kFloor + kLamp + ball(0.9, medium("interior", kColours, 3, kForward))},
      {"BlendedPhase", volpath(6) + kSensor + kFloor + kPoint + ball(0.9, medium("interior", "1, 1, 1", 2, kBlend))},
      {"CameraInside", volpath(5) + [] {
         std::string sensor = kSensor;
         return sensor.insert(sensor.find("</sensor>"), R"(<ref id="fog"/>)");
       }() + R"(<medium id="fog" type="homogeneous"><rgb name="sigma_t" value="0.2, 0.15, 0.1"/>
<rgb name="albedo" value="0.8, 0.8, 0.8"/></medium>)" + kFloor + kLamp},
      {"Nested", volpath(10) + kSensor + kFloor + kLamp + kSky +
                     ball(1.0, medium("interior", "0.5, 0.8, 1", 1, "")) +
                     ball(0.5, medium("interior", kColours, 6, kForward) + medium("exterior", "0.5, 0.8, 1", 1, ""))},
      // The lights stand outside: at a light within the medium the variance of the reference's samples is unbounded.
      {"PointAndSpotInNested", volpath(4) + kSensor + kFloor + kPoint + R"(<emitter type="spot">
<transform name="to_world"><lookat origin="-2, 2, 1" target="0, 0, 0" up="0, 1, 0"/></transform>
<rgb name="intensity" value="10, 12, 14"/></emitter>)" + ball(1.2, medium("interior", "0.6, 0.4, 0.2", 1, "")) +
           ball(0.7, medium("interior", kColours, 2, kForward) + medium("exterior", "0.6, 0.4, 0.2", 1, ""),
                R"(<bsdf type="thindielectric"/>)")},
      {"Mask", volpath(5) + kSensor + kFloor + kLamp + kPoint + ball(0.9, medium("interior", kColours, 1, ""),
       R"(<bsdf type="mask"><float name="opacity" value="0.4"/><bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf>)")},
      {"ObjectInside", volpath(8) + kSensor + kFloor + kLamp + ball(1.1, medium("interior", kColours, 0.8, "")) +
                           ball(0.5, "", R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)")},
      {"Grid", volpath(8) + kSensor + kFloor + kLamp + kPoint + ball(0.9, medium("interior", kColours, 1, kForward)), true},
  };
  return kScenes;
}

// Sigma_t and albedo of 4^3 voxels each, in three channels, turned against the axes.
void replace_by_grids(Scene& scene) {
  const auto grid = [](float low, float high, uint32_t seed) {
    auto g = std::make_shared<Grid>();
    g->nx = g->ny = g->nz = 4;
    g->channels = 3;
    for (int i = 0; i < 4 * 4 * 4 * 3; ++i) {
      seed = seed * 1664525u + 1013904223u;
      g->values.push_back(low + (high - low) * static_cast<float>(seed >> 8) / 16777216.0f);
    }
    return g;
  };
  for (Medium& m : scene.media) {
    HeterogeneousMedium h;
    h.scale = 2;
    h.sigma_t.grid = grid(0, 2, 1);
    h.albedo.grid = grid(0.3f, 1, 2);
    h.albedo.filter = FilterType::kNearest;
    const double c = 0.8, s = 0.6;
    h.sigma_t.to_world = dmat4(1.6 * c, 0, -1.6 * s, 0, 0, 1.6, 0, 0, 1.6 * s, 0, 1.6 * c, 0, -1.1, -0.8, -0.2, 1);
    h.albedo.to_world = h.sigma_t.to_world;
    m.kind = h;
  }
}

class MediumAgreement : public DeviceTest, public ::testing::WithParamInterface<size_t> {};

TEST_P(MediumAgreement, DeviceAndReference) {
  Scene scene = scene_from_elements(scenes()[GetParam()].elements);
  if (scenes()[GetParam()].grid) replace_by_grids(scene);
  EXPECT_NE(pack_scene(scene).features.media, 0u);
  VerifyOptions options;
  options.mean_bias = 0.02;
  options.block_bias = 0.15;
  options.most_samples = 16384;
  expect_agreement(scene, options);
}

INSTANTIATE_TEST_SUITE_P(Media, MediumAgreement, ::testing::Range(size_t{0}, scenes().size()),
                         [](const auto& parameter) { return std::string(scenes()[parameter.param].name); });

}  // namespace
}  // namespace tachylite::test
