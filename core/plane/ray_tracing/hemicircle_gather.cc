// SPDX-License-Identifier: Apache-2.0
#include "core/plane/ray_tracing/hemicircle_gather.h"

#include <algorithm>
#include <optional>

#include "core/plane/ray_tracing/edge_on.h"
#include "core/plane/ray_tracing/end_finder.h"
#include "core/sampling/hash.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// Children of a gather's key, beyond any number of rays.
constexpr std::uint64_t kShift = std::uint64_t{1} << 40;
constexpr std::uint64_t kRays = kShift + 1;
constexpr std::uint64_t kHorizon = std::uint64_t{1} << 41;
constexpr std::uint64_t kEdgeOn = std::uint64_t{1} << 44;
constexpr std::uint64_t kPast = std::uint64_t{1} << 42;

// Among few rays, those for derivatives alone are many: they branch as if they were one of fewer, to cost less than a
// fifth of all.
constexpr std::uint32_t kMany = 64;
std::uint32_t Sparing(std::uint32_t rays) { return rays < kMany ? std::max(1u, rays / 4) : rays; }

// In the direction of ray.sine.
void Cast(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, std::uint64_t key,
          const Cancellation& cancellation, GatheredRay& ray, double& cast) {
  ray.cosine = CosineOf(ray.sine);
  const Vector2 direction = ray.sine * receiver.tangent + ray.cosine * receiver.normal;
  ++cast;
  if (const std::optional<Hit> hit = tree.caster().ClosestHit({receiver.position, receiver.element}, direction)) {
    ray.radiance = tree.Radiance(*hit, direction, rays, key, cancellation, cast);
    ray.element = hit->element;
    ray.to = hit->distance * direction;
    ray.normal = Dot(hit->normal, direction) < 0 ? hit->normal : -hit->normal;
  } else {
    ray.radiance = tree.Sky();
  }
}

// Whether a piece ends at the same point as another's vertex, bit for bit.
bool EndsAt(const Scene& scene, ElementId id, const Edge& vertex) {
  if (id == ElementId::kNone || vertex.kind != Edge::Kind::kVertex) return false;
  const Element& element = scene.element(id);
  return element.a == vertex.point || element.b == vertex.point;
}

// Adds three rays that stand for no stretch where a piece is seen edge-on and none of `gathered` has met it: what is on
// either side of it and the piece itself, with its ends between them.
void LookAtEdgeOnPieces(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, std::uint64_t key,
                        const Cancellation& cancellation, std::vector<GatheredRay>& gathered, double& cast) {
  const EdgeOnPieces found(tree.caster(), receiver, rays);
  std::uint64_t number = 0;
  for (const EdgeOnPiece& piece : found.pieces()) {
    const auto own = [&] { return ChildKey(key, kEdgeOn + number++); };
    const auto after =
        std::find_if(gathered.begin(), gathered.end(), [&](const GatheredRay& ray) { return ray.sine > piece.low.s; });
    const auto met = [&](const GatheredRay& ray) { return ray.element == piece.element; };
    if (after == gathered.begin() || after == gathered.end() || met(*after) || met(*(after - 1))) continue;
    const double step = 4 * tree.caster().scene().touch_distance() * std::max({piece.low.q, piece.high.q, 1.0});
    GatheredRay left, middle, right;
    left.sine = piece.low.s - step, right.sine = piece.high.s + step;
    if (!(left.sine > (after - 1)->sine && right.sine < after->sine)) continue;
    for (GatheredRay* ray : {&left, &middle, &right}) ray->begin = ray->end = after->begin;
    Cast(tree, receiver, Sparing(rays), own(), cancellation, left, cast);
    Cast(tree, receiver, Sparing(rays), own(), cancellation, right, cast);
    middle.sine = (piece.low.s + piece.high.s) / 2;
    middle.cosine = CosineOf(middle.sine);
    middle.radiance = tree.Radiance(piece.middle, piece.toward, Sparing(rays), own(), cancellation, cast);
    middle.element = piece.element;
    middle.to = piece.middle.position - receiver.position;
    middle.normal = Dot(piece.middle.normal, piece.toward) < 0 ? piece.middle.normal : -piece.middle.normal;
    middle.break_before = piece.low;
    right.break_before = piece.high;
    gathered.insert(after, {left, middle, right});
  }
}

}  // namespace

void GatherHemicircle(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, std::uint64_t key,
                      const Cancellation& cancellation, std::vector<GatheredRay>& gathered, double& cast) {
  gathered.clear();
  const double shift = ToUnitInterval(ChildKey(key, kShift));
  for (std::uint32_t k = 0; k <= rays; ++k) {
    GatheredRay ray;
    if (k > 0) ray.begin = std::min(1.0, 2 * ((k - 1 + shift) / rays) - 1);
    if (k < rays) ray.end = std::min(1.0, 2 * ((k + shift) / rays) - 1);
    if (!(ray.begin < ray.end)) continue;
    ray.sine = std::clamp(ray.begin + ToUnitInterval(ChildKey(key, k)) * (ray.end - ray.begin), ray.begin, ray.end);
    Cast(tree, receiver, rays, ChildKey(key, kRays + k), cancellation, ray, cast);
    gathered.push_back(ray);
    if (cancellation.cancelled()) return;
  }
}

void LookPastEnds(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, std::uint64_t key,
                  const Cancellation& cancellation, std::vector<GatheredRay>& gathered, double& cast) {
  constexpr int kMostLooks = 8;  // Between two rays.
  const EndFinder ends(tree.caster().scene(), receiver);
  LookAtEdgeOnPieces(tree, receiver, rays, key, cancellation, gathered, cast);
  // The horizon is a neighbour too: something may end just above it.
  GatheredRay left, right;
  left.sine = left.begin = left.end = -1, right.sine = right.begin = right.end = 1;
  std::vector<GatheredRay> all;
  all.reserve(gathered.size() + gathered.size() / 2 + kMostLooks);
  std::vector<GatheredRay> later;  // Those found on the way from the ray after to the ray before, the last one first.
  for (std::size_t k = 0; k <= gathered.size(); ++k) {
    const bool last = k == gathered.size();
    if (k > 0) all.push_back(gathered[k - 1]);
    const GatheredRay& next = last ? right : gathered[k];
    // Where they meet one surface, or what lies between is known, there is nothing to look for.
    if (next.break_before || (k > 0 && all.back().element == next.element)) continue;
    const double end_before = k > 0 ? all.back().end : left.end;
    GatheredRay after = next;
    later.clear();
    for (int look = 0; look < kMostLooks; ++look) {
      const GatheredRay& before = all.empty() ? left : all.back();
      const std::optional<Edge> end = ends.Between(before, after);
      if (!end) break;
      const bool forward = before.InverseDistance() >= after.InverseDistance();
      if (EndsAt(tree.caster().scene(), (forward ? after : before).element, *end)) {
        // A corner: there is nothing between its sides.
        (later.empty() && !last ? gathered[k] : after).break_before = end;
        break;
      }
      GatheredRay past;
      past.begin = past.end = end_before;
      // As far beyond the end as coordinates are sure of.
      const double step = 4 * tree.caster().scene().touch_distance() * std::max(end->q, 1.0);
      past.sine = end->s + (forward ? step : -step);
      if (!(past.sine > before.sine && past.sine < after.sine)) break;
      Cast(tree, receiver, Sparing(rays),
           ChildKey(key, kPast + (std::uint64_t{k} << 8) + static_cast<std::uint64_t>(look)), cancellation, past, cast);
      if (forward) {
        past.break_before = end;
        all.push_back(past);
      } else {
        after.break_before = end;
        later.push_back(after);
        after = past;
      }
      if ((all.empty() ? left : all.back()).element == after.element) break;
    }
    if (!later.empty()) {
      all.push_back(after);
      while (later.size() > 1) all.push_back(later.back()), later.pop_back();
      if (!last) gathered[k].break_before = later.front().break_before;
    }
  }
  gathered.swap(all);
}

Spectrum EmittedToward(const Scene& scene, const Receiver& receiver, const GatheredRay& ray) {
  if (ray.element == ElementId::kNone) return scene.environment();
  const Vector2 front = FrontNormal(scene.element(ray.element), receiver.position + ray.to);
  return scene.curve_of(ray.element).EmittedRadiance(Dot(front, ray.normal) > 0 ? Side::kFront : Side::kBack);
}

Spectrum IrradianceOf(const std::vector<GatheredRay>& gathered) {
  Spectrum sum;
  for (const GatheredRay& ray : gathered) sum = sum + (ray.end - ray.begin) * ray.radiance;
  return sum;
}

Spectrum RotationOf(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, std::uint64_t key,
                    const Cancellation& cancellation, const std::vector<GatheredRay>& gathered, double& cast) {
  Spectrum sum;
  double high = CosineOf(gathered.front().begin);
  for (std::size_t k = 0; k < gathered.size(); ++k) {
    const GatheredRay& ray = gathered[k];
    // A stretch begins where the one before ends.
    const double low = high;
    high = CosineOf(ray.end);
    if (k == 0 || k + 1 == gathered.size()) {
      // Evenly among the cosines of the stretch.
      const double side = k == 0 ? -1 : 1, border = k == 0 ? high : low;
      const std::uint64_t own = ChildKey(key, kHorizon + (k == 0 ? 0 : 1));
      GatheredRay even;
      even.sine = side * CosineOf(border * ToUnitInterval(ChildKey(own, 0)));
      Cast(tree, receiver, Sparing(rays), ChildKey(own, 1), cancellation, even, cast);
      sum = sum + side * border * even.radiance;
      continue;
    }
    // Evenly among sines, radiance times the tangent has the right mean; times the mean of the tangent it has none of
    // its noise. What the neighbours, which know nothing of this ray, tell of the radiance is taken without noise.
    const double stretch = low - high, tangent = (ray.end - ray.begin) * ray.sine / ray.cosine;
    const Spectrum others = 0.5 * (gathered[k - 1].radiance + gathered[k + 1].radiance);
    sum = sum + tangent * ray.radiance + (stretch - tangent) * others;
  }
  return sum;
}

}  // namespace flatlight
