#include "statistics/bsdf_probe.h"

#include <cstring>

#include "base/check.h"
#include "pack/feature_set.h"
#include "shared/bindings.h"
#include "shared/geometry.h"
#include "support/device_test.h"
#include "test_kernel_spirv.h"
#include "vulkan/commands.h"

namespace tachylite::test {
namespace {

constexpr size_t kCapacity = 1 << 18;  // queries in one dispatch

struct GpuQuery {
  glm::vec4 wo, wi, u;
};

using vulkan::BindingKind;

}  // namespace

struct BsdfProbe::ClassKernel {
  vulkan::Buffer queries{device(), kCapacity * sizeof(GpuQuery)};
  vulkan::Buffer answers{device(), kCapacity * sizeof(BsdfAnswer)};
  vulkan::BindingTable table;
  vulkan::Kernel kernel;

  ClassKernel(const vulkan::Buffer& rows, const vulkan::Buffer* textures, const std::string& name,
              const vulkan::SpecializationConstants& constants)
      : table(device(),
              std::vector<vulkan::Binding>{
                  {gpu::kBindMaterials, BindingKind::kTexel, &rows, VK_FORMAT_R32G32B32A32_UINT},
                  {gpu::kBindTextures, BindingKind::kTexel, textures, VK_FORMAT_R32G32B32A32_UINT},
                  {gpu::kBindAttributes, BindingKind::kTexel, nullptr, VK_FORMAT_R32G32B32A32_SFLOAT},
                  {gpu::kBindTexels8, BindingKind::kTexel, nullptr, VK_FORMAT_R8G8B8A8_UNORM},
                  {gpu::kBindTexels16, BindingKind::kTexel, nullptr, VK_FORMAT_R16G16B16A16_SFLOAT},
                  {gpu::kBindTexels32, BindingKind::kTexel, nullptr, VK_FORMAT_R32G32B32A32_SFLOAT},
                  {30, BindingKind::kStorage, &queries},
                  {31, BindingKind::kStorage, &answers}}),
        kernel(device(), table, name, test_kernel_spirv(name), constants) {}
};

Scene scene_of_bsdfs(const std::vector<BsdfKind>& kinds) {
  Scene scene;
  for (const BsdfKind& kind : kinds) scene.bsdfs.push_back({.kind = kind});
  return scene;
}

BsdfProbe::BsdfProbe(Scene scene) : scene_(std::move(scene)) {
  for (size_t i = 0; i < scene_.bsdfs.size(); ++i) {
    Shape shape;
    shape.bsdf = static_cast<BsdfIndex>(i);
    scene_.shapes.push_back(shape);
  }
  textures_ = pack_textures(scene_, Geometry{});
  materials_ = pack_materials(scene_, textures_.row_of_texture);
  if (!textures_.rows.empty()) texture_rows_ = vulkan::Buffer(device(), std::span<const glm::uvec4>(textures_.rows));
  rows_ = vulkan::Buffer(device(), std::span<const glm::uvec4>(materials_.rows));
  kernels_.resize(materials_.classes.size());
}

BsdfProbe::~BsdfProbe() = default;

const MaterialClass& BsdfProbe::material_class(int bsdf) const {
  const uint32_t index = materials_.class_of_bsdf.at(static_cast<size_t>(bsdf));
  CHECK(index != gpu::kClassNone);
  return materials_.classes[index];
}

BsdfProbe::ClassKernel& BsdfProbe::kernel(uint32_t material_class) {
  std::unique_ptr<ClassKernel>& kernel = kernels_.at(material_class);
  if (!kernel) {
    FeatureSet features;
    features.classes = materials_.classes;
    features.textures = textures_.kinds;
    kernel = std::make_unique<ClassKernel>(rows_, textures_.rows.empty() ? nullptr : &texture_rows_,
                                           "bsdf_probe" + bsdf_kernel_variant(materials_.classes[material_class]),
                                           features.class_constants(material_class));
  }
  return *kernel;
}

std::vector<BsdfAnswer> BsdfProbe::ask(std::span<const BsdfQuery> queries) {
  std::vector<BsdfAnswer> answers(queries.size());
  std::map<uint32_t, std::vector<size_t>> by_class;
  for (size_t i = 0; i < queries.size(); ++i)
    by_class[materials_.class_of_bsdf.at(static_cast<size_t>(queries[i].bsdf))].push_back(i);
  for (const auto& [material_class, indices] : by_class) {
    CHECK(material_class != gpu::kClassNone);
    ClassKernel& k = kernel(material_class);
    for (size_t first = 0; first < indices.size(); first += kCapacity) {
      const size_t count = std::min(kCapacity, indices.size() - first);
      std::vector<GpuQuery> gpu_queries(count);
      for (size_t i = 0; i < count; ++i) {
        const BsdfQuery& q = queries[indices[first + i]];
        const uint32_t row = materials_.row_of_bsdf[static_cast<size_t>(q.bsdf)];
        gpu_queries[i] = {glm::vec4(q.wo, std::bit_cast<float>(row)), glm::vec4(q.wi, 0),
                          glm::vec4(q.u, q.u_lobe, q.texture_u)};
      }
      k.queries.upload(gpu_queries.data(), count * sizeof(GpuQuery));
      const auto push = static_cast<uint32_t>(count);
      vulkan::Commands commands(device());
      commands.dispatch(k.kernel, (push + kTestGroupSize - 1) / kTestGroupSize, &push, sizeof(push));
      commands.submit_and_wait();
      std::vector<BsdfAnswer> gpu_answers(count);
      k.answers.download(gpu_answers.data(), count * sizeof(BsdfAnswer));
      for (size_t i = 0; i < count; ++i) answers[indices[first + i]] = gpu_answers[i];
    }
  }
  return answers;
}

}  // namespace tachylite::test
