// Media on the device and by the CPU reference agree: image/verify.h, level 1e-4 a scene (found twice at 1e-2); a bias
// of mean_bias (2 % unless stated) of the mean of any channel, or of 8 times that (at least 15 %) of the median block,
// is seen with probability 0.95.

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render_test.h"
#include "support/vol_file.h"

namespace tachylite::test {
namespace {

constexpr int kSize = 16;

std::string volpath(int max_depth) {
  return fmt::format(R"(<integrator type="volpath"><integer name="max_depth" value="{}"/></integrator>)", max_depth);
}

const std::string kSensor = sensor_element(kSize, kSize, "0, 1.5, 5", "0, -0.2, 0", 45);
const std::string kCloseSensor = sensor_element(kSize, kSize, "0, 0.5, 5", "0, 0, 0", 20);
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
const std::string kNull = R"(<bsdf type="null"/>)";
const std::string kMask = R"(<bsdf type="mask"><float name="opacity" value="0.4"/>
<bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf>)";
std::string ball(double radius, const std::string& inside, const std::string& bsdf = kNull, double x = 0) {
  return fmt::format(R"(<shape type="sphere"><float name="radius" value="{}"/><point name="center" value="{}, 0, 0"/>
{}{}</shape>)", radius, x, bsdf, inside);
}

const char* kForward = R"(<phase type="hg"><float name="g" value="0.7"/></phase>)";
const char* kBlend = R"(<phase type="blendphase"><float name="weight" value="0.3"/>
<phase type="hg"><float name="g" value="0.8"/></phase><phase type="hg"><float name="g" value="-0.5"/></phase></phase>)";
const char* kColours = "1, 0.5, 0.2";

std::string refer(const char* name, const char* id) { return fmt::format(R"(<ref name="{}" id="{}"/>)", name, id); }
std::string sensor_inside(const char* id, const std::string& sensor = kSensor) {
  const size_t end = sensor.find("</sensor>");
  return sensor.substr(0, end) + fmt::format(R"(<ref id="{}"/>)", id) + sensor.substr(end);
}
std::string rough_glass(const char* distribution, double alpha_u, double alpha_v) {
  return fmt::format(R"(<bsdf type="roughdielectric"><string name="distribution" value="{}"/>
<float name="int_ior" value="1.4"/><float name="ext_ior" value="1"/>
<float name="alpha_u" value="{}"/><float name="alpha_v" value="{}"/></bsdf>)",
                     distribution, alpha_u, alpha_v);
}

std::string heterogeneous(double scale, const std::string& volumes, const char* phase = "") {
  return fmt::format(R"(<medium name="interior" type="heterogeneous"><float name="scale" value="{}"/>{}{}</medium>)",
                     scale, volumes, phase);
}
/// Over a turned box about the origin.
std::string grid(const char* name, const char* file, const char* filter) {
  return fmt::format(R"(<volume name="{}" type="gridvolume"><string name="filename" value="{}"/>
<string name="filter_type" value="{}"/><transform name="to_world"><translate value="-0.5, -0.5, -0.5"/>
<scale x="2.6" y="1.3" z="1.6"/><rotate y="1" angle="20"/></transform></volume>)", name, file, filter);
}
/// Over a box about the origin that cuts through the balls.
std::string constant(const char* name, const char* value) {
  return fmt::format(R"(<volume name="{}" type="constvolume"><rgb name="value" value="{}"/><transform name="to_world">
<translate value="-0.5, -0.5, -0.5"/><scale x="2.2" y="0.9" z="1.4"/></transform></volume>)", name, value);
}

/// "one.vol", "three.vol": 4^3 voxels in one and three channels; "sky.hdr": 6 x 4 pixels, one of them bright.
std::vector<std::pair<std::string, std::string>> files() {
  uint32_t seed = 1;
  const auto values = [&](int count) {
    std::vector<float> result;
    for (int i = 0; i < count; ++i) {
      seed = seed * 1664525u + 1013904223u;
      result.push_back(static_cast<float>(seed >> 8) / 16777216.0f);
    }
    return result;
  };
  std::string sky = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 6\n";
  for (int i = 0; i < 24; ++i)
    sky += std::string{60, static_cast<char>(80 + 4 * i), 100, static_cast<char>(i == 8 ? 131 : 128)};
  return {{"one.vol", vol_file({4, 4, 4}, 1, values(64))},
          {"three.vol", vol_file({4, 4, 4}, 3, values(192))},
          {"sky.hdr", sky}};
}

// A light without extent stands in a clear ball in it: next to it in the fog itself the variance of the reference's
// samples, taken at collisions, has no bound.
const std::string kFog = R"(<medium id="fog" type="homogeneous"><rgb name="sigma_t" value="0.2, 0.15, 0.1"/>
<rgb name="albedo" value="0.8, 0.8, 0.8"/></medium>)";
struct MediumScene {
  const char* name;
  std::string elements;
  double mean_bias = 0.02;
  uint64_t first_samples = 16;  // where the search for enough samples begins
};

const std::vector<MediumScene>& scenes() {
  static const std::vector<MediumScene> kScenes = {
      {"ColoursAndForward", volpath(12) + kSensor + kFloor + kLamp + ball(0.9, medium("interior", kColours, 3, kForward))},
      {"BlendedPhase", volpath(6) + kSensor + kFloor + kPoint + ball(0.9, medium("interior", "1, 1, 1", 2, kBlend))},
      {"CameraInside", volpath(5) + kFog + sensor_inside("fog") + kFloor + kLamp},
      {"Nested", volpath(10) + kSensor + kFloor + kLamp + kSky +
                     ball(1.0, medium("interior", "0.5, 0.8, 1", 1, "")) +
                     ball(0.5, medium("interior", kColours, 6, kForward) + medium("exterior", "0.5, 0.8, 1", 1, ""))},
      // The lights stand outside: at a light within the medium the variance of the reference's samples is unbounded.
      {"PointAndSpotInNested", volpath(4) + kSensor + kFloor + kPoint + R"(<emitter type="spot">
<transform name="to_world"><lookat origin="-2, 2, 1" target="0, 0, 0" up="0, 1, 0"/></transform>
<rgb name="intensity" value="10, 12, 14"/></emitter>)" + ball(1.2, medium("interior", "0.6, 0.4, 0.2", 1, "")) +
           ball(0.7, medium("interior", kColours, 2, kForward) + medium("exterior", "0.6, 0.4, 0.2", 1, ""),
                R"(<bsdf type="thindielectric"/>)")},
      {"Mask", volpath(5) + kSensor + kFloor + kLamp + kPoint + ball(0.9, medium("interior", kColours, 1, ""), kMask)},
      {"ObjectInside", volpath(8) + kSensor + kFloor + kLamp + ball(1.1, medium("interior", kColours, 0.8, "")) +
                           ball(0.5, "", R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)")},
      {"GridOfThreeChannels", volpath(8) + kSensor + kFloor + kLamp + kPoint +
                                  ball(0.9, heterogeneous(4, grid("sigma_t", "three.vol", "trilinear") +
                                                                 grid("albedo", "three.vol", "nearest"), kForward))},
      {"RoughGlass", volpath(10) + kCloseSensor + kSky + ball(1.0, medium("interior", "0.3, 0.2, 0.1", 1, kForward)) +
                         ball(0.8, medium("interior", "0.3, 1, 0.6", 3, kBlend) +
                                       medium("exterior", "0.3, 0.2, 0.1", 1, kForward),
                              rough_glass("beckmann", 0.4, 0.2)),
       0.01, 1024},
      {"GridInRoughGlass", volpath(12) + kCloseSensor + kSky +
                               ball(0.9, heterogeneous(4, grid("sigma_t", "three.vol", "nearest") +
                                                              grid("albedo", "three.vol", "trilinear")),
                                    rough_glass("ggx", 0.2, 0.2)), 0.03, 512},
      {"ConstantsBesideGrids", volpath(8) + kSensor + kFloor + kLamp + kSky +
                                   ball(0.6, heterogeneous(2, constant("sigma_t", kColours) +
                                                                  grid("albedo", "three.vol", "nearest"), kBlend),
                                        kMask, -0.7) +
                                   ball(0.6, heterogeneous(5, grid("sigma_t", "one.vol", "nearest") +
                                                                  constant("albedo", "0.9, 0.7, 0.4"), kBlend),
                                        R"(<bsdf type="thindielectric"/>)", 0.7), 0.03, 128},
      // The last boundary crossed counts.
      {"OverlappingUnderEnvironment", volpath(8) + kSensor + kFloor +
           R"(<emitter type="envmap"><string name="filename" value="sky.hdr"/></emitter>)" +
           ball(0.9, medium("interior", "0.5, 0.8, 1", 1, kForward)) +
           ball(0.5, heterogeneous(5, grid("sigma_t", "one.vol", "trilinear")) +
                         medium("exterior", "0.5, 0.8, 1", 1, kForward)) +
           ball(0.6, medium("interior", kColours, 2, ""), kNull, 0.8), 0.03, 128},
      // Light leaves the large ball outwards only; what comes from elsewhere is scattered in it.
      {"LampAndGlowingMediumInFog", volpath(6) + kFog + sensor_inside("fog") + kFloor +
           ball(0.7, R"(<emitter type="area"><rgb name="radiance" value="2, 1, 0.5"/></emitter>)" +
                         medium("interior", kColours, 3, kForward) + refer("exterior", "fog")) +
           ball(0.3, R"(<emitter type="area"><rgb name="radiance" value="8, 7, 6"/></emitter>)", "", 1.2), 0.03, 256},
      {"LightsInBubbles", volpath(4) + kFog + sensor_inside("fog") + kFloor +
           ball(0.6, refer("exterior", "fog"), kNull, -1) +
           ball(0.6, refer("exterior", "fog"), kNull, 1) + R"(<emitter type="spot"><transform name="to_world">
<lookat origin="-1, 0, 0" target="0, -1, 0" up="0, 0, 1"/></transform><float name="cutoff_angle" value="50"/>
<rgb name="intensity" value="5, 6, 7"/></emitter><emitter type="projector"><transform name="to_world">
<lookat origin="1, 0, 0" target="0, -1, 0" up="0, 0, 1"/></transform><float name="fov" value="60"/>
<texture name="irradiance" type="bitmap"><string name="filename" value="sky.hdr"/></texture></emitter>)", 0.05, 128},
      {"CameraInNestedMedium", volpath(6) + kFog + R"(<medium id="water" type="homogeneous">
<rgb name="sigma_t" value="0.9, 0.3, 0.1"/></medium>)" +
           sensor_inside("water", sensor_element(kSize, kSize, "0, 0, 0.5", "0, -0.2, -1", 60)) + kFloor + kLamp +
           kSky + ball(0.8, refer("interior", "water") + refer("exterior", "fog")) + ball(4, refer("interior", "fog")),
       0.03, 128},
  };
  return kScenes;
}

class MediumAgreement : public DeviceTest, public ::testing::WithParamInterface<size_t> {};

TEST_P(MediumAgreement, DeviceAndReference) {
  const MediumScene& scene = scenes()[GetParam()];
  VerifyOptions options;
  options.mean_bias = scene.mean_bias;
  options.block_bias = std::max(0.15, 8 * scene.mean_bias);
  options.first_samples = scene.first_samples;
  options.most_samples = 16384;
  const Scene loaded = scene_from_elements(scene.elements, files());
  EXPECT_NE(pack_scene(loaded).features.media, 0u);
  expect_agreement(loaded, options);
}

INSTANTIATE_TEST_SUITE_P(Media, MediumAgreement, ::testing::Range(size_t{0}, scenes().size()),
                         [](const auto& parameter) { return std::string(scenes()[parameter.param].name); });

}  // namespace
}  // namespace tachylite::test
