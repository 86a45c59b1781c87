#include "bench/embree_scene.h"

#include <cstring>
#include <stdexcept>

namespace tachylite::bench {

RTCRay to_embree(const test::TraceRay& ray) {
  RTCRay r{};
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = 0;
  r.tfar = ray.t_max;
  r.mask = ~0u;
  return r;
}

EmbreeScene::EmbreeScene(const test::TestMesh& mesh) {
  device_ = rtcNewDevice("threads=2");
  if (!device_) throw std::runtime_error("rtcNewDevice failed");
  scene_ = rtcNewScene(device_);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                           mesh.vertices.size());
  std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(glm::vec3));
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                                          mesh.triangles.size());
  std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * sizeof(glm::uvec3));
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeScene::closest(std::span<const test::TraceRay> rays, std::span<test::TraceHit> hits, int threads) const {
  for_blocks(rays.size(), threads, [&](size_t first, size_t last) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (size_t i = first; i < last; ++i) {
      RTCRayHit query{};
      query.ray = to_embree(rays[i]);
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_, &context, &query);
      const bool hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
      hits[i] = {hit ? query.hit.primID : gpu::kNoHit, query.hit.u, query.hit.v, query.ray.tfar};
    }
  });
}

void EmbreeScene::occluded(std::span<const test::TraceRay> rays, std::span<test::TraceHit> hits, int threads) const {
  for_blocks(rays.size(), threads, [&](size_t first, size_t last) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (size_t i = first; i < last; ++i) {
      RTCRay ray = to_embree(rays[i]);
      rtcOccluded1(scene_, &context, &ray);
      hits[i] = {ray.tfar < 0 ? 0 : gpu::kNoHit, 0, 0, ray.tfar};
    }
  });
}

}  // namespace tachylite::bench
