#include "bench/materials.h"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "support/render_test.h"
#include "wavefront/renderer.h"

namespace tachylite::bench {
namespace {

constexpr int kSize = 512, kTiles = 8;
constexpr uint64_t kSamples = 8;

struct Material {
  const char* name;
  const char* element;
  bool mixed;  // one of the eight
};

std::vector<Material> materials() {
  return {
      {"diffuse", R"(<bsdf type="diffuse"/>)", true},
      {"diffuse, checkerboard", R"(<bsdf type="diffuse"><texture type="checkerboard" name="reflectance"/></bsdf>)", false},
      {"roughdiffuse", R"(<bsdf type="roughdiffuse"><float name="alpha" value="0.3"/></bsdf>)", false},
      {"conductor", R"(<bsdf type="conductor"><string name="material" value="Au"/></bsdf>)", true},
      {"roughconductor, ggx", R"(<bsdf type="roughconductor"><string name="material" value="Au"/>
<string name="distribution" value="ggx"/><float name="alpha" value="0.2"/></bsdf>)", true},
      {"roughconductor, beckmann", R"(<bsdf type="roughconductor"><string name="material" value="Au"/>
<float name="alpha" value="0.2"/></bsdf>)", false},
      {"dielectric", R"(<bsdf type="dielectric"/>)", true},
      {"thindielectric", R"(<bsdf type="thindielectric"/>)", false},
      {"roughdielectric, ggx", R"(<bsdf type="roughdielectric"><string name="distribution" value="ggx"/></bsdf>)", true},
      {"roughdielectric, beckmann", R"(<bsdf type="roughdielectric"/>)", false},
      {"plastic", R"(<bsdf type="plastic"/>)", true},
      {"roughplastic, ggx", R"(<bsdf type="roughplastic"><string name="distribution" value="ggx"/></bsdf>)", true},
      {"principled", R"(<bsdf type="principled"><float name="metallic" value="0.5"/></bsdf>)", true},
      {"principledthin", R"(<bsdf type="principledthin"><float name="spec_trans" value="0.5"/></bsdf>)", false},
      {"blinnphong", R"(<bsdf type="blinnphong"/>)", false},
      {"microfacet", R"(<bsdf type="microfacet"/>)", false},
      {"paper", R"(<bsdf type="paper"><float name="transparency" value="0.5"/></bsdf>)", false},
      {"blendbsdf of two diffuse", R"(<bsdf type="blendbsdf"><float name="weight" value="0.5"/><bsdf type="diffuse"/>
<bsdf type="diffuse"/></bsdf>)", false},
  };
}

/// A wall of 64 rectangles; `bsdf_of` says what each is made of.
Scene wall(const std::function<std::string(int tile)>& bsdf_of) {
  std::string elements = R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>
<emitter type="constant"/>)" + test::sensor_element(kSize, kSize, "0, 0, 4", "0, 0, 0", 28);
  for (int i = 0; i < kTiles * kTiles; ++i)
    elements += fmt::format(R"(<shape type="rectangle"><transform name="to_world"><scale value="{}"/>
<translate x="{}" y="{}"/></transform>{}</shape>)",
                            1.0 / kTiles, (2.0 * (i % kTiles) + 1) / kTiles - 1, (2.0 * (i / kTiles) + 1) / kTiles - 1,
                            bsdf_of(i));
  return test::scene_from_elements(elements);
}

MaterialResult measure(vulkan::Device& device, const std::string& name, const Scene& scene, int repetitions) {
  const PackedScene packed = pack_scene(scene);
  RenderOptions options;
  options.samples = kSamples;
  options.structure = KernelStructure::kStages;
  options.timing = true;
  MaterialResult result{name, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int i = 0; i < repetitions; ++i) {
    Renderer renderer(device, packed, options);
    renderer.render();
    double shade = 0, total = 0;
    for (const auto& [kernel, time] : renderer.statistics().kernels) {
      total += time.seconds;
      if (kernel.starts_with("shade_surface")) shade += time.seconds;
    }
    const double paths = double{kSize} * kSize * kSamples;
    result.shade_ns = std::min(result.shade_ns, 1e9 * shade / paths);
    result.total_ns = std::min(result.total_ns, 1e9 * total / paths);
  }
  return result;
}

}  // namespace

MaterialsResult bench_materials(int repetitions) {
  vulkan::Device device;
  MaterialsResult result;
  std::vector<Material> parts;
  for (const Material& m : materials()) {
    result.single.push_back(measure(device, m.name, wall([&](int) { return m.element; }), repetitions));
    if (!m.mixed) continue;
    parts.push_back(m);
    result.mean_of_its_parts_ns += result.single.back().total_ns;
  }
  result.mean_of_its_parts_ns /= static_cast<double>(parts.size());
  const Scene mixed = wall([&](int tile) {
    return parts[static_cast<size_t>(tile % kTiles + 3 * (tile / kTiles)) % parts.size()].element;
  });
  result.mixed = measure(device, "eight side by side", mixed, repetitions);
  return result;
}

}  // namespace tachylite::bench
