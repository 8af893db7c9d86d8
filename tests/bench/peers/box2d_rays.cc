// SPDX-License-Identifier: Apache-2.0
// Box2D fattens every box by b2_aabbExtension (0.1), which suits bodies of some metres; so its scene is scaled by a
// power of two to segments of 16 metres or more. Its rays end where they have crossed the scene.
#include <box2d/box2d.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/bench/peers/ray_peer.h"

namespace flatlight {
namespace {

b2Vec2 ToB2(double scale, double x, double y) { return {static_cast<float>(scale * x), static_cast<float>(scale * y)}; }

double ScaleFor(const RayScene& scene) {
  double shortest = 1;
  for (const SegmentDescription& segment : scene.segments) shortest = std::min(shortest, Length(segment.b - segment.a));
  return std::exp2(std::ceil(std::log2(16 / shortest)));
}

struct Ray {
  b2Vec2 from;
  b2Vec2 to;
  std::uint32_t own;
};

class Box2dRays : public RayPeer {
 protected:
  explicit Box2dRays(const RayScene& scene) : scale_(ScaleFor(scene)) {
    Point2 low{0, 0}, high{1, 1};
    for (const SegmentDescription& segment : scene.segments) {
      for (const Point2 p : {segment.a, segment.b}) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    }
    reach_ = Length(high - low);
    for (const PeerRay& ray : scene.rays) {
      const Point2 to = ray.origin + reach_ * ray.direction;
      rays_.push_back({ToB2(scale_, ray.origin.x, ray.origin.y), ToB2(scale_, to.x, to.y), ray.own});
    }
  }

  void SetShape(const SegmentDescription& segment, b2EdgeShape& shape) const {
    shape.SetTwoSided(ToB2(scale_, segment.a.x, segment.a.y), ToB2(scale_, segment.b.x, segment.b.y));
  }
  // `fraction` of the way from `from` to `to`.
  PeerHit HitAt(std::uint32_t segment, float fraction) const {
    return segment == kNoSegment ? PeerHit{} : PeerHit{segment, reach_ * static_cast<double>(fraction)};
  }
  const std::vector<Ray>& rays() const { return rays_; }

 private:
  double scale_;
  double reach_ = 0;
  std::vector<Ray> rays_;
};

// As a user of the whole library would: one static body with a fixture a segment.
class Box2dWorld : public Box2dRays {
 public:
  explicit Box2dWorld(const RayScene& scene) : Box2dRays(scene), world_({0, 0}) {
    const b2BodyDef definition;
    b2Body* body = world_.CreateBody(&definition);
    for (std::uint32_t i = 0; i < scene.segments.size(); ++i) {
      b2EdgeShape shape;
      SetShape(scene.segments[i], shape);
      b2FixtureDef fixture;
      fixture.shape = &shape;
      fixture.userData.pointer = i;
      body->CreateFixture(&fixture);
    }
  }
  const char* name() const override { return "box2d world"; }

  void Cast(std::size_t first, std::size_t count, PeerHit* hits) override {
    for (std::size_t i = 0; i < count; ++i) {
      const Ray& ray = rays()[first + i];
      Nearest nearest;
      nearest.own = ray.own;
      world_.RayCast(&nearest, ray.from, ray.to);
      hits[i] = HitAt(nearest.segment, nearest.fraction);
    }
  }

 private:
  struct Nearest : b2RayCastCallback {
    std::uint32_t own = kNoSegment;
    std::uint32_t segment = kNoSegment;
    float fraction = 1;

    float ReportFixture(b2Fixture* fixture, const b2Vec2&, const b2Vec2&, float at) override {
      const auto index = static_cast<std::uint32_t>(fixture->GetUserData().pointer);
      if (index == own) return -1;  // Go on as if it were not there.
      segment = index, fraction = at;
      return at;
    }
  };

  b2World world_;
};

// As a user would who wants nothing but rays: the tree of boxes and the edge's own test.
class Box2dTree : public Box2dRays {
 public:
  explicit Box2dTree(const RayScene& scene) : Box2dRays(scene), shapes_(scene.segments.size()) {
    identity_.SetIdentity();
    for (std::uint32_t i = 0; i < scene.segments.size(); ++i) {
      SetShape(scene.segments[i], shapes_[i]);
      b2AABB box;
      shapes_[i].ComputeAABB(&box, identity_, 0);
      const auto proxy = static_cast<std::size_t>(tree_.CreateProxy(box, nullptr));
      if (segment_of_.size() <= proxy) segment_of_.resize(proxy + 1);
      segment_of_[proxy] = i;
    }
  }
  const char* name() const override { return "box2d tree"; }

  void Cast(std::size_t first, std::size_t count, PeerHit* hits) override {
    for (std::size_t i = 0; i < count; ++i) {
      const Ray& ray = rays()[first + i];
      Nearest nearest{*this, ray.own};
      b2RayCastInput input;
      input.p1 = ray.from, input.p2 = ray.to, input.maxFraction = 1;
      tree_.RayCast(&nearest, input);
      hits[i] = HitAt(nearest.segment, nearest.fraction);
    }
  }

 private:
  struct Nearest {
    const Box2dTree& peer;
    std::uint32_t own;
    std::uint32_t segment = kNoSegment;
    float fraction = 1;

    float RayCastCallback(const b2RayCastInput& input, int32 proxy) {
      const std::uint32_t index = peer.segment_of_[static_cast<std::size_t>(proxy)];
      b2RayCastOutput output;
      if (index == own || !peer.shapes_[index].RayCast(&output, input, peer.identity_, 0)) return -1;
      segment = index, fraction = output.fraction;
      return fraction;
    }
  };

  b2DynamicTree tree_;
  b2Transform identity_;
  std::vector<b2EdgeShape> shapes_;
  std::vector<std::uint32_t> segment_of_;  // By proxy.
};

}  // namespace

std::unique_ptr<RayPeer> MakeBox2dWorld(const RayScene& scene) { return std::make_unique<Box2dWorld>(scene); }
std::unique_ptr<RayPeer> MakeBox2dTree(const RayScene& scene) { return std::make_unique<Box2dTree>(scene); }

}  // namespace flatlight
