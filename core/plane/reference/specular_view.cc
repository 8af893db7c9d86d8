// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/specular_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "core/math/trig.h"
#include "core/plane/chains/beam_cuts.h"
#include "core/plane/chains/chain.h"
#include "core/plane/chains/ray_series.h"
#include "core/plane/intersect.h"
#include "core/plane/reference/index_growth.h"

namespace flatlight {
namespace {

// Of directions and moments, beside the least share; and the best.
constexpr double kFit = 0.1, kBestFit = 1e-11, kWorstFit = 1e-6;
// A stretch is eased if so near to its ends, as part of it, a squared cosine is less than that.
constexpr double kBeside = 1e-6, kGrazing = 1e-4;
// Numbers of directions differ by no more, for whatever reason.
constexpr double kMostShift = 0.5;
// A polynomial's root, and the place where total reflection begins.
constexpr double kRootWithin = 1e-3;

bool Reflects(const Curve& curve) { return !curve.reflectance.IsBlack(); }

// How far a ray goes to the element's line or circle, as DistanceTo has it.
std::optional<double> Distance(const Element& element, Point2 from, Vector2 direction, bool far, bool own_circle) {
  const Vector2 q = from - element.a;
  if (element.kind == Element::Kind::kSegment) {
    const Vector2 along = element.b - element.a;
    const double denominator = Cross(direction, along);
    if (denominator == 0) return std::nullopt;
    return -Cross(q, along) / denominator;
  }
  const double bend = 1 / element.radius;
  const double b = Dot(direction, element.radial_a + bend * q);
  if (own_circle) return -2 * element.radius * b;
  const double c = Dot(q, element.radial_a) + 0.5 * bend * Dot(q, q);
  const double discriminant = b * b - 2 * bend * c;
  if (!(discriminant > 0)) return std::nullopt;
  const double root = std::sqrt(discriminant);
  if (b < 0) return far ? (root - b) * element.radius : 2 * c / (root - b);
  return far ? -2 * c / (root + b) : -(root + b) * element.radius;
}

// Unit normal of the front at a place on the circle, which is there to rounding.
Vector2 FrontAt(const Element& arc, Point2 place) {
  const Vector2 outward = arc.radial_a + (1 / arc.radius) * (place - arc.a);
  return (-arc.Orientation() * (1.5 - 0.5 * Dot(outward, outward))) * outward;
}

// As TurnAt does it.
bool Turn(const SpecularWay::Turning& turning, SpecularRay& ray) {
  const Element& element = *turning.element;
  Vector2 normal = turning.span                              ? turning.span->FrontAt(ray.place)
                   : element.kind == Element::Kind::kSegment ? turning.front
                                                             : FrontAt(element, ray.from);
  double cosine = -Dot(normal, ray.direction);
  const bool front = cosine > 0;
  if (!front) normal = -normal, cosine = -cosine;
  if (turning.glass) {
    const double ratio = front ? turning.ior : turning.inverse_ior;
    const Vector2 tangent{normal.y, -normal.x};
    const double sine = (front ? turning.inverse_ior : turning.ior) * Dot(tangent, ray.direction);
    const double square = 1 - sine * sine;
    if (square > 0) {
      const double behind = std::sqrt(square);
      const double parallel = (ratio * cosine - behind) / (ratio * cosine + behind);
      const double perpendicular = (cosine - ratio * behind) / (cosine + ratio * behind);
      const double reflected = 0.5 * (parallel * parallel + perpendicular * perpendicular);
      if (turning.crosses) {
        ray.direction = sine * tangent - behind * normal;
        ray.share *= 1 - reflected;
        return true;
      }
      ray.share *= reflected;
    }
  }
  if (turning.crosses) return false;
  ray.direction = ray.direction + (2 * cosine) * normal;
  return true;
}

bool IsOwnCircle(const Scene& scene, ElementId last, const Element& element) {
  return element.kind == Element::Kind::kArc && last != ElementId::kNone &&
         scene.element(last).carrier == element.carrier;
}

Vector2 FrontOf(const Element& segment) {
  const Vector2 along = segment.b - segment.a;
  return Left(along / Length(along));
}

// Irradiance of radiance 1 that comes from between two directions.
double SinesBetween(double from, double to) { return std::max(SinCos(to).sin - SinCos(from).sin, 0.0); }

}  // namespace

double IndexRatio(const Material& material, Side side) {
  const auto* border = std::get_if<Dielectric>(&material);
  return border == nullptr ? 1 : side == Side::kFront ? border->ior : 1 / border->ior;
}

bool ComesFromCircle(const Scene& scene, const Receiver& receiver, const SpecularWay& way, ElementId element) {
  return IsOwnCircle(scene, LastOf(receiver, way), scene.element(element));
}

ElementId LastOf(const Receiver& receiver, const SpecularWay& way) {
  return way.links.empty() ? receiver.element : way.links.back().element;
}

bool TurnsAt(const Scene& scene, ElementId element) {
  const Curve& curve = scene.curve_of(element);
  return IsSpecular(curve.material) && Reflects(curve);
}

double Directions::Indistinct(double x) const {
  const double theta = At(x), slope = Slope(x);
  double shift = slope > 0 ? std::min(kSameDirection / slope, kMostShift) : kMostShift;
  // Where the slope is all but none, it is larger beside.
  while (std::abs(At(x + shift) - theta) > kSameDirection || std::abs(At(x - shift) - theta) > kSameDirection)
    shift *= 0.5;
  return shift;
}

std::optional<SpecularRay> FollowWay(const Scene& scene, const SpecularWay& way, double theta) {
  const SinCosValue turn = SinCos(theta);
  SpecularRay ray{way.image, turn.sin * way.tangent + turn.cos * way.normal, 1};
  const std::size_t plane = way.links.size() - way.turnings.size();
  if (plane > 0) {
    const auto distance = Distance(scene.element(way.links[plane - 1].element), ray.from, ray.direction, false, false);
    if (!distance) return std::nullopt;
    ray.from = ray.from + *distance * ray.direction;
  }
  for (const SpecularWay::Turning& turning : way.turnings) {
    if (turning.span != nullptr) {
      const std::optional<double> place = turning.span->Meet(ray.from, ray.direction, turning.front_side);
      if (!place) return std::nullopt;
      ray.place = *place;
      ray.from = turning.span->At(*place);
      if (!Turn(turning, ray)) return std::nullopt;
      continue;
    }
    const auto distance = Distance(*turning.element, ray.from, ray.direction, turning.far, turning.own_circle);
    if (!distance) return std::nullopt;
    ray.from = ray.from + *distance * ray.direction;
    if (!Turn(turning, ray)) return std::nullopt;
  }
  ray.share *= way.compression;
  return ray;
}

std::optional<double> DistanceBehind(const Scene& scene, const Receiver& receiver, const SpecularWay& way,
                                     const SpecularRay& ray, ElementId element, bool far) {
  const bool own_circle = ComesFromCircle(scene, receiver, way, element);
  return Distance(scene.element(element), ray.from, ray.direction, far, own_circle);
}

std::size_t BytesOf(const SpecularPiece& piece) {
  return sizeof(SpecularPiece) + sizeof(SpecularWay) + sizeof(Directions) + 2 * sizeof(MovingEnd) +
         piece.way->links.size() * sizeof(ChainLink) + piece.way->turnings.size() * sizeof(SpecularWay::Turning);
}

std::size_t SpecularSight::bytes() const {
  std::size_t bytes = 0;
  for (const SpecularPiece& piece : pieces) bytes += BytesOf(piece);
  return bytes + unfollowed.size() *
                     (sizeof(UnfollowedBeam) + sizeof(SpecularWay) + sizeof(Directions) + 2 * sizeof(MovingEnd));
}

bool HasSpecular(const Scene& scene) {
  return std::any_of(scene.curves().begin(), scene.curves().end(),
                     [](const Curve& curve) { return IsSpecular(curve.material) && Reflects(curve); });
}

bool CanFollow(const Scene& scene) {
  if (scene.traits().lambertian) return true;
  if (!scene.lights().empty()) return false;
  return std::all_of(scene.curves().begin(), scene.curves().end(), [](const Curve& curve) {
    return !Reflects(curve) || IsSpecular(curve.material) || std::holds_alternative<Lambertian>(curve.material);
  });
}

SpecularView::SpecularView(const RayCaster& caster, const SpecularViewOptions& options)
    : caster_(caster),
      scene_(caster.scene()),
      options_(options),
      spans_(std::make_shared<BezierSpans>(scene_)),
      growth_(IndexGrowth(scene_)) {
  const std::vector<Element>& elements = scene_.elements();
  for (std::size_t i = 0; i < elements.size(); ++i) {
    for (std::size_t j = i + 1; j < elements.size(); ++j) {
      const Element &e = elements[i], &f = elements[j];
      const double reach = e.length + f.length;
      if (e.carrier == f.carrier || LengthSquared(e.a - f.a) > reach * reach) continue;
      const ElementCrossings crossings = CrossElements(e, f, scene_.touch_distance());
      for (int k = 0; k < crossings.count; ++k) crossings_.push_back(crossings.point[k]);
    }
  }
}

const std::vector<SpecularPiece>& SpecularView::From(const Receiver& receiver) {
  pieces_.clear();
  unfollowed_.clear();
  lost_ = 0;
  numbers_ = 0;
  const auto way = std::make_shared<SpecularWay>();
  way->image = receiver.position + receiver.offset;
  way->spans = spans_;
  way->tangent = receiver.tangent;
  way->normal = receiver.normal;
  const auto directions =
      std::make_shared<const Directions>(Directions{-0.5 * std::numbers::pi, 0.5 * std::numbers::pi, false, nullptr});
  Fan(
      way, directions, {0, 1, nullptr, nullptr}, 1, [](double, double) { return true; }, LineFit{});
  std::size_t grown = 0;
  while (!beams_.empty()) {
    const Beam beam = beams_.top();
    beams_.pop();
    if (beam.weight < options_.least_share || grown >= options_.most_ways) {
      lost_ += beam.weight;
      unfollowed_.push_back(
          {beam.directions, beam.begin, beam.end, beam.begins, beam.ends, beam.share * beam.way->tint.Max()});
      continue;
    }
    ++grown;
    Grow(receiver, beam);
  }
  lost_ *= growth_;
  for (UnfollowedBeam& beam : unfollowed_) beam.share *= growth_;
  return pieces_;
}

template <typename Hopeful>
void SpecularView::Fan(const std::shared_ptr<const SpecularWay>& way,
                       const std::shared_ptr<const Directions>& directions, const Stretch& stretch, double worth,
                       const Hopeful& hopeful, const LineFit& fit) {
  const auto line = [&](double x) -> std::optional<DirectedLine> {
    const std::optional<SpecularRay> ray = FollowWay(scene_, *way, directions->At(x));
    if (!ray) return std::nullopt;
    return DirectedLine{ray->direction, Cross(ray->direction, ray->from - Point2{})};
  };
  std::shared_ptr<const MovingEnd> between;
  if (stretch.begins || stretch.ends) {
    between = std::make_shared<const MovingEnd>(
        MovingEnd{.way = nullptr,
                  .mark = {},
                  .between = MovingEnd::Between{stretch.begin, stretch.end, stretch.begins, stretch.ends}});
  }
  LineFamily::Fit(
      stretch.begin, stretch.end, line, hopeful,
      [&](const LineFamily& lines) {
        const double begin = lines.begin + LineFamily::kOverlap, end = lines.end - LineFamily::kOverlap;
        Push({.way = way,
              .directions = directions,
              .lines = lines,
              .begin = begin,
              .end = end,
              .begins = begin <= stretch.begin + LineFamily::kOverlap ? stretch.begins : between,
              .ends = end >= stretch.end - LineFamily::kOverlap ? stretch.ends : between});
      },
      [&](double low, double high) {
        const double begin = std::max(low, stretch.begin), end = std::min(high, stretch.end);
        lost_ += worth * SinesBetween(directions->At(begin), directions->At(end));
        unfollowed_.push_back({directions, begin, end, begin == stretch.begin ? stretch.begins : between,
                               end == stretch.end ? stretch.ends : between, worth});
      },
      fit);
}

void SpecularView::Push(Beam beam) {
  double most = 0;
  for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const std::optional<SpecularRay> ray =
        FollowWay(scene_, *beam.way, beam.directions->At(beam.begin + t * (beam.end - beam.begin)));
    if (ray) most = std::max(most, ray->share);
  }
  const double sines = SinesBetween(beam.directions->At(beam.begin), beam.directions->At(beam.end));
  beam.share = most;
  beam.weight = most * beam.way->tint.Max() * sines;
  beam.number = numbers_++;
  if (beam.weight > 0) beams_.push(std::move(beam));
}

void SpecularView::Grow(const Receiver& receiver, const Beam& beam) {
  Cuts cuts(beam.begin, beam.end);
  FindCuts(receiver, beam, cuts);
  std::optional<Met> met;
  Cuts::Cut begin{beam.begin, {}}, end = begin;
  const auto moving = [&](const Cuts::Cut& cut) -> std::shared_ptr<const MovingEnd> {
    if (cut.mark) return std::make_shared<const MovingEnd>(MovingEnd{.way = beam.way, .mark = *cut.mark});
    if (cut.at == beam.begin) return beam.begins;
    // Events of Béziers have no mark.
    return cut.at == beam.end ? beam.ends : nullptr;
  };
  const auto finish = [&] {
    if (!met || !(end.at > begin.at)) return;
    if (met->doubtful) {
      lost_ += MostOf(beam, begin.at, end.at);
    } else {
      Meet(receiver, beam, *met, {begin.at, end.at, moving(begin), moving(end)});
    }
  };
  const bool follows = scene_.bezier_distance() > 0;
  cuts.VisitCuts([&](const Cuts::Cut& from, const Cuts::Cut& to) {
    std::optional<Met> next;
    if (follows && !beam.way->links.empty() && IsNarrow(beam, from.at, to.at)) {
      next = Met{.doubtful = true};
    } else {
      next = MetBy(receiver, beam, 0.5 * (from.at + to.at));
    }
    if (next != met) {
      finish();
      if (follows && met && next) lost_ += DoubtAt(receiver, beam, *met, *next, from.at);
      met = next;
      begin = from;
    }
    end = to;
  });
  finish();
}

double SpecularView::MostOf(const Beam& beam, double begin, double end) const {
  return SinesBetween(beam.directions->At(begin), beam.directions->At(end)) * beam.share * beam.way->tint.Max();
}

void SpecularView::Meet(const Receiver& receiver, const Beam& beam, const Met& met, const Stretch& stretch) {
  const double begin = stretch.begin, end = stretch.end;
  const bool direct = beam.way->links.empty();
  const auto add = [&] {
    if (direct) return;
    pieces_.push_back({beam.way, met.element, met.side, met.far, beam.directions, beam.lines, begin, end,
                       stretch.begins, stretch.ends});
  };
  if (met.element == ElementId::kNone) {
    if (scene_.traits().environment) add();
    return;
  }
  const Curve& curve = scene_.curve_of(met.element);
  const bool specular = IsSpecular(curve.material);
  if (!curve.EmittedRadiance(met.side).IsBlack() || (Reflects(curve) && !specular)) add();
  if (!specular || !Reflects(curve)) return;
  if (!std::holds_alternative<Dielectric>(curve.material)) return Turn(receiver, beam, met, false, stretch);
  // Where total reflection begins.
  std::vector<double> cuts(1, begin);
  if (const auto squares = SquaresBehind(receiver, beam, met, begin, end)) {
    const Bernstein::RootList roots = Bernstein::Through(*squares).Roots();
    const auto crosses = [&](double x) { return SquaredCosine(receiver, beam, met, true, x).value_or(-1) > 0; };
    for (std::size_t i = 0; i < roots.count; ++i) {
      double low = begin + std::max(roots.t[i] - kRootWithin, 0.0) * (end - begin);
      double high = begin + std::min(roots.t[i] + kRootWithin, 1.0) * (end - begin);
      if (low < cuts.back() || crosses(low) == crosses(high)) continue;
      const bool at_low = crosses(low);
      for (double middle; low < (middle = 0.5 * (low + high)) && middle < high;)
        (crosses(middle) == at_low ? low : high) = middle;
      cuts.push_back(low);
    }
  }
  cuts.push_back(end);
  std::shared_ptr<const MovingEnd> begins = stretch.begins;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    std::shared_ptr<const MovingEnd> ends = stretch.ends;
    if (i + 2 < cuts.size()) {
      ends = std::make_shared<const MovingEnd>(
          MovingEnd{.way = beam.way, .mark = {}, .border = met.element, .side = met.side, .far = met.far});
    }
    const Stretch part{cuts[i], cuts[i + 1], begins, ends};
    begins = ends;
    Turn(receiver, beam, met, false, part);
    Turn(receiver, beam, met, true, part);
  }
}

std::optional<double> SpecularView::SquaredCosine(const Receiver& receiver, const Beam& beam, const Met& met,
                                                  bool behind, double x) const {
  const std::optional<SpecularRay> ray = FollowWay(scene_, *beam.way, beam.directions->At(x));
  if (!ray) return std::nullopt;
  const Element& element = scene_.element(met.element);
  Vector2 front;
  if (const BezierSpan* const span = spans_->Of(met.element)) {
    const std::optional<double> place = span->Meet(ray->from, ray->direction, met.side == Side::kFront);
    if (!place) return std::nullopt;
    front = span->FrontAt(*place);
  } else {
    const std::optional<double> distance = DistanceBehind(scene_, receiver, *beam.way, *ray, met.element, met.far);
    if (!distance) return std::nullopt;
    front = element.kind == Element::Kind::kSegment ? FrontOf(element)
                                                    : FrontAt(element, ray->from + *distance * ray->direction);
  }
  const double sine =
      Cross(front, ray->direction) / (behind ? IndexRatio(scene_.curve(element.curve).material, met.side) : 1);
  return (1 - sine) * (1 + sine);
}

std::optional<std::array<double, Bernstein::kCount>> SpecularView::SquaresBehind(const Receiver& receiver,
                                                                                 const Beam& beam, const Met& met,
                                                                                 double from, double to) const {
  std::array<double, Bernstein::kCount> squares{};
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const double x = from + Bernstein::Nodes()[i] * (to - from);
    const std::optional<double> square = SquaredCosine(receiver, beam, met, true, x);
    if (!square) return std::nullopt;
    squares[i] = *square;
  }
  return squares;
}

void SpecularView::Turn(const Receiver& receiver, const Beam& beam, const Met& met, bool crosses,
                        const Stretch& stretch) {
  const double begin = stretch.begin, end = stretch.end;
  const Element& element = scene_.element(met.element);
  const Curve& curve = scene_.curve(element.curve);
  const double ratio = IndexRatio(curve.material, met.side);
  const double worth = beam.share * beam.way->tint.Max() * (crosses ? std::max(1.0, 1 / ratio) : 1);
  const double most = SinesBetween(beam.directions->At(begin), beam.directions->At(end)) * worth;
  if (most < options_.least_share) {
    lost_ += most;
    unfollowed_.push_back({beam.directions, begin, end, stretch.begins, stretch.ends, worth});
    return;
  }
  auto way = std::make_shared<SpecularWay>(*beam.way);
  way->links.push_back({met.element, met.far, crosses});
  const BezierSpan* const span = spans_->Of(met.element);
  const bool plane_mirror =
      span == nullptr && element.kind == Element::Kind::kSegment && std::holds_alternative<Mirror>(curve.material);
  const Vector2 front = element.kind == Element::Kind::kSegment ? FrontOf(element) : Vector2{};
  way->straight &= plane_mirror;
  if (way->straight) {
    const auto reflected = [&](Vector2 v) { return v - (2 * Dot(front, v)) * front; };
    way->image = element.a + reflected(way->image - element.a);
    way->tangent = reflected(way->tangent), way->normal = reflected(way->normal);
  } else {
    const auto* glass = std::get_if<Dielectric>(&curve.material);
    const double ior = glass ? glass->ior : 1;
    way->turnings.push_back({&element, span, met.side == Side::kFront, front, ior, 1 / ior, glass != nullptr, met.far,
                             crosses, IsOwnCircle(scene_, LastOf(receiver, *beam.way), element)});
  }
  if (crosses) {
    way->compression /= ratio;
  } else {
    way->tint = way->tint * curve.reflectance;
  }
  const std::shared_ptr<const SpecularWay> shared = way;
  if (plane_mirror) {
    Push({.way = shared,
          .directions = beam.directions,
          .lines = beam.lines.Reflected(element.a, front),
          .begin = begin,
          .end = end,
          .begins = stretch.begins,
          .ends = stretch.ends});
    return;
  }
  // Whether what follows moves as a root there.
  const auto bends = [&](double x) {
    return SquaredCosine(receiver, beam, met, false, x).value_or(0) < kGrazing ||
           std::abs(SquaredCosine(receiver, beam, met, true, x).value_or(0)) < kGrazing;
  };
  const double beside = kBeside * (end - begin);
  const bool eased = bends(begin + beside) || bends(end - beside);
  const std::shared_ptr<const Directions> directions =
      eased ? std::make_shared<const Directions>(
                  Directions{begin, end, true, beam.directions, stretch.begins, stretch.ends})
            : beam.directions;
  // Whether some ray of the stretch may not be reflected totally.
  bool some_fail = false;
  const auto hopeful = [&](double from, double to) {
    some_fail = true;
    if (!crosses) return true;
    const auto outward = [&](double x) { return eased ? directions->Outward(x) : x; };
    const auto squares = SquaresBehind(receiver, beam, met, outward(from), outward(to));
    return !squares || Bernstein::Through(*squares).Max() > 0;
  };
  LineFit fit;
  // What carries little need not be known that well.
  fit.tolerance = std::clamp(kFit * options_.least_share / (beam.share * shared->tint.Max()), kBestFit, kWorstFit);
  fit.least_part = std::min(options_.least_share / most, 1e-3);
  // Nor better than directions are.
  fit.shift = [&](double x) { return directions->Indistinct(x); };
  Fan(shared, directions, eased ? Stretch{0, 1, nullptr, nullptr} : stretch, worth, hopeful, fit);
  // What was taken as it is beside where rays begin to fail.
  if (some_fail) lost_ += 2 * fit.least_part * most;
}

}  // namespace flatlight
