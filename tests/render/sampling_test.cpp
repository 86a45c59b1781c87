// The integrator's parameter `sampling`: emitter sampling alone, BSDF sampling alone and both have one expectation.
// The judge of all is the reference with both. Level 1e-4 a scene; power: a bias of 3 % of the mean of any channel is
// seen with probability 0.95.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "support/render_test.h"

namespace tachylite::test {
namespace {

using Strategy = Integrator::Strategy;
using Sampling = DeviceTest;

std::string integrator(const char* type, const char* sampling) {
  return fmt::format(R"(<integrator type="{}"><integer name="max_depth" value="4"/><string name="sampling" value="{}"/>
</integrator>)",
                     type, sampling);
}

const std::string kSensor = sensor_element(16, 16, "0, 1.5, 5", "0, -0.2, 0", 45);
// Large lights, so that BSDF sampling alone converges, too.
const std::string kLights = R"(<emitter type="constant"><rgb name="radiance" value="0.4, 0.5, 0.6"/></emitter>
<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><scale value="2"/><translate y="2.5"/>
</transform><emitter type="area"><rgb name="radiance" value="3, 2, 1"/></emitter></shape>
<shape type="sphere"><point name="center" x="-1.5" y="0.3" z="0.5"/><float name="radius" value="0.6"/>
<emitter type="area"><rgb name="radiance" value="1, 2, 3"/></emitter></shape>)";
const std::string kDiffuse = R"(<shape type="rectangle"><transform name="to_world"><scale value="3"/>
<rotate x="1" angle="-90"/><translate y="-1"/></transform></shape>
<shape type="sphere"><point name="center" x="0.7" y="0" z="0"/></shape>)";
// A material of delta lobes alone, and one of both kinds.
const std::string kGlossy = kDiffuse + R"(<shape type="sphere"><point name="center" x="2" y="-0.4" z="1.4"/>
<float name="radius" value="0.6"/><bsdf type="dielectric"/></shape>
<shape type="sphere"><point name="center" x="-0.3" y="-0.5" z="1.8"/><float name="radius" value="0.5"/>
<bsdf type="plastic"/></shape>)";
const std::string kFog = R"(<shape type="cube"><transform name="to_world"><scale value="0.9"/><translate y="-0.05" z="1"/>
</transform><bsdf type="null"/><medium name="interior" type="homogeneous"><float name="sigma_t" value="1.5"/>
<phase type="hg"><float name="g" value="0.4"/></phase></medium></shape>)";

void expect_one_expectation(const char* type, const std::string& elements, KernelStructure structure) {
  const Scene judged_by = scene_from_elements(integrator(type, "mis") + kSensor + elements);
  VerifyOptions options;
  options.mean_bias = 0.03;
  options.block_bias = 0.5;
  options.most_samples = 8192;
  for (const char* sampling : {"emitter", "bsdf"}) {
    SCOPED_TRACE(sampling);
    const Scene scene = scene_from_elements(integrator(type, sampling) + kSensor + elements);
    expect_agreement(scene, judged_by, options, {.structure = structure});
  }
}

TEST_F(Sampling, OneExpectationInOneKernel) {
  expect_one_expectation("path", kLights + kDiffuse, KernelStructure::kFused);
}

TEST_F(Sampling, OneExpectationInStages) {
  expect_one_expectation("path", kLights + kGlossy, KernelStructure::kStages);
}

TEST_F(Sampling, OneExpectationWithMedia) {
  expect_one_expectation("volpath", kLights + kDiffuse + kFog, KernelStructure::kStages);
}

// BSDF sampling alone queues no shadow ray.
TEST_F(Sampling, BsdfSamplingHasNoShadowRays) {
  RenderOptions options;
  options.samples = 4;
  options.structure = KernelStructure::kStages;
  const DeviceRender render =
      render_on_device(scene_from_elements(integrator("path", "bsdf") + kSensor + kLights + kDiffuse), options);
  EXPECT_EQ(render.statistics.shadow_rays, 0u);
  EXPECT_GT(render.statistics.closest_rays, 0u);
  for (const std::string& stage : render.stages_run) EXPECT_EQ(stage.find("shadow"), stage.npos) << stage;
}

}  // namespace
}  // namespace tachylite::test
