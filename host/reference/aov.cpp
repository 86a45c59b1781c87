#include "reference/aov.h"

#include "reference/bsdf/albedo.h"
#include "shared/aov.h"

namespace tachylite::reference {

Aovs::Aovs(const std::vector<std::string>& specifications) : aovs_(parse_aovs(specifications)) {
  sample_count_channel_ = take_sample_count(aovs_);
  for (const Aov& aov : aovs_) names_.insert(names_.end(), aov.channels.begin(), aov.channels.end());
}

void Aovs::evaluate(const World& world, const Ray& camera_ray, std::vector<double>& values) const {
  if (aovs_.empty()) return;
  const auto hit = world.scene.integrator.hide_emitters ? world.geometry.intersect_without_emitters(camera_ray)
                                                        : world.geometry.intersect(camera_ray);
  if (!hit) {
    values.resize(values.size() + names_.size(), 0);
    return;
  }
  const BsdfIndex bsdf = world.shape_of(*hit).bsdf;
  const ShadingPoint point = shading_point(world.materials, *hit);
  const auto add = [&](const dvec3& v) { values.insert(values.end(), {v.x, v.y, v.z}); };
  for (const Aov& aov : aovs_) {
    switch (aov.kind) {
      case gpu::kAovAlbedo:
        add(albedo_bsdf(bsdf, point, glm::dot(hit->frame.n, camera_ray.direction) < 0));
        break;
      case gpu::kAovDepth:
        values.push_back(hit->t);
        break;
      case gpu::kAovPosition:
        add(hit->p);
        break;
      case gpu::kAovUv:
        values.insert(values.end(), {hit->at.uv.x, hit->at.uv.y});
        break;
      case gpu::kAovGeoNormal:
        add(hit->n_g);
        break;
      case gpu::kAovShNormal:
        add(hit->frame.n);
        break;
      case gpu::kAovDpDu:
        add(hit->dp_du);
        break;
      case gpu::kAovDpDv:
        add(hit->dp_dv);
        break;
      case gpu::kAovPrimIndex:
        values.push_back(static_cast<double>(hit->at.triangle));
        break;
      case gpu::kAovShapeIndex:
        values.push_back(hit->shape);
        break;
    }
  }
}

}  // namespace tachylite::reference
