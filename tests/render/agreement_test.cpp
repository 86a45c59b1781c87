// Each scene feature, rendered on the device and by the CPU reference, agrees: image/verify.h. Level 1e-4 a scene
// (found twice at 1e-2); power: a bias of 1 % of the mean of any channel, or of 10 % of the median block of 8 x 8
// pixels, is seen with probability 0.95.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "support/render_test.h"

namespace tachylite::test {
namespace {

constexpr int kSize = 32;

struct Feature {
  const char* name;
  std::string elements;
  std::vector<std::pair<std::string, std::string>> files = {};
};

const std::string kPath = R"(<integrator type="path"><integer name="max_depth" value="5"/></integrator>)";
const std::string kFloor =
    R"(<shape type="rectangle"><transform name="to_world"><scale value="3"/><rotate x="1" angle="-90"/>
<translate y="-1"/></transform><bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf></shape>)";
const std::string kBall = R"(<shape type="sphere"><float name="radius" value="0.8"/></shape>)";
const std::string kSky = R"(<emitter type="constant"><rgb name="radiance" value="0.4, 0.5, 0.6"/></emitter>)";
const std::string kPoint = R"(<emitter type="point"><point name="position" x="2" y="3" z="2"/>
<rgb name="intensity" value="12, 10, 8"/></emitter>)";
const std::string kSensor = sensor_element(kSize, kSize, "0, 1.5, 5", "0, -0.2, 0", 45);
const std::string kCommon = kPath + kSensor + kFloor;

std::string area_light(const std::string& shape, const std::string& transform, const char* radiance = "8, 7, 6") {
  return fmt::format(R"(<shape type="{}"><transform name="to_world">{}</transform>
<emitter type="area"><rgb name="radiance" value="{}"/></emitter></shape>)",
                     shape, transform, radiance);
}

std::string film_with(const std::string& filter) {
  std::string sensor = kSensor;
  const std::string box = R"(<rfilter type="box"/>)";
  return sensor.replace(sensor.find(box), box.size(), filter);
}

std::string sensor_with(const std::string& type, const std::string& parameters) {
  std::string sensor = kSensor;
  sensor.replace(sensor.find("perspective"), 11, type);
  return sensor.insert(sensor.find("<transform"), parameters);
}

// A tetrahedron with uv and smooth normals, and one without either.
const std::string kSmoothObj =
    "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n"
    "vn 1 1 1\nvn -1 -1 1\nvn -1 1 -1\nvn 1 -1 -1\nf 1/1/1 2/2/2 4/4/4\nf 1/1/1 3/3/3 2/2/2\nf 1/1/1 4/4/4 3/3/3\n"
    "f 2/2/2 3/3/3 4/4/4\n";
const std::string kPlainObj =
    "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 2 4\nf 1 3 2\nf 1 4 3\nf 2 3 4\n";
const std::string kChecker = R"(<bsdf type="twosided"><bsdf type="diffuse"><texture name="reflectance" type="checkerboard">
<rgb name="color0" value="0.9, 0.1, 0.2"/><rgb name="color1" value="0.1, 0.4, 0.8"/>
<transform name="to_uv"><scale x="5" y="3"/></transform></texture></bsdf></bsdf>)";

std::string mesh(const std::string& inside) {
  return R"(<shape type="obj"><string name="filename" value="m.obj"/><transform name="to_world"><scale value="0.7"/>
<rotate y="1" angle="25"/></transform>)" + inside + "</shape>";
}

const std::vector<Feature>& features() {
  static const std::vector<Feature> kFeatures = {
      {"ConstantSky", kCommon + kBall + kSky},
      {"PointLight", kCommon + kBall + kPoint},
      {"RectangleLight", kCommon + kBall + area_light("rectangle", R"(<rotate x="1" angle="90"/><translate y="2"/>)")},
      {"SphereLight", kCommon + kBall + area_light("sphere", R"(<scale value="0.3"/><translate x="1" y="1.5"/>)")},
      {"DiskLight", kCommon + kBall + area_light("disk", R"(<rotate x="1" angle="70"/><translate y="2"/>)")},
      {"CylinderLight", kCommon + kBall + area_light("cylinder", R"(<scale value="0.7"/><translate x="1" y="1.2"/>)") + kSky},
      // Its light leaves through the ends alone.
      {"CylinderShiningInwards", kCommon + R"(<shape type="cylinder"><transform name="to_world"><scale value="0.7"/>
<rotate y="1" angle="30"/><translate y="0.3"/></transform><boolean name="flip_normals" value="true"/>
<emitter type="area"><rgb name="radiance" value="8, 7, 6"/></emitter></shape>)"},
      {"CubeLight", kCommon + kBall + area_light("cube", R"(<scale value="0.3"/><translate x="1" y="1.5"/>)")},
      {"MeshLight", kCommon + mesh(R"(<emitter type="area"><rgb name="radiance" value="3, 4, 5"/></emitter>)"),
       {{"m.obj", kPlainObj}}},
      {"ManyLights", kCommon + kBall + kSky + kPoint +
                         area_light("sphere", R"(<scale value="0.2"/><translate x="-1" y="1.5"/>)", "20, 1, 1") +
                         area_light("disk", R"(<rotate x="1" angle="70"/><translate x="1" y="2"/>)", "1, 5, 1")},
      {"CylinderAndDisk",
       kCommon + kSky + kPoint + R"(<shape type="cylinder"><float name="radius" value="0.4"/><point name="p0" x="-1"/>
<point name="p1" x="1" y="0.5"/><bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>
<shape type="disk"><transform name="to_world"><scale x="0.8" y="0.5"/><translate z="-1" y="0.6"/></transform></shape>)"},
      {"SmoothMesh", kCommon + mesh("") + kPoint, {{"m.obj", kSmoothObj}}},
      {"TexturedMesh", kCommon + mesh(kChecker) + kSky, {{"m.obj", kSmoothObj}}},
      {"FaceNormals", kCommon + mesh(R"(<boolean name="face_normals" value="true"/>)") + kPoint,
       {{"m.obj", kSmoothObj}}},
      {"FlippedNormals", kCommon + R"(<shape type="sphere"><boolean name="flip_normals" value="true"/>
<bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>)" + kPoint},
      {"CheckerSphere", kCommon + R"(<shape type="sphere">)" + kChecker + "</shape>" + kSky},
      {"TentFilter", kPath + film_with(R"(<rfilter type="tent"/>)") + kFloor + kBall + kPoint},
      {"GaussianFilter", kPath + film_with(R"(<rfilter type="gaussian"/>)") + kFloor + kBall + kPoint},
      {"ThinLens", kPath + sensor_with("thinlens", R"(<float name="aperture_radius" value="0.4"/>
<float name="focus_distance" value="5"/>)") + kFloor + kBall + kPoint},
      {"FarClip", kPath + sensor_with("perspective", R"(<float name="near_clip" value="4.5"/>
<float name="far_clip" value="6"/>)") + kFloor + kBall + kSky},
      {"HideEmitters", R"(<integrator type="path"><boolean name="hide_emitters" value="true"/></integrator>)" +
                           kSensor + kFloor + kBall +
                           area_light("rectangle", R"(<rotate x="1" angle="90"/><translate y="1"/>)") + kSky},
      {"DirectOnly", R"(<integrator type="direct"/>)" + kSensor + kFloor + kBall + kPoint + kSky},
      {"RussianRoulette", R"(<integrator type="path"><integer name="rr_depth" value="2"/></integrator>)" + kSensor +
                              kFloor + kBall + kSky},
  };
  return kFeatures;
}

class Agreement : public DeviceTest, public ::testing::WithParamInterface<size_t> {};

TEST_P(Agreement, DeviceAndReference) {
  const Feature& feature = features()[GetParam()];
  VerifyOptions options;
  options.most_samples = 8192;
  expect_agreement(scene_from_elements(feature.elements, feature.files), options);
}

INSTANTIATE_TEST_SUITE_P(Features, Agreement, ::testing::Range(size_t{0}, features().size()),
                         [](const auto& parameter) { return std::string(features()[parameter.param].name); });

}  // namespace
}  // namespace tachylite::test
