#include "support/tracer.h"

#include <optional>

#include "shared/bindings.h"
#include "shared/features.h"
#include "test_kernel_spirv.h"

namespace tachylite::test {
namespace {

constexpr uint32_t kPlainRaysPerGroup = 64;
constexpr uint32_t kRaysPerGroup = 1024;  // geometry/trace_settings.glsl

}  // namespace

struct Tracer::Kernels {
  vulkan::BindingTable table;
  std::array<std::optional<vulkan::Kernel>, 4> kernels;  // by query and form, made when first asked for

  Kernels(vulkan::Device& device, std::span<const vulkan::Binding> bindings) : table(device, bindings) {}
};

Tracer::Tracer(vulkan::Device& device, const Bvh8& bvh)
    : device_(device), commands_(device), nodes_(device, std::span(bvh.nodes)) {
  if (!bvh.leaves.empty()) leaves_ = vulkan::Buffer(device, std::span(bvh.leaves));
  constants_[gpu::kFeatureCurved] = bvh.statistics.curved > 0;
  constants_[gpu::kFeatureTriangles] = bvh.statistics.leaves > bvh.statistics.curved;
}

Tracer::Tracer(vulkan::Device& device, const BakedGeometry& baked)
    : device_(device), commands_(device), baked_(true), constants_(baked.constants) {}

Tracer::~Tracer() = default;

void Tracer::set_rays(std::span<const TraceRay> rays) {
  kernels_.reset();
  count_ = static_cast<uint32_t>(rays.size());
  rays_ = vulkan::Buffer(device_, rays);
  hits_ = vulkan::Buffer(device_, rays.size() * sizeof(TraceHit));
  using vulkan::BindingKind;
  const std::array<vulkan::Binding, 4> bindings{
      {{gpu::kBindBvhNodes, BindingKind::kTexel, nodes_ ? &nodes_ : nullptr, VK_FORMAT_R32G32B32A32_UINT},
       {gpu::kBindBvhLeaves, BindingKind::kTexel, leaves_ ? &leaves_ : nullptr, VK_FORMAT_R32G32B32A32_SFLOAT},
       {gpu::kBindPathTexels, BindingKind::kTexel, &rays_, VK_FORMAT_R32G32B32A32_SFLOAT},
       {gpu::kBindPaths, BindingKind::kStorage, &hits_, VK_FORMAT_UNDEFINED}}};
  kernels_ = std::make_unique<Kernels>(device_, bindings);
}

void Tracer::run(Query query, Form form) {
  const bool any = query == Query::kAny, plain = form == Form::kPlain || baked_;
  std::optional<vulkan::Kernel>& kernel = kernels_->kernels[2 * any + plain];
  if (!kernel) {
    const std::string form_name = baked_ ? "_baked" : plain ? "_plain" : "";
    const std::string name = (any ? "trace_any" : "trace_closest") + form_name;
    kernel.emplace(device_, kernels_->table, name, test_kernel_spirv(name), constants_);
  }
  const uint32_t per_group = plain ? kPlainRaysPerGroup : kRaysPerGroup;
  commands_.dispatch(*kernel, (count_ + per_group - 1) / per_group, &count_, sizeof count_);
  commands_.submit_and_wait();
}

std::vector<TraceHit> Tracer::hits() const { return hits_.download_all<TraceHit>(); }

}  // namespace tachylite::test
