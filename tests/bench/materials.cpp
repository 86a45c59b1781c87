#include "bench/materials.h"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "base/timer.h"
#include "support/render_test.h"
#include "wavefront/renderer.h"

namespace tachylite::bench {
namespace {

constexpr int kSize = 512, kTiles = 8;
constexpr uint64_t kSamples = 2;

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

struct Measurement {
  std::string name;
  Scene scene;
  PackedScene packed = pack_scene(scene);
  double least_ns = std::numeric_limits<double>::infinity();
  std::vector<double> shares = {};  // of the shading kernels

  void repeat(vulkan::Device& device) {
    RenderOptions options;
    options.samples = kSamples;
    options.structure = KernelStructure::kStages;
    options.timing = true;
    Renderer renderer(device, packed, options);
    CpuTimer timer;
    renderer.render();
    least_ns = std::min(least_ns, 1e9 * timer.seconds() / (double{kSize} * kSize * kSamples));
    double shade = 0, total = 0;
    for (const auto& [kernel, time] : renderer.statistics().kernels) {
      total += time.seconds;
      if (kernel.starts_with("shade_surface")) shade += time.seconds;
    }
    shares.push_back(total > 0 ? shade / total : 0);
  }
  MaterialResult result() {
    std::ranges::nth_element(shares, shares.begin() + static_cast<ptrdiff_t>(shares.size() / 2));
    return {name, least_ns, least_ns * shares[shares.size() / 2]};
  }
};

}  // namespace

MaterialsResult bench_materials(int repetitions) {
  vulkan::Device device;
  std::vector<Measurement> measurements;
  std::vector<Material> parts;
  for (const Material& m : materials()) {
    measurements.push_back({m.name, wall([&](int) { return m.element; })});
    if (m.mixed) parts.push_back(m);
  }
  measurements.push_back({"eight side by side", wall([&](int tile) {
    return parts[static_cast<size_t>(tile % kTiles + 3 * (tile / kTiles)) % parts.size()].element;
  })});
  for (int i = 0; i < repetitions; ++i)
    for (Measurement& m : measurements) m.repeat(device);

  MaterialsResult result;
  for (Measurement& m : measurements) result.single.push_back(m.result());
  result.mixed = result.single.back();
  result.single.pop_back();
  result.parts.name = "the eight alone, mean";
  for (size_t i = 0; i < result.single.size(); ++i) {
    if (!materials()[i].mixed) continue;
    result.parts.total_ns += result.single[i].total_ns / static_cast<double>(parts.size());
    result.parts.shade_ns += result.single[i].shade_ns / static_cast<double>(parts.size());
  }
  return result;
}

}  // namespace tachylite::bench
