#include <priormap/raycast/ray_scene.hpp>

#include <embree3/rtcore.h>

#include <algorithm>
#include <string>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

constexpr std::size_t packet_size = 16;

void throw_embree_error(void*, RTCError, const char* message) { throw Error(std::string("Embree: ") + message); }

void attach(RTCDevice device, RTCScene scene, const TriangleMesh& mesh, const Eigen::Vector3d& origin, unsigned id) {
  if (mesh.triangles.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    Eigen::Map<Eigen::Vector3f>(vertices + 3 * i) = (mesh.vertices[i] - origin).cast<float>();
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                      3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) std::copy_n(mesh.triangles[i].data(), 3, indices + 3 * i);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

RTCIntersectContext coherent_context() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

/// Packet lane `k`: the stretch of `origin + t direction` with t in [0, far].
void set_ray(RTCRay16& ray, std::size_t k, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float far) {
  ray.org_x[k] = origin.x();
  ray.org_y[k] = origin.y();
  ray.org_z[k] = origin.z();
  ray.dir_x[k] = direction.x();
  ray.dir_y[k] = direction.y();
  ray.dir_z[k] = direction.z();
  ray.tnear[k] = 0;
  ray.tfar[k] = far;
  ray.time[k] = 0;
  ray.mask[k] = 0xffffffffu;
  ray.id[k] = static_cast<unsigned>(k);
  ray.flags[k] = 0;
}

}  // namespace

struct RayScene::Impl {
  Eigen::Vector3d origin;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

RayScene::RayScene(std::span<const TriangleMesh> meshes, const Eigen::Vector3d& origin) : impl_(std::make_unique<Impl>()) {
  impl_->origin = origin;
  // One thread: the tree, and with it the choice between triangles at the same distance, is the same in every run.
  impl_->device = rtcNewDevice("threads=1");
  if (!impl_->device) throw Error("Embree: no ray tracing device on this machine");
  rtcSetDeviceErrorFunction(impl_->device, throw_embree_error, nullptr);
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < meshes.size(); ++i)
    attach(impl_->device, impl_->scene, meshes[i], origin, static_cast<unsigned>(i));
  rtcCommitScene(impl_->scene);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

const Eigen::Vector3d& RayScene::origin() const { return impl_->origin; }

void RayScene::cast(std::span<const Ray> rays, float max_range_m, std::span<RayHit> hits) const {
  RTCIntersectContext context = coherent_context();
  alignas(64) int valid[packet_size];
  alignas(64) RTCRayHit16 packet;
  for (std::size_t first = 0; first < rays.size(); first += packet_size) {
    const std::size_t count = std::min(packet_size, rays.size() - first);
    for (std::size_t k = 0; k < packet_size; ++k) {
      const Ray& ray = rays[first + std::min(k, count - 1)];
      valid[k] = k < count ? -1 : 0;
      set_ray(packet.ray, k, ray.origin, ray.direction, max_range_m);
      packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid, impl_->scene, &context, &packet);
    for (std::size_t k = 0; k < count; ++k) {
      RayHit hit;
      if (packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID)
        hit = {packet.ray.tfar[k], packet.hit.geomID[k], packet.hit.primID[k],
               Eigen::Vector3f(packet.hit.Ng_x[k], packet.hit.Ng_y[k], packet.hit.Ng_z[k]).normalized()};
      hits[first + k] = hit;
    }
  }
}

void RayScene::cast(std::span<const Segment> segments, std::span<std::uint8_t> blocked) const {
  RTCIntersectContext context = coherent_context();
  alignas(64) int valid[packet_size];
  alignas(64) RTCRay16 packet;
  for (std::size_t first = 0; first < segments.size(); first += packet_size) {
    const std::size_t count = std::min(packet_size, segments.size() - first);
    for (std::size_t k = 0; k < packet_size; ++k) {
      const Segment& segment = segments[first + std::min(k, count - 1)];
      valid[k] = k < count ? -1 : 0;
      set_ray(packet, k, segment.from, segment.to - segment.from, 1);
    }
    rtcOccluded16(valid, impl_->scene, &context, &packet);
    for (std::size_t k = 0; k < count; ++k) blocked[first + k] = packet.tfar[k] < 0;
  }
}

}  // namespace priormap
