// A scene pays only for what it uses: no kernel and no buffer for what it lacks.

#include <algorithm>

#include <gtest/gtest.h>

#include "shared/light.h"
#include "support/render_test.h"
#include "wavefront/scene_buffers.h"

namespace tachylite::test {
namespace {

using Lean = DeviceTest;

bool names(const std::vector<std::string>& list, const std::string& part) {
  return std::any_of(list.begin(), list.end(), [&](const std::string& s) { return s.find(part) != std::string::npos; });
}

RenderOptions stages() {
  RenderOptions options;
  options.samples = 4;
  options.structure = KernelStructure::kStages;
  return options;
}

std::vector<std::string> buffers_of(const Scene& scene) {
  std::vector<std::string> buffers;
  for (const MemoryPlan::Entry& e : Renderer::plan_memory(device().info(), pack_scene(scene), stages()).buffers)
    buffers.push_back(e.name);
  return buffers;
}

TEST_F(Lean, CornellBoxHasNoEnvironmentTextureOrMedium) {
  const Scene scene = scene_from_elements(cornell_elements(16));
  const DeviceRender render = render_on_device(scene, stages());
  EXPECT_TRUE(names(render.stages_run, "shade_emitter"));
  EXPECT_TRUE(names(render.stages_run, "shade_surface<diffuse>"));
  for (const char* stage : {"escaped", "medium"}) {
    EXPECT_FALSE(names(render.stages_run, stage)) << stage;
    EXPECT_TRUE(names(render.stages_skipped, stage)) << stage;
  }
  const std::vector<std::string> buffers = buffers_of(scene);
  for (const char* buffer : {"texels", "textures", "environment", "media", "grids", "curved", "normals", "attributes"})
    EXPECT_FALSE(names(buffers, buffer)) << buffer;
  for (const char* buffer : {"tree nodes", "lights", "path state", "shadow rays"})
    EXPECT_TRUE(names(buffers, buffer)) << buffer;
}

TEST_F(Lean, EachFeatureBringsItsOwn) {
  const std::string sensor = R"(<integrator type="path"/>)" + sensor_element(8, 8);
  const std::string plain_wall = R"(<shape type="rectangle"/>)";
  const Scene unlit = scene_from_elements(sensor + plain_wall + R"(<emitter type="point"/>)");
  EXPECT_FALSE(names(render_on_device(unlit, stages()).stages_run, "shade_emitter"));
  EXPECT_FALSE(names(render_on_device(unlit, stages()).stages_run, "shade_escaped"));
  EXPECT_TRUE(names(render_on_device(unlit, stages()).stages_run, "intersect_shadow"));

  const Scene sky = scene_from_elements(sensor + plain_wall + R"(<emitter type="constant"/>)");
  EXPECT_TRUE(names(render_on_device(sky, stages()).stages_run, "shade_escaped"));

  const Scene checkered = scene_from_elements(
      sensor + R"(<shape type="rectangle"><bsdf type="diffuse"><texture name="reflectance" type="checkerboard"/></bsdf>
</shape><emitter type="point"/>)");
  EXPECT_TRUE(names(buffers_of(checkered), "textures"));
  EXPECT_FALSE(names(buffers_of(checkered), "texels"));

  const Scene ball = scene_from_elements(sensor + R"(<shape type="sphere"/><emitter type="point"/>)");
  EXPECT_TRUE(names(buffers_of(ball), "curved"));
  EXPECT_FALSE(names(buffers_of(ball), "triangles"));
}

TEST_F(Lean, TreeIsReadAsStorageWhereThatIsFasterAndFits) {
  const PackedScene packed = pack_scene(scene_from_elements(cornell_elements(16)));
  const uint64_t bytes = std::max(packed.bvh.nodes.size() * sizeof(packed.bvh.nodes[0]),
                                  packed.bvh.leaves.size() * sizeof(packed.bvh.leaves[0]));
  vulkan::DeviceInfo slow = device().info();
  slow.int64 = slow.slow_texel_fetches = true;
  slow.max_storage_buffer_range = bytes;
  EXPECT_TRUE(reads_storage(slow, packed));
  vulkan::DeviceInfo other = slow;
  --other.max_storage_buffer_range;
  EXPECT_FALSE(reads_storage(other, packed));
  other = slow;
  other.int64 = false;
  EXPECT_FALSE(reads_storage(other, packed));
  other = slow;
  other.slow_texel_fetches = false;
  EXPECT_FALSE(reads_storage(other, packed));
}

// One light needs no table to choose from, and a constant environment is no second one: material samples find it.
TEST_F(Lean, OneLightIsNotChosen) {
  const std::string sensor = R"(<integrator type="path"/>)" + sensor_element(8, 8) + R"(<shape type="rectangle"/>)";
  const std::string lamp = R"(<shape type="sphere"><point name="center" x="0" y="2" z="0"/><emitter type="area"/></shape>)";
  const std::string sky = R"(<emitter type="constant"/>)", point = R"(<emitter type="point"/>)";
  for (const std::string& lights : {lamp, point, lamp + sky}) {
    const PackedScene packed = pack_scene(scene_from_elements(sensor + lights));
    EXPECT_EQ(packed.features.selection, gpu::kSelectSingle);
    EXPECT_EQ(packed.light_table.size(), gpu::kLightTableHeaderRows);
  }
  EXPECT_EQ(pack_scene(scene_from_elements(sensor + sky)).features.selection, gpu::kSelectNone);
  EXPECT_EQ(pack_scene(scene_from_elements(sensor + lamp + point)).features.selection, gpu::kSelectLoop);
  // The table of lights is its header alone.
  EXPECT_FALSE(names(buffers_of(scene_from_elements(sensor + lamp)), "environment"));
}

}  // namespace
}  // namespace tachylite::test
