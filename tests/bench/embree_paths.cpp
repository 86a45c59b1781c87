#include "bench/embree_paths.h"

#include <atomic>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "pack/pack_geometry.h"

namespace tachylite::bench {
namespace {

using glm::vec3;
using test::Pcg32;

constexpr float kPi = 3.14159265f;

RTCRay make_ray(const vec3& o, const vec3& d, float t_max) {
  RTCRay ray{};
  ray.org_x = o.x, ray.org_y = o.y, ray.org_z = o.z;
  ray.dir_x = d.x, ray.dir_y = d.y, ray.dir_z = d.z;
  ray.tnear = 0;
  ray.tfar = t_max;
  ray.mask = ~0u;
  return ray;
}

vec3 sample_cosine(const vec3& n, Pcg32& random) {
  const float u = random.uniform(), phi = 2 * kPi * random.uniform(), r = glm::sqrt(u);
  const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  const vec3 s(1 + sign * n.x * n.x * a, sign * b, -sign * n.x), t(b, sign + n.y * n.y * a, -n.y);
  return r * glm::cos(phi) * s + r * glm::sin(phi) * t + glm::sqrt(1 - u) * n;
}

// Power heuristic (Veach 1997, section 9.2.4), exponent 2.
float mis_weight(float a, float b) { return a * a / (a * a + b * b); }

}  // namespace

EmbreePaths::EmbreePaths(const Scene& scene, const PackedScene& packed)
    : camera_(packed.params.camera), width_(packed.params.width), height_(packed.params.height) {
  const Geometry geometry = pack_geometry(scene);
  const test::TestMesh mesh{geometry.vertices, geometry.triangles};
  std::vector<glm::uvec3> emitting;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3 t = mesh.triangles[i];
    const Shape& shape = scene.shapes.at(geometry.shape_of_triangle[i]);
    const auto* diffuse = std::get_if<DiffuseBsdf>(&scene.bsdfs.at(static_cast<size_t>(shape.bsdf)).kind);
    if (!diffuse) throw std::invalid_argument("EmbreePaths: surfaces must be diffuse");
    const vec3 v0 = mesh.vertices[t.x], e1 = mesh.vertices[t.y] - v0, e2 = mesh.vertices[t.z] - v0;
    Surface s{v0, glm::normalize(glm::cross(e1, e2)), vec3(diffuse->reflectance.value), vec3(0)};
    if (shape.emitter != kNone) {
      s.Le = vec3(std::get<AreaEmitter>(scene.emitters.at(static_cast<size_t>(shape.emitter)).kind).radiance.value);
      emitting.emplace_back(t);
      light_Le_ = s.Le;
      light_normal_ = s.normal;
    }
    surfaces_.push_back(s);
  }
  // Two triangles (0, 1, 2) and (0, 2, 3) of a parallelogram.
  if (emitting.size() != 2) throw std::invalid_argument("EmbreePaths: one rectangle must emit");
  light_corner_ = mesh.vertices[emitting[0].x];
  light_u_ = mesh.vertices[emitting[0].y] - light_corner_;
  light_v_ = mesh.vertices[emitting[1].z] - light_corner_;
  light_area_ = glm::length(glm::cross(light_u_, light_v_));
  embree_ = std::make_unique<EmbreeScene>(mesh);
}

vec3 EmbreePaths::trace_path(vec3 o, vec3 d, uint32_t max_depth, Pcg32& random) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  vec3 L(0), beta(1);
  float pdf_bsdf = 0;  // of d [1/sr]; 0: the camera's ray
  for (uint32_t depth = 1; depth <= max_depth; ++depth) {
    RTCRayHit query{};
    query.ray = make_ray(o, d, kInfinity);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->handle(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
    const Surface& s = surfaces_[query.hit.primID];
    const float cosine = -glm::dot(s.normal, d), t = query.ray.tfar;
    if (cosine <= 0) break;  // one-sided
    if (s.Le.x > 0) {
      const float pdf_light = t * t / (cosine * light_area_);
      L += beta * s.Le * (pdf_bsdf == 0 ? 1 : mis_weight(pdf_bsdf, pdf_light));
    }
    if (depth == max_depth) break;
    const vec3 p = o + t * d + 1e-5f * s.normal;

    const vec3 target = light_corner_ + random.uniform() * light_u_ + random.uniform() * light_v_, to = target - p;
    const float distance2 = glm::dot(to, to), distance = glm::sqrt(distance2);
    const vec3 wi = to / distance;
    const float cosine_p = glm::dot(s.normal, wi), cosine_light = -glm::dot(light_normal_, wi);
    if (cosine_p > 0 && cosine_light > 0) {
      const float pdf_light = distance2 / (cosine_light * light_area_);
      const vec3 contribution =
          beta * s.reflectance * light_Le_ * (cosine_p / kPi / pdf_light * mis_weight(pdf_light, cosine_p / kPi));
      RTCRay shadow = make_ray(p, wi, distance * 0.9999f);
      rtcOccluded1(embree_->handle(), &context, &shadow);
      if (shadow.tfar >= 0) L += contribution;
    }

    beta *= s.reflectance;
    o = p;
    d = sample_cosine(s.normal, random);
    pdf_bsdf = glm::max(glm::dot(s.normal, d), 1e-6f) / kPi;
  }
  return L;
}

glm::dvec3 EmbreePaths::render(uint32_t samples, uint32_t max_depth, uint64_t seed, int threads) const {
  const vec3 right(camera_.right), up(camera_.up), forward(camera_.forward), position(camera_.position);
  std::atomic<uint32_t> next_row = 0;
  std::mutex mutex;
  glm::dvec3 total(0);
  const auto work = [&] {
    glm::dvec3 sum(0);
    for (uint32_t y; (y = next_row.fetch_add(1)) < height_;) {
      Pcg32 random(seed * height_ + y);
      for (uint32_t x = 0; x < width_; ++x)
        for (uint32_t k = 0; k < samples; ++k) {
          const float fx = static_cast<float>(x) + random.uniform(), fy = static_cast<float>(y) + random.uniform();
          const glm::vec4& m = camera_.scale_offset;
          const vec3 d = forward + (m.x * fx + m.z) * right + (m.y * fy + m.w) * up;
          sum += glm::dvec3(trace_path(position, glm::normalize(d), max_depth, random));
        }
    }
    const std::lock_guard lock(mutex);
    total += sum;
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back(work);
    work();
  }
  return total / (double(width_) * height_ * samples);
}

}  // namespace tachylite::bench
