#include "core/raytrace/traced_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/violations.h"
#include "core/mesh/float3.h"
#include "core/mesh/rotation.h"

namespace terrane::core {
namespace {

// Upper bounds of what Embree 3.13 takes, measured by core_raytrace_test.
constexpr std::int64_t kBytesPerVertex = 16;
constexpr std::int64_t kBytesPerTriangle = 200;
constexpr std::int64_t kBytesPerInstance = 1100;
constexpr std::int64_t kBytesPerScene = 4'000'000;

Float3 Quotient(Float3 a, Float3 b) {
  return {a.x / b.x, a.y / b.y, a.z / b.z};
}

bool IsFinite(Float3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

template <typename Value>
Value Interpolated(const std::vector<Value>& column,
                   const std::uint32_t* corners, float u, float v) {
  return (1 - u - v) * column[corners[0]] + u * column[corners[1]] +
         v * column[corners[2]];
}

// Leaves out hits from behind.
void SeeFrontOnly(const RTCFilterFunctionNArguments* args) {
  RTCRayN* const ray = args->ray;
  RTCHitN* const hit = args->hit;
  for (unsigned i = 0; i < args->N; ++i) {
    const Float3 normal = {RTCHitN_Ng_x(hit, args->N, i),
                           RTCHitN_Ng_y(hit, args->N, i),
                           RTCHitN_Ng_z(hit, args->N, i)};
    const Float3 direction = {RTCRayN_dir_x(ray, args->N, i),
                              RTCRayN_dir_y(ray, args->N, i),
                              RTCRayN_dir_z(ray, args->N, i)};
    if (Dot(normal, direction) > 0) args->valid[i] = 0;
  }
}

RTCRay ToEmbree(const Ray& ray) {
  RTCRay out = {};
  out.org_x = ray.origin.x;
  out.org_y = ray.origin.y;
  out.org_z = ray.origin.z;
  out.dir_x = ray.direction.x;
  out.dir_y = ray.direction.y;
  out.dir_z = ray.direction.z;
  out.tfar = ray.length;
  out.mask = ~0u;
  return out;
}

absl::Status CheckObject(const Scene& scene, std::size_t index) {
  const SceneObject& object = scene.objects[index];
  const std::string field = "objects[" + std::to_string(index) + "]";
  const Mesh& mesh = *object.mesh;
  const std::size_t vertices = mesh.positions.size();
  if (object.material >= scene.materials.size()) {
    return ViolationError(field + ".material",
                          "must name a material of the scene");
  }
  if (mesh.indices.size() % 3 != 0 ||
      (!mesh.normals.empty() && mesh.normals.size() != vertices) ||
      (!mesh.colors.empty() && mesh.colors.size() != vertices)) {
    return ViolationError(field + ".mesh", "must have columns of one length");
  }
  if (std::ranges::any_of(mesh.indices,
                          [&](std::uint32_t i) { return i >= vertices; })) {
    return ViolationError(field + ".mesh.indices", "must name vertices");
  }
  if (!std::ranges::all_of(mesh.positions, IsFinite)) {
    return ViolationError(field + ".mesh.positions", "must be finite");
  }
  return absl::OkStatus();
}

absl::Status CheckScene(const Scene& scene, std::int64_t budget_bytes) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const absl::Status checked = CheckObject(scene, i);
    if (!checked.ok()) return checked;
  }
  const SceneSize size = SizeOf(scene);
  if (size.triangles == 0) {
    return ViolationError("objects", "must hold a triangle");
  }
  if (size.instances > TracedScene::kMaxInstances) {
    return absl::ResourceExhaustedError(
        "a scene holds at most " + std::to_string(TracedScene::kMaxInstances) +
        " instances, got " + std::to_string(size.instances));
  }
  const std::int64_t bytes = TracedBytes(size);
  if (bytes > budget_bytes) {
    return absl::ResourceExhaustedError(
        "tracing the scene takes " + std::to_string(bytes) +
        " bytes, allowed are " + std::to_string(budget_bytes));
  }
  return absl::OkStatus();
}

}  // namespace

SceneSize SizeOf(const Scene& scene) {
  SceneSize size;
  for (const SceneObject& object : scene.objects) {
    size.vertices += static_cast<std::int64_t>(object.mesh->positions.size());
    size.triangles +=
        static_cast<std::int64_t>(object.mesh->indices.size() / 3);
    if (object.instances != nullptr) {
      size.instances += static_cast<std::int64_t>(object.instances->count());
    }
  }
  return size;
}

std::int64_t TracedBytes(const SceneSize& size) {
  return kBytesPerScene + kBytesPerVertex * size.vertices +
         kBytesPerTriangle * size.triangles +
         kBytesPerInstance * size.instances;
}

// Embree's device and scenes: made, committed, released.
class TracedScene::Embree {
 public:
  Embree() : device_(rtcNewDevice("threads=1,set_affinity=0")) {
    if (device_ == nullptr) return;
    rtcSetDeviceMemoryMonitorFunction(device_, &CountBytes, &bytes_);
    top_ = NewScene();
  }
  ~Embree() {
    for (RTCScene scene : prototypes_) rtcReleaseScene(scene);
    if (top_ != nullptr) rtcReleaseScene(top_);
    if (device_ != nullptr) rtcReleaseDevice(device_);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  RTCScene top() const { return top_; }
  std::int64_t bytes() const { return bytes_; }

  // The scene that the instances of an object share. Owned by this.
  RTCScene NewPrototype() {
    prototypes_.push_back(NewScene());
    return prototypes_.back();
  }

  void AttachMesh(RTCScene scene, const Mesh& mesh, bool double_sided) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* const positions = rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Float3),
        mesh.positions.size());
    void* const indices = rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
        3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
    // Without memory the error waits for Commit.
    if (positions != nullptr && indices != nullptr) {
      std::ranges::copy(mesh.positions, static_cast<Float3*>(positions));
      std::ranges::copy(mesh.indices, static_cast<std::uint32_t*>(indices));
      if (!double_sided) {
        rtcSetGeometryIntersectFilterFunction(geometry, &SeeFrontOnly);
      }
      Attach(scene, geometry);
    }
    rtcReleaseGeometry(geometry);
  }

  void AttachInstance(RTCScene prototype, const Instances& instances,
                      std::size_t i) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, prototype);
    const Quaternion& turn = instances.rotations[i];
    const Float3 scale = instances.scales[i];
    const Float3 columns[] = {
        Rotated(turn, {scale.x, 0, 0}), Rotated(turn, {0, scale.y, 0}),
        Rotated(turn, {0, 0, scale.z}), instances.translations[i]};
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                            columns);
    Attach(top_, geometry);
    rtcReleaseGeometry(geometry);
  }

  absl::Status Commit(RTCScene scene, std::stop_token stop) {
    rtcSetSceneProgressMonitorFunction(scene, &GoesOn, &stop);
    rtcCommitScene(scene);
    rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
    return Error();
  }

  absl::Status Error() const {
    switch (rtcGetDeviceError(device_)) {
      case RTC_ERROR_NONE:
        return absl::OkStatus();
      case RTC_ERROR_CANCELLED:
        return absl::CancelledError("building the scene stopped");
      case RTC_ERROR_OUT_OF_MEMORY:
        return absl::ResourceExhaustedError("Embree: out of memory");
      case RTC_ERROR_UNSUPPORTED_CPU:
        return absl::InternalError("Embree: this CPU is not supported");
      default:
        return absl::InternalError("Embree: could not build the scene");
    }
  }

 private:
  RTCScene NewScene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    return scene;
  }

  static void Attach(RTCScene scene, RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
  }

  static bool CountBytes(void* sum, ssize_t bytes, bool) {
    *static_cast<std::atomic<std::int64_t>*>(sum) += bytes;
    return true;
  }
  static bool GoesOn(void* stop, double) {
    return !static_cast<std::stop_token*>(stop)->stop_requested();
  }

  std::atomic<std::int64_t> bytes_ = 0;
  const RTCDevice device_;
  RTCScene top_ = nullptr;
  std::vector<RTCScene> prototypes_;
};

absl::StatusOr<std::shared_ptr<const TracedScene>> TracedScene::Build(
    const Scene& scene, std::int64_t budget_bytes, std::stop_token stop) {
  const absl::Status checked = CheckScene(scene, budget_bytes);
  if (!checked.ok()) return checked;
  std::shared_ptr<TracedScene> traced(new TracedScene(scene));
  const absl::Status built = traced->BuildObjects(std::move(stop));
  if (!built.ok()) return built;
  return traced;
}

TracedScene::TracedScene(const Scene& scene)
    : scene_(scene), embree_(std::make_unique<Embree>()) {}

TracedScene::~TracedScene() = default;

absl::Status TracedScene::BuildObjects(std::stop_token stop) {
  // Geometries of the top level are numbered in the order that they come.
  RTCScene const top = embree_->top();
  if (top == nullptr) return embree_->Error();
  for (std::uint32_t o = 0; o < scene_.objects.size(); ++o) {
    const SceneObject& object = scene_.objects[o];
    if (object.mesh->indices.empty()) continue;
    const bool double_sided = scene_.materials[object.material].double_sided;
    if (object.instances == nullptr) {
      embree_->AttachMesh(top, *object.mesh, double_sided);
      placed_.push_back({o, 0});
      continue;
    }
    RTCScene const prototype = embree_->NewPrototype();
    embree_->AttachMesh(prototype, *object.mesh, double_sided);
    const absl::Status committed = embree_->Commit(prototype, stop);
    if (!committed.ok()) return committed;
    for (std::uint32_t i = 0; i < object.instances->count(); ++i) {
      if (i % 256 == 0 && stop.stop_requested()) {
        return absl::CancelledError("building the scene stopped");
      }
      embree_->AttachInstance(prototype, *object.instances, i);
      placed_.push_back({o, i});
    }
  }
  const absl::Status committed = embree_->Commit(top, std::move(stop));
  if (!committed.ok()) return committed;
  RTCBounds box;
  rtcGetSceneBounds(top, &box);
  bounds_ = {{box.lower_x, box.lower_y, box.lower_z},
             {box.upper_x, box.upper_y, box.upper_z}};
  return absl::OkStatus();
}

bool TracedScene::Intersect(const Ray& ray, SurfacePoint* point) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit found = {};
  found.ray = ToEmbree(ray);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->top(), &context, &found);
  const RTCHit& hit = found.hit;
  if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;

  const bool instanced = hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  const Placed& placed = placed_[instanced ? hit.instID[0] : hit.geomID];
  const SceneObject& object = scene_.objects[placed.object];
  const Mesh& mesh = *object.mesh;
  const std::uint32_t* const corners =
      mesh.indices.data() + 3 * std::size_t{hit.primID};

  Float3 geometric = {hit.Ng_x, hit.Ng_y, hit.Ng_z};
  Float3 shading = geometric;
  if (!mesh.normals.empty()) {
    const Float3 normal = Interpolated(mesh.normals, corners, hit.u, hit.v);
    if (Dot(normal, normal) > 0) shading = normal;
  }
  if (instanced) {
    const Quaternion& turn = object.instances->rotations[placed.instance];
    const Float3 scale = object.instances->scales[placed.instance];
    geometric = Rotated(turn, Quotient(geometric, scale));
    shading = Rotated(turn, Quotient(shading, scale));
  }
  const float side = Dot(geometric, ray.direction) > 0 ? -1.0f : 1.0f;
  point->distance = found.ray.tfar;
  point->position = ray.origin + found.ray.tfar * ray.direction;
  point->geometric_normal = side * Normalized(geometric);
  point->shading_normal = side * Normalized(shading);
  point->color = mesh.colors.empty()
                     ? Float3{1, 1, 1}
                     : Interpolated(mesh.colors, corners, hit.u, hit.v);
  point->material = static_cast<std::uint32_t>(object.material);
  return true;
}

bool TracedScene::Occluded(const Ray& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query = ToEmbree(ray);
  rtcOccluded1(embree_->top(), &context, &query);
  return query.tfar < 0;
}

std::int64_t TracedScene::allocated_bytes() const { return embree_->bytes(); }

RTCSceneTy* TracedScene::embree_scene() const { return embree_->top(); }

}  // namespace terrane::core
