// SPDX-License-Identifier: Apache-2.0
#include "core/plane/chains/chain_lights.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <variant>

#include "core/plane/materials/lossless.h"
#include "core/sampling/hash.h"

namespace flatlight {
namespace {

// Ways behind open beams are not tried more often.
constexpr double kMostChance = 0.125;
// Beams that were not followed beforehand take long to follow, the longer the chain. Of the ways that come to one so
// many go on, and so many from there on, link by link.
constexpr double kGrowChance = 0.05;
constexpr double kGrowSurvival = 0.75;
// A place on the circle that a ray comes from: the ray leaves there, or comes from across, never closer.
constexpr double kOwnPlace = 1e-9;

double Number(std::uint64_t& key) {
  key = ChildKey(key, 0);
  return ToUnitInterval(key);
}

}  // namespace

ChainLights::ChainLights(const RayCaster& caster, const ChainOptions& options)
    : caster_(caster), scene_(caster.scene()), options_(options), maker_(caster) {
  if (scene_.lights().empty() || maker_.turning_pieces() == 0 || options_.most_links == 0) return;
  Follow();
}

// The strongest beam first: so the beams of any moment are those that a smaller effort would have found.
void ChainLights::Follow() {
  double rays = 0;
  beams_ = maker_.FirstBeams(rays);
  followers_.resize(beams_.size());
  double total = 0;
  const auto weaker = [&](std::size_t i, std::size_t k) {
    return beams_[i].flux < beams_[k].flux || (beams_[i].flux == beams_[k].flux && i > k);
  };
  std::vector<std::size_t> queue;
  const auto push = [&](std::size_t i) {
    if (beams_[i].links() >= options_.most_links) return;
    queue.push_back(i);
    std::push_heap(queue.begin(), queue.end(), weaker);
  };
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    total += beams_[i].flux;
    push(i);
  }
  const std::size_t room = beams_.size() + options_.most_beams,
                    coarse_room = beams_.size() + options_.most_coarse_beams;
  bool coarse = true;
  std::size_t looks = 0;
  while (!queue.empty()) {
    const std::size_t i = queue.front();
    if (beams_[i].flux <= options_.least_share * total || beams_.size() >= room || looks >= options_.most_looks) break;
    if (coarse && beams_.size() >= coarse_room) {
      coarse_ = MakeLevel(queue, total);
      coarse = false;
    }
    std::pop_heap(queue.begin(), queue.end(), weaker);
    queue.pop_back();
    looks += maker_.turning_pieces();
    followers_[i] = {true, beams_.size(), 0};
    for (Beam& beam : maker_.Grow(beams_[i], rays)) {
      beams_.push_back(std::move(beam));
      push(beams_.size() - 1);
      ++followers_[i].count;
    }
    followers_.resize(beams_.size());
  }
  fine_ = MakeLevel(queue, total);
  if (coarse) coarse_ = fine_;
}

ChainLights::Level ChainLights::MakeLevel(std::vector<std::size_t> open, double total) const {
  Level level;
  level.tree = LineTree(beams_);
  std::sort(open.begin(), open.end());
  double left = 0;
  for (const std::size_t i : open) {
    left += beams_[i].flux;
    level.open.push_back({i, left});
  }
  if (left == 0) return level;
  level.open_share = left / total;
  // The chance weighs the time that tries take against their noise: both are then small where little is left.
  level.chance = std::min(kMostChance, 0.5 * level.open_share);
  return level;
}

void ChainLights::AddFrom(const Beam& beam, const SurfacePoint& at, Vector2 normal, double& rays,
                          std::vector<Found>& found) const {
  const Bernstein left = beam.lines.LeftOf(at.position);
  const double tolerance = LineFit().tolerance;
  if (left.Min() > tolerance || left.Max() < -tolerance) return;
  const Bernstein::RootList roots = left.Roots();
  if (roots.count == 0) return;
  const Element& last = scene_.element(beam.chain->links.back().element);
  const bool own = at.element != ElementId::kNone && scene_.element(at.element).carrier == last.carrier;
  if (own && last.kind == Element::Kind::kSegment) return;
  std::vector<SurfacePoint> places;
  for (std::size_t i = 0; i < roots.count; ++i) {
    // One step of Newton's from where the fit has its root, and everything there.
    double u = beam.lines.At(roots.t[i]);
    std::optional<ChainRays<2>> light = FollowChain<2>(scene_, *beam.chain, u, nullptr);
    if (!light) continue;
    const VectorSeries<2> place = VectorSeries<2>::Constant(at.position - Point2{});
    const Series<2> first_miss = Cross(light->ray.direction, place - light->ray.from);
    if (Dot(light->ray.direction, place - light->ray.from)[0] <= 0 || first_miss[1] == 0) continue;
    if (!(-Dot(normal, light->ray.direction.Value()) > -1e-6)) continue;
    u = std::clamp(u - first_miss[0] / first_miss[1], beam.lines.begin, beam.lines.end);
    places.clear();
    light = FollowChain<2>(scene_, *beam.chain, u, &places);
    if (!light) continue;
    const VectorSeries<2> way = place - light->ray.from;
    const Vector2 direction = light->ray.direction.Value();
    if (!(Dot(light->ray.direction, way)[0] > (own ? kOwnPlace : 0))) continue;
    IncidentLight incident;
    incident.direction = -direction;
    incident.cosine = Dot(normal, incident.direction);
    const double spread = std::abs(Cross(light->ray.direction, way)[1]);
    if (!(incident.cosine > 0) || !(spread > 0) || !(light->flux[0] > 0)) continue;
    if (!Unblocked(*beam.chain, places, at, rays)) continue;
    incident.irradiance = light->flux[0] / spread * light->colour;
    const double to_border = std::min(u - beam.lines.begin, beam.lines.end - u);
    // Every link adds its overlap.
    const double overlap = static_cast<double>(2 * beam.links() + 4) * LineFamily::kOverlap;
    found.push_back({{incident, beam.chain, u, 1}, to_border <= overlap});
  }
}

bool ChainLights::SameCurves(const Chain& chain, const Chain& other) const {
  if (chain.light != other.light || chain.links.size() != other.links.size()) return false;
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    if (chain.links[i].crosses != other.links[i].crosses) return false;
    if (scene_.element(chain.links[i].element).curve != scene_.element(other.links[i].element).curve) return false;
  }
  return true;
}

void ChainLights::AddOnce(const std::vector<Found>& all, double factor, std::vector<ChainedLight>& found) const {
  constexpr double kSameDirection = 1e-9;
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool again = false;
    for (std::size_t k = 0; k < i && all[i].at_border && !again; ++k) {
      again = all[k].at_border && Length(all[i].way.light.direction - all[k].way.light.direction) < kSameDirection &&
              SameCurves(*all[i].way.chain, *all[k].way.chain);
    }
    if (again) continue;
    found.push_back(all[i].way);
    found.back().light.irradiance = factor * found.back().light.irradiance;
    found.back().factor = factor;
  }
}

bool ChainLights::Unblocked(const Chain& chain, const std::vector<SurfacePoint>& places, const SurfacePoint& at,
                            double& rays) const {
  for (std::size_t i = 0; i < places.size(); ++i) {
    ++rays;
    if (!caster_.Visible(places[i], i + 1 < places.size() ? places[i + 1] : at)) return false;
  }
  ++rays;
  if (const auto* point = std::get_if<PointLight>(&chain.light->kind))
    return caster_.Visible({point->position, ElementId::kNone}, places[0]);
  return !caster_.ClosestHit(places[0], -std::get<DirectionalLight>(chain.light->kind).direction).has_value();
}

void ChainLights::AddByChance(const Level& level, const SurfacePoint& at, Vector2 normal, std::uint32_t most_links,
                              double u, double& rays, std::vector<ChainedLight>& found) const {
  auto key = static_cast<std::uint64_t>(u * 0x1p53);
  const double left = level.open.back().flux_end;
  const auto open = std::upper_bound(level.open.begin(), level.open.end() - 1, Number(key) * left,
                                     [](double target, const Open& o) { return target < o.flux_end; });
  const Beam* beam = &beams_[open->beam];
  double factor = left / (beam->flux * level.chance);
  std::vector<Beam> grown;
  Beam own;
  std::optional<std::size_t> known = open->beam;
  for (int lossless = 0; beam->links() < most_links; ++lossless) {
    std::span<const Beam> next;
    if (known && followers_[*known].known) {
      next = std::span(beams_).subspan(followers_[*known].first, followers_[*known].count);
    } else {
      if (known && lossless > 0) {
        if (Number(key) >= kGrowChance) return;
        factor /= kGrowChance;
      }
      known.reset();
      grown = maker_.Grow(*beam, rays);
      next = grown;
    }
    double flux = 0;
    std::vector<Found> all;
    for (const Beam& b : next) {
      AddFrom(b, at, normal, rays, all);
      flux += b.flux;
    }
    AddOnce(all, factor, found);
    if (!(flux > 0)) return;
    double survival = std::min(1.0, flux / beam->flux);
    if (!known) survival *= kGrowSurvival;
    if (lossless > kMostLossless) survival *= kLosslessSurvival;
    if (Number(key) >= survival) return;
    double target = Number(key) * flux;
    std::size_t chosen = 0;
    while (chosen + 1 < next.size() && target >= next[chosen].flux) target -= next[chosen++].flux;
    factor *= flux / (next[chosen].flux * survival);
    if (known) {
      known = followers_[*known].first + chosen;
      beam = &beams_[*known];
    } else {
      own = std::move(grown[chosen]);
      beam = &own;
    }
  }
}

Series<4> ChainLights::AlongReceiver(const ChainedLight& way, const Receiver& receiver) const {
  const std::optional<ChainRays<4>> light = FollowChain<4>(scene_, *way.chain, way.u, nullptr);
  if (!light) return {};
  // Where each ray meets the receiver, as a series s in u: Newton's method doubles the terms that are right. The
  // receiver to third order. Flux du is spread over ds.
  const double kappa = receiver.curvature;
  const VectorSeries<4> origin = VectorSeries<4>::Constant(receiver.position - Point2{});
  const VectorSeries<4> t = VectorSeries<4>::Constant(receiver.tangent);
  const VectorSeries<4> n = VectorSeries<4>::Constant(receiver.normal);
  Series<4> s;
  for (int step = 0; step < 3; ++step) {
    const Series<4> squared = s * s, cubed = squared * s;
    const VectorSeries<4> place = origin + (s - (kappa * kappa / 6) * cubed) * t +
                                  ((0.5 * kappa) * squared + (receiver.curvature_change / 6) * cubed) * n;
    const VectorSeries<4> along = (Series<4>::Constant(1) - (0.5 * kappa * kappa) * squared) * t +
                                  (kappa * s + (0.5 * receiver.curvature_change) * squared) * n;
    const Series<4> slope = Cross(light->ray.direction, along);
    if (slope[0] == 0) return {};
    s = s - Cross(light->ray.direction, place - light->ray.from) / slope;
    s[0] = 0;
  }
  const Series<4> spread = Derived(s);
  if (spread[0] == 0 || light->flux[0] == 0) return {};
  const Series<4> by_u = ((spread[0] / light->flux[0]) * light->flux) / spread;
  // From u to s: u = s/s1 - s2/s1^3 s^2.
  Series<4> by_s;
  by_s[0] = by_u[0];
  by_s[1] = by_u[1] / s[1];
  by_s[2] = by_u[2] / (s[1] * s[1]) - by_u[1] * s[2] / (s[1] * s[1] * s[1]);
  return by_s;
}

}  // namespace flatlight
