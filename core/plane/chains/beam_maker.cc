// SPDX-License-Identifier: Apache-2.0
#include "core/plane/chains/beam_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/math/trig.h"
#include "core/plane/chains/beam_cuts.h"
#include "core/plane/intersect.h"

namespace flatlight {
namespace {

// Blockers that are cut out of one stretch, one within the other; what is left then counts as free.
constexpr int kMostCuts = 24;
DirectedLine LineOf(const RaySeries<2>& ray) {
  const Vector2 direction = ray.direction.Value();
  return {direction, Cross(direction, ray.from.Value())};
}

}  // namespace

BeamMaker::BeamMaker(const RayCaster& caster) : caster_(caster), scene_(caster.scene()) {
  for (std::size_t e = 0; e < scene_.elements().size(); ++e) {
    const Curve& curve = scene_.curve(scene_.elements()[e].curve);
    if (IsSpecular(curve.material) && !curve.reflectance.IsBlack()) turning_.push_back(static_cast<ElementId>(e));
  }
}

std::vector<Beam> BeamMaker::FirstBeams(double& rays) const {
  std::vector<Beam> beams;
  for (const Light& light : scene_.lights()) {
    for (const ElementId id : turning_) {
      const Element& element = scene_.element(id);
      const Chain chain{&light, {{id, false, false}}};
      // Where an arc turns from the light, by the sine of the angle under which light meets it.
      std::array<double, Bernstein::kCount> sines{};
      for (std::size_t i = 0; i < sines.size(); ++i) {
        const double u = Bernstein::Nodes()[i];
        const std::optional<ChainRays<2>> at = FollowChainToLast<2>(scene_, chain, u);
        if (at) sines[i] = Cross(at->ray.direction.Value(), Derived(PlaceOn<2>(element, u)).Value()) / element.length;
      }
      Cuts sides(0, 1);
      sides.AddRoots({}, Bernstein::Through(sines));
      sides.VisitStretches([&](double begin, double end) {
        const auto line = [&](double u) -> std::optional<DirectedLine> {
          const std::optional<ChainRays<2>> at = FollowChainToLast<2>(scene_, chain, u);
          if (!at) return std::nullopt;
          return LineOf(at->ray);
        };
        LineFamily::Fit(
            begin, end, line, [](double, double) { return true; },
            [&](const LineFamily& lines) {
              Cuts cone(lines.begin, lines.end);
              const auto* spot = std::get_if<PointLight>(&light.kind);
              if (spot != nullptr && spot->edge_angle < std::numbers::pi) {
                for (const double angle : {-spot->edge_angle, -spot->cone_angle, spot->cone_angle, spot->edge_angle}) {
                  const SinCosValue turn = SinCos(angle);
                  cone.AddRoots(lines,
                                lines.LeftOf(spot->position + turn.cos * spot->axis + turn.sin * Left(spot->axis)));
                }
              }
              cone.VisitStretches([&](double from, double to) { Carve({chain, lines}, from, to, 0, rays, beams); });
            });
      });
    }
  }
  return beams;
}

std::vector<Beam> BeamMaker::Grow(const Beam& beam, double& rays) const {
  std::vector<Beam> beams;
  const Element& last = scene_.element(beam.chain->links.back().element);
  for (const ElementId id : turning_) {
    const Element& target = scene_.element(id);
    if (target.carrier == last.carrier && target.kind == Element::Kind::kSegment) continue;
    if (!PassBy(beam.lines, target)) Meet(beam, id, rays, beams);
  }
  return beams;
}

void BeamMaker::Meet(const Beam& beam, ElementId id, double& rays, std::vector<Beam>& beams) const {
  const Element& target = scene_.element(id);
  const Element& last = scene_.element(beam.chain->links.back().element);
  Cuts cuts(beam.lines.begin, beam.lines.end);
  cuts.AddEndsOf(target, beam.lines);
  const ElementCrossings common = CrossElements(target, last, scene_.touch_distance());
  for (int i = 0; i < common.count; ++i) cuts.AddRoots(beam.lines, beam.lines.LeftOf(common.point[i]));
  cuts.VisitStretches([&](double begin, double end) {
    const std::optional<ChainRays<2>> at = FollowChain<2>(scene_, *beam.chain, 0.5 * (begin + end), nullptr);
    if (!at) return;
    const Point2 from = Point2{} + at->ray.from.Value();
    const Vector2 direction = at->ray.direction.Value();
    const bool own = target.carrier == last.carrier;
    const Crossings crossings = target.kind == Element::Kind::kSegment ? CrossSegment(target, from, direction, 0)
                                : own                                  ? CrossOwnCircle(target, from, direction, 0)
                                                                       : CrossArc(target, from, direction, 0);
    for (int i = 0; i < crossings.count; ++i) {
      if (!(crossings.t[i] > 0)) continue;
      Approach approach{*beam.chain, beam.lines};
      const bool far = target.kind == Element::Kind::kArc && crossings.t[i] > Dot(target.center - from, direction);
      approach.chain.links.push_back({id, far, false});
      Carve(approach, begin, end, 0, rays, beams);
    }
  });
}

ElementId BeamMaker::BlockerOf(const Chain& chain, double u, double& rays) const {
  // A hit this close to the target is the target, or touches it.
  constexpr double kAlmost = 1 - 1e-12;
  // Of an arc's two crossings, which merge where a ray touches it, the first blocks the second.
  constexpr double kApart = 1 - 1e-6;
  const std::optional<ChainRays<2>> at = FollowChainToLast<2>(scene_, chain, u);
  if (!at) return ElementId::kNone;
  const ElementId target = chain.links.back().element;
  const Vector2 direction = at->ray.direction.Value();
  SurfacePoint from{Point2{} + at->ray.from.Value(), ElementId::kNone};
  double distance = 0;
  Vector2 along = direction;
  if (chain.links.size() == 1) {
    // Backward, to the light.
    const Point2 place = Point2{} + PlaceOn<2>(scene_.element(target), u).Value();
    distance = std::holds_alternative<PointLight>(chain.light->kind) ? Length(place - from.position) : HUGE_VAL;
    from = {place, target};
    along = -direction;
  } else {
    const ChainLink& before = chain.links[chain.links.size() - 2];
    from.element = before.element;
    const Element& element = scene_.element(target);
    const std::optional<Series<2>> to =
        DistanceTo(element, at->ray, chain.links.back().far, element.carrier == scene_.element(before.element).carrier);
    if (!to) return ElementId::kNone;
    distance = (*to)[0];
  }
  ++rays;
  const std::optional<Hit> hit = caster_.ClosestHit(from, along);
  if (!hit || !(hit->distance < kAlmost * distance)) return ElementId::kNone;
  if (chain.links.size() > 1 && hit->element == target && !(hit->distance < kApart * distance)) return ElementId::kNone;
  return hit->element;
}

void BeamMaker::Carve(const Approach& approach, double begin, double end, int depth, double& rays,
                      std::vector<Beam>& beams) const {
  const double middle = 0.5 * (begin + end);
  const ElementId blocker = depth < kMostCuts ? BlockerOf(approach.chain, middle, rays) : ElementId::kNone;
  if (blocker == ElementId::kNone) return AddBeams(approach.chain, begin, end, beams);
  Cuts cuts(begin, end);
  const Element& element = scene_.element(blocker);
  cuts.AddEndsOf(element, approach.lines);
  const std::vector<ChainLink>& links = approach.chain.links;
  for (std::size_t i = links.size() - std::min<std::size_t>(links.size(), 2); i < links.size(); ++i) {
    if (links[i].element == blocker) continue;
    const ElementCrossings common = CrossElements(element, scene_.element(links[i].element), scene_.touch_distance());
    for (int k = 0; k < common.count; ++k) cuts.AddRoots(approach.lines, approach.lines.LeftOf(common.point[k]));
  }
  cuts.VisitStretches([&](double from, double to) {
    if (middle >= from && middle <= to) return;
    Carve(approach, from, to, depth + 1, rays, beams);
  });
}

void BeamMaker::AddBeams(const Chain& incoming, double begin, double end, std::vector<Beam>& beams) const {
  const Curve& curve = scene_.curve_of(incoming.links.back().element);
  for (const bool crosses : {false, true}) {
    if (crosses && !std::holds_alternative<Dielectric>(curve.material)) continue;
    auto chain = std::make_shared<Chain>(incoming);
    chain->links.back().crosses = crosses;
    const auto line = [&](double u) -> std::optional<DirectedLine> {
      const std::optional<ChainRays<2>> at = FollowChain<2>(scene_, *chain, u, nullptr);
      if (!at) return std::nullopt;
      return LineOf(at->ray);
    };
    // Whether some ray of the stretch may not be reflected totally.
    const auto hopeful = [&](double from, double to) {
      if (!crosses) return true;
      std::array<double, Bernstein::kCount> squares{};
      for (std::size_t i = 0; i < squares.size(); ++i) {
        const double u = from + Bernstein::Nodes()[i] * (to - from);
        const std::optional<double> square = SquaredCosineBehind(*chain, u);
        if (!square) return true;
        squares[i] = *square;
      }
      return Bernstein::Through(squares).Max() > 0;
    };
    LineFamily::Fit(begin, end, line, hopeful, [&](const LineFamily& lines) {
      Beam beam{chain, lines, 0};
      for (const double t : Bernstein::Nodes()) {
        const std::optional<ChainRays<2>> at = FollowChain<2>(scene_, *chain, lines.At(t), nullptr);
        if (at) beam.flux += (lines.end - lines.begin) / Bernstein::kCount * at->flux[0] * at->colour.Max();
      }
      if (beam.flux > 0) beams.push_back(std::move(beam));
    });
  }
}

std::optional<double> BeamMaker::SquaredCosineBehind(const Chain& chain, double u) const {
  const std::optional<ChainRays<2>> at = FollowChainToLast<2>(scene_, chain, u);
  if (!at) return std::nullopt;
  const std::vector<ChainLink>& links = chain.links;
  const Element& element = scene_.element(links.back().element);
  VectorSeries<2> place = at->ray.from;
  if (links.size() == 1) {
    place = PlaceOn<2>(element, u);
  } else {
    const bool own = element.carrier == scene_.element(links[links.size() - 2].element).carrier;
    const std::optional<Series<2>> distance = DistanceTo(element, at->ray, links.back().far, own);
    if (!distance) return std::nullopt;
    place = place + *distance * at->ray.direction;
  }
  const Vector2 normal = FrontOn(element, place).Value();
  const Vector2 direction = at->ray.direction.Value();
  const double ior = std::get<Dielectric>(scene_.curve(element.curve).material).ior;
  const double sine = Cross(normal, direction) / (Dot(normal, direction) < 0 ? ior : 1 / ior);
  return (1 - sine) * (1 + sine);
}

}  // namespace flatlight
