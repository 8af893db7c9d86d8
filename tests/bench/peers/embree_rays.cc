// SPDX-License-Identifier: Apache-2.0
// Embree has no plane: a segment becomes a quad that stands on it, from z = -1 to 1, or a piece of user geometry with
// as tall a box (a flat one would spoil the measure of surfaces that its trees are built by), and rays stay in z = 0.
#include <embree3/rtcore.h>

#ifdef __SSE__
#include <immintrin.h>
#endif

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "tests/bench/peers/ray_peer.h"

namespace flatlight {
namespace {

static_assert(RTC_INVALID_GEOMETRY_ID == kNoSegment);

// Embree's manual asks for it: numbers too small to matter become 0 while it works.
class DenormalsOff {
 public:
#ifdef __SSE__
  DenormalsOff() : before_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _mm_setcsr(_mm_getcsr() | 0x0040);  // Denormals as inputs are 0 too (DAZ).
  }
  ~DenormalsOff() { _mm_setcsr(before_); }
  DenormalsOff(const DenormalsOff&) = delete;
  DenormalsOff& operator=(const DenormalsOff&) = delete;

 private:
  unsigned before_;
#endif
};

[[noreturn]] void Fail(void*, RTCError, const char* message) {
  std::fprintf(stderr, "peers: embree: %s\n", message);
  std::exit(1);
}

class EmbreeRays : public RayPeer {
 public:
  ~EmbreeRays() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeRays(const EmbreeRays&) = delete;
  EmbreeRays& operator=(const EmbreeRays&) = delete;

  void Cast(std::size_t first, std::size_t count, PeerHit* hits) override {
    [[maybe_unused]] const DenormalsOff denormals_off;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = 0; i < count; ++i) {
      const Ray& ray = rays_[first + i];
      RTCRayHit query;
      query.ray = {ray.x, ray.y,   0, near_, ray.dx, ray.dy, 0, 0, std::numeric_limits<float>::infinity(),
                   ~0U,   ray.own, 0};
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.primID = kNoSegment;
      rtcIntersect1(scene_, &context, &query);
      hits[i] = {query.hit.primID, static_cast<double>(query.ray.tfar)};
    }
  }

 protected:
  explicit EmbreeRays(const RayScene& scene, double near = 0)
      : device_(rtcNewDevice("threads=1")), near_(static_cast<float>(near)) {
    if (!device_) Fail(nullptr, rtcGetDeviceError(nullptr), "no device");
    rtcSetDeviceErrorFunction(device_, Fail, nullptr);
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_NONE);  // Neither robust nor compact.
    for (const PeerRay& ray : scene.rays) {
      rays_.push_back({static_cast<float>(ray.origin.x), static_cast<float>(ray.origin.y),
                       static_cast<float>(ray.direction.x), static_cast<float>(ray.direction.y), ray.own});
    }
  }
  RTCDevice device() const { return device_; }
  void Commit(RTCGeometry geometry) {
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }

 private:
  struct Ray {
    float x, y, dx, dy;
    std::uint32_t own;
  };

  RTCDevice device_;
  RTCScene scene_;
  float near_;  // Hits at less than this do not count.
  std::vector<Ray> rays_;
};

class EmbreeQuads : public EmbreeRays {
 public:
  // Rays tell the quad they leave by its number, or with `near` above 0 by a distance.
  explicit EmbreeQuads(const RayScene& scene, double near) : EmbreeRays(scene, near), near_(near) {
    const std::size_t count = scene.segments.size();
    RTCGeometry quads = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_QUAD);
    auto* vertex = static_cast<float*>(
        rtcSetNewGeometryBuffer(quads, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4 * count));
    auto* index = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(quads, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), count));
    for (const SegmentDescription& segment : scene.segments) {
      const auto ax = static_cast<float>(segment.a.x), ay = static_cast<float>(segment.a.y);
      const auto bx = static_cast<float>(segment.b.x), by = static_cast<float>(segment.b.y);
      for (const float coordinate : {ax, ay, -1.0F, bx, by, -1.0F, bx, by, 1.0F, ax, ay, 1.0F}) *vertex++ = coordinate;
    }
    for (unsigned i = 0; i < 4 * count; ++i) index[i] = i;
    if (scene.on_segments && near == 0) rtcSetGeometryIntersectFilterFunction(quads, SkipOwn);
    Commit(quads);
  }
  const char* name() const override { return near_ > 0 ? "embree quads tnear" : "embree quads"; }
  double near() const override { return near_; }

 private:
  static void SkipOwn(const RTCFilterFunctionNArguments* arguments) {
    if (RTCHitN_primID(arguments->hit, 1, 0) == RTCRayN_id(arguments->ray, 1, 0)) arguments->valid[0] = 0;
  }

  double near_;
};

class EmbreeUserGeometry : public EmbreeRays {
 public:
  explicit EmbreeUserGeometry(const RayScene& scene) : EmbreeRays(scene) {
    for (const SegmentDescription& segment : scene.segments) {
      segments_.push_back({static_cast<float>(segment.a.x), static_cast<float>(segment.a.y),
                           static_cast<float>(segment.b.x), static_cast<float>(segment.b.y)});
    }
    RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(segments_.size()));
    rtcSetGeometryUserData(geometry, segments_.data());
    rtcSetGeometryBoundsFunction(geometry, Bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, Intersect);
    Commit(geometry);
  }
  const char* name() const override { return "embree user geometry"; }

 private:
  struct Segment {
    float ax, ay, bx, by;
  };

  static void Bounds(const RTCBoundsFunctionArguments* arguments) {
    const Segment& s = static_cast<const Segment*>(arguments->geometryUserPtr)[arguments->primID];
    *arguments->bounds_o = {std::min(s.ax, s.bx), std::min(s.ay, s.by), -1, 0,
                            std::max(s.ax, s.bx), std::max(s.ay, s.by), 1,  0};
  }

  static void Intersect(const RTCIntersectFunctionNArguments* arguments) {
    RTCRayHit& query = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
    const Segment& s = static_cast<const Segment*>(arguments->geometryUserPtr)[arguments->primID];
    const RTCRay& ray = query.ray;
    // origin + t * direction = a + u * (b - a)
    const float ex = s.bx - s.ax, ey = s.by - s.ay;
    const float px = s.ax - ray.org_x, py = s.ay - ray.org_y;
    const float inverse = 1 / (ray.dir_x * ey - ray.dir_y * ex);
    const float t = (px * ey - py * ex) * inverse;
    const float u = (px * ray.dir_y - py * ray.dir_x) * inverse;
    if (!(t > ray.tnear && t < ray.tfar && u >= 0 && u <= 1) || arguments->primID == ray.id) return;
    query.ray.tfar = t;
    query.hit.u = u, query.hit.v = 0;
    query.hit.Ng_x = -ey, query.hit.Ng_y = ex, query.hit.Ng_z = 0;
    query.hit.geomID = arguments->geomID;
    query.hit.primID = arguments->primID;
    query.hit.instID[0] = arguments->context->instID[0];
  }

  std::vector<Segment> segments_;
};

}  // namespace

std::unique_ptr<RayPeer> MakeEmbreeQuads(const RayScene& scene) { return std::make_unique<EmbreeQuads>(scene, 0); }
std::unique_ptr<RayPeer> MakeEmbreeQuadsNear(const RayScene& scene) {
  // A thousandth of the mean way of a ray, within what single precision allows.
  double length = 0;
  for (const SegmentDescription& segment : scene.segments) length += Length(segment.b - segment.a);
  return std::make_unique<EmbreeQuads>(scene, std::clamp(1e-3 * std::numbers::pi / (2 * length), 3e-7, 1e-5));
}
std::unique_ptr<RayPeer> MakeEmbreeUserGeometry(const RayScene& scene) {
  return std::make_unique<EmbreeUserGeometry>(scene);
}

}  // namespace flatlight
