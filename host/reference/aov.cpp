#include "reference/aov.h"

#include <map>
#include <sstream>

#include "base/error.h"

namespace tachylite::reference {

Aovs::Aovs(const std::vector<std::string>& specifications) {
  static const std::map<std::string, std::string> kSuffixes{
      {"albedo", "RGB"},     {"depth", "T"},       {"position", "XYZ"}, {"uv", "UV"},
      {"geo_normal", "XYZ"}, {"sh_normal", "XYZ"}, {"normal", "XYZ"},   {"dp_du", "XYZ"},
      {"dp_dv", "XYZ"},      {"prim_index", "I"},  {"shape_index", "I"}};
  for (const std::string& list : specifications) {
    std::istringstream items(list);
    for (std::string item; std::getline(items, item, ',');) {
      const size_t colon = item.find(':');
      const std::string name = item.substr(0, colon);
      const std::string type = colon == std::string::npos ? name : item.substr(colon + 1);
      const auto suffixes = kSuffixes.find(type);
      if (suffixes == kSuffixes.end()) {
        throw InputError("unknown AOV '" + type +
                         "', expected albedo, depth, position, uv, geo_normal, sh_normal, dp_du, dp_dv, "
                         "prim_index or shape_index");
      }
      types_.push_back(type);
      for (const char suffix : suffixes->second) names_.push_back(name + "." + suffix);
    }
  }
}

void Aovs::evaluate(const World& world, const Ray& camera_ray, std::vector<double>& values) const {
  if (types_.empty()) return;
  const auto hit = world.geometry.intersect(camera_ray);
  if (!hit) {
    values.resize(values.size() + names_.size(), 0);
    return;
  }
  const BsdfIndex bsdf = world.shape_of(*hit).bsdf;
  const ShadingPoint point = shading_point(world.materials, *hit);
  const auto add = [&](const dvec3& v) { values.insert(values.end(), {v.x, v.y, v.z}); };
  for (const std::string& type : types_) {
    if (type == "albedo") add(albedo_bsdf(bsdf, point));
    if (type == "depth") values.push_back(hit->t);
    if (type == "position") add(hit->p);
    if (type == "uv") values.insert(values.end(), {hit->at.uv.x, hit->at.uv.y});
    if (type == "geo_normal") add(hit->n_g);
    if (type == "sh_normal" || type == "normal") {
      add(hit->frame.to_world(shading_normal(bsdf, point, hit->frame.to_local(-camera_ray.direction))));
    }
    if (type == "dp_du") add(hit->dp_du);
    if (type == "dp_dv") add(hit->dp_dv);
    if (type == "prim_index") values.push_back(static_cast<double>(hit->at.triangle));
    if (type == "shape_index") values.push_back(hit->shape);
  }
}

}  // namespace tachylite::reference
