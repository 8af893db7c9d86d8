// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/exact.h"

#include <algorithm>
#include <cmath>

#include "core/math/tolerances.h"
#include "core/math/trig.h"

namespace flatlight {
namespace {

// How much farther away, relative, is behind for certain.
constexpr double kBehind = 1e-6;

// What curvatures are off by, the receiver's and at a touching point, in the derivatives of an edge's sine (Derive).
void AddCurvatureErrors(const Edge& edge, const Receiver& receiver, EdgeErrors& errors) {
  if (edge.kind == Edge::Kind::kHorizon) return;
  const double c = std::abs(edge.c), s = std::abs(edge.s), error = receiver.curvature_error;
  const double turning = std::abs(receiver.curvature - edge.c * edge.q);
  errors.s_first += c * error;
  errors.s_second += c * (receiver.curvature_change_error + s * edge.q * error) + s * (2 * turning + error) * error;
  const double cq = c * edge.q;
  errors.s_second += cq * cq * cq * edge.radius_error;
}

// Adds up light while a ray turns from horizon to horizon.
template <int kChannels>
class LightSum {
 public:
  LightSum(const Scene& scene, const ExactOptions& options, const Receiver& receiver, ExactValue& value)
      : scene_(scene),
        coordinate_error_(scene.coordinate_error() + receiver.displaced),
        is_true_(!scene.traits().has_beziers),
        derivatives_(receiver.half_angle > 0 ? 0 : options.derivatives),
        receiver_(receiver),
        value_(value) {}

  bool Changes(const Spectrum& after) const {
    for (int channel = 0; channel < kChannels; ++channel)
      if (after[channel] != before_[channel]) return true;
    return false;
  }

  const Spectrum& before() const { return before_; }

  // Where the next edge is to be written.
  Edge& Next() { return edges_[next_]; }

  // From the edge in Next() on there is another radiance. A stretch of one radiance counts as a whole, whatever
  // elements it is made of.
  void Turn(const Spectrum& after) { Turn(after, coordinate_error_); }
  // The same, where the edge is known to another accuracy than coordinates are.
  void Turn(const Spectrum& after, double coordinate_error) {
    Edge& edge = edges_[next_];
    if (!is_true_) {
      edge = TrueEdge(scene_, receiver_, edge);
      // Two curves cross where their elements do, to the distance of these.
      if (edge.crossing) coordinate_error += scene_.bezier_distance();
    }
    if (receiver_.half_angle > 0) return TurnByAngle(after, coordinate_error);
    const Edge& begin = edges_[1 - next_];
    edge.turn += receiver_.tilt;
    EdgeErrors errors = BoundErrors(edge, receiver_.curvature, coordinate_error, receiver_.curvature_change);
    if (!is_true_) AddCurvatureErrors(edge, receiver_, errors);
    const EdgeDerivatives derivatives =
        derivatives_ > 0 ? Derive(edge, receiver_.curvature, receiver_.curvature_change) : EdgeDerivatives{};
    const double extent = lit_ ? SineDifference(begin, edge, receiver_) : 0;
    lit_ = false;
    for (int channel = 0; channel < kChannels; ++channel) {
      const double jump = before_[channel] - after[channel];
      const double size = std::abs(jump);
      value_.irradiance[channel] += before_[channel] * extent;
      value_.irradiance_error[channel] += size * errors.s + 4 * kUnitRoundoff * before_[channel] * std::abs(extent);
      if (derivatives_ >= 1) {
        value_.gradient[channel] += jump * derivatives.s_first;
        value_.gradient_error[channel] += size * errors.s_first;
        // Of a stretch of radiance L between two directions L (c_a - c_b).
        value_.rotation[channel] -= jump * edge.c;
        value_.rotation_error[channel] += size * errors.c;
      }
      if (derivatives_ >= 2) {
        value_.hessian[channel] += jump * derivatives.s_second;
        value_.hessian_error[channel] += size * errors.s_second;
      }
      before_[channel] = after[channel];
      lit_ = lit_ || after[channel] != 0;
    }
    next_ = 1 - next_;
  }

 private:
  // Where radiance is summed up by angle, between the sides of a pixel.
  void TurnByAngle(const Spectrum& after, double coordinate_error) {
    const Edge& edge = edges_[next_];
    const double theta = std::copysign(AngleOf(std::max(0.0, edge.c), std::abs(edge.s)), edge.s);
    const double turn = edge.kind == Edge::Kind::kHorizon ? 0
                        : edge.kind == Edge::Kind::kTouch
                            ? edge.turn + 8 * kUnitRoundoff
                            : 2 * coordinate_error * edge.q + edge.turn + 8 * kUnitRoundoff;
    const double angle = std::clamp(theta, -receiver_.half_angle, receiver_.half_angle);
    const double doubt = std::abs(theta) < receiver_.half_angle + turn ? turn : 0;
    for (int channel = 0; channel < kChannels; ++channel) {
      const double light = before_[channel] * (angle - angle_);
      value_.irradiance[channel] += light;
      value_.irradiance_error[channel] +=
          std::abs(before_[channel] - after[channel]) * doubt + 4 * kUnitRoundoff * std::abs(light);
      before_[channel] = after[channel];
    }
    angle_ = angle;
    next_ = 1 - next_;
  }

  const Scene& scene_;
  const double coordinate_error_;
  const bool is_true_;  // Elements are what they stand for.
  const int derivatives_;
  const Receiver& receiver_;
  ExactValue& value_;
  Spectrum before_;
  bool lit_ = false;
  double angle_ = 0;
  Edge edges_[2];
  int next_ = 0;
};

}  // namespace

ExactSolver::ExactSolver(const Scene& scene, const Bvh& bvh, ExactOptions options, const Triangulation* triangulation)
    : scene_(scene), options_(options), gatherer_(scene, bvh), sweep_(scene), triangulation_(triangulation) {
  if (triangulation) view_.emplace(scene, *triangulation);
  brightest_ = scene.environment();
  for (const Curve& curve : scene.curves())
    for (int channel = 0; channel < kMaxChannels; ++channel)
      brightest_[channel] = std::max(brightest_[channel], curve.radiance[channel]);
  for (std::size_t e = 0; e < scene.elements().size(); ++e) {
    const ElementId id = static_cast<ElementId>(e);
    const Curve& curve = scene.curve_of(id);
    emissions_.push_back({curve.radiance[0], curve.Emits(), curve.Emits() && curve.two_sided});
    if (!options_.occlusion && curve.Emits()) {
      const Element& element = scene.element(id);
      emitters_.push_back({element.a, element.b, static_cast<std::uint32_t>(e), element.carrier});
    }
  }
}

void ExactSolver::Evaluate(const Receiver& receiver, ExactValue& value) {
  value = ExactValue();
  if (scene_.traits().emitting_curves == 0 && !scene_.traits().environment) return;
  if (options_.channels == 1) {
    Add<1>(receiver, value);
  } else {
    Add<kMaxChannels>(receiver, value);
  }
  // Rounding must not make light negative; the bound covers the difference.
  for (int channel = 0; channel < options_.channels; ++channel)
    value.irradiance[channel] = std::max(0.0, value.irradiance[channel]);
  for (int channel = options_.channels; channel < kMaxChannels; ++channel) {
    for (Spectrum* spectrum :
         {&value.irradiance, &value.gradient, &value.hessian, &value.rotation, &value.irradiance_error,
          &value.gradient_error, &value.hessian_error, &value.rotation_error}) {
      (*spectrum)[channel] = (*spectrum)[0];
    }
  }
}

template <int kChannels>
void ExactSolver::Add(const Receiver& receiver, ExactValue& value) {
  if (view_ && options_.occlusion) {
    if (AddView<kChannels>(receiver, value)) return;
    ++undecided_;
  }
  // Beside what emits, what neither emits nor hides anything leaves no edge in the sum.
  const Envelope& envelope =
      options_.occlusion ? gatherer_.Gather(receiver) : gatherer_.GatherAmong(emitters_, receiver);
  if (!envelope.doubtful()) {
    AddEnvelope<kChannels>(envelope, receiver, value);
  } else {
    const std::vector<Part>& parts = gatherer_.PartsInDoubt(receiver);
    AddIntervals<kChannels>(sweep_.Run(parts, receiver), parts, receiver, value);
  }
}

template <int kChannels>
bool ExactSolver::AddView(const Receiver& receiver, ExactValue& value) {
  LightSum<kChannels> sum(scene_, options_, receiver, value);
  const bool slits = triangulation_->has_slits();
  const bool decided = view_->Walk(receiver, [&](std::uint32_t vertex, Gate gate) {
    Spectrum after;
    if (gate == Triangulation::kNothing) {
      after = scene_.environment();
    } else if (!Triangulation::IsDark(gate)) {
      const auto element = static_cast<ElementId>(Triangulation::ElementOf(gate));
      if constexpr (kChannels == 1) {
        after[0] = emissions_[static_cast<std::size_t>(element)].first_channel;
      } else {
        after = scene_.curve_of(element).radiance;
      }
    }
    if (slits) [[unlikely]]
      AddSlit<kChannels>(vertex, receiver, value);
    if (!sum.Changes(after)) return;
    if (vertex == ViewLimit::kHorizon) {
      sum.Next() = HorizonEdge(gate == Triangulation::kHorizon ? 1 : -1);
      sum.Turn(after);
    } else {
      SetEdgeAt(vertex, receiver, sum.Next());
      sum.Turn(after, triangulation_->Uncertain(vertex) + receiver.displaced);
    }
  });
  if (!decided) value = ExactValue();
  return decided;
}

void ExactSolver::SetEdgeAt(std::uint32_t vertex, const Receiver& receiver, Edge& edge) const {
  const Point2 place = triangulation_->vertices()[vertex];
  const Vector2 to = place - receiver.position;
  SetVertexEdge(Dot(receiver.tangent, to), Dot(receiver.normal, to), place, edge);
}

template <int kChannels>
[[gnu::noinline]] void ExactSolver::AddSlit(std::uint32_t vertex, const Receiver& receiver, ExactValue& value) const {
  if (vertex == ViewLimit::kHorizon) return;
  const double slit = triangulation_->Slit(vertex);
  if (slit == 0) return;
  // Between places that are both that near to the vertex, or of an end that reaches beyond it: at most twice what one
  // place so far off changes, which the bound is twice of.
  Edge edge;
  SetEdgeAt(vertex, receiver, edge);
  const EdgeErrors errors = BoundErrors(edge, receiver.curvature, slit);
  for (int channel = 0; channel < kChannels; ++channel) {
    // Where radiance is summed up by angle, and in rotation, no cosine makes it less.
    value.irradiance_error[channel] += brightest_[channel] * (receiver.half_angle > 0 ? errors.c : errors.s);
    if (options_.derivatives >= 1) value.rotation_error[channel] += brightest_[channel] * errors.c;
    if (options_.derivatives >= 1) value.gradient_error[channel] += brightest_[channel] * errors.s_first;
    if (options_.derivatives >= 2) value.hessian_error[channel] += brightest_[channel] * errors.s_second;
  }
}

template <int kChannels>
void ExactSolver::AddEnvelope(const Envelope& envelope, const Receiver& receiver, ExactValue& value) const {
  LightSum<kChannels> sum(scene_, options_, receiver, value);
  for (std::size_t i = 0; i <= envelope.sectors().size(); ++i) {
    const Sector& sector = envelope.sectors()[i];
    Spectrum after;
    if (sector.sight == Sector::kNothing) {
      if (i < envelope.sectors().size()) after = scene_.environment();
    } else {
      const Sight& sight = envelope.SightOf(sector);
      const Emission& emission = emissions_[static_cast<std::size_t>(sight.element)];
      if (sight.front ? emission.front : emission.back) {
        if constexpr (kChannels == 1) {
          after[0] = emission.first_channel;
        } else {
          after = scene_.curve_of(sight.element).radiance;
        }
      }
    }
    if (!sum.Changes(after)) continue;
    envelope.SetEdge(sector, sum.Next());
    sum.Turn(after);
  }
}

template <int kChannels>
void ExactSolver::AddIntervals(const std::vector<VisibleInterval>& intervals, const std::vector<Part>& parts,
                               const Receiver& receiver, ExactValue& value) const {
  LightSum<kChannels> sum(scene_, options_, receiver, value);
  const auto turn_at_horizon = [&](double sine, const Spectrum& after) {
    if (!sum.Changes(after)) return;
    sum.Next() = HorizonEdge(sine);
    sum.Turn(after);
  };
  turn_at_horizon(-1, scene_.environment());
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const VisibleInterval& interval = intervals[i];
    AddUndecided<kChannels>(intervals, i, parts, receiver, value);
    Spectrum after = scene_.environment();
    if (interval.part != VisibleInterval::kNothing)
      after = scene_.curve_of(parts[static_cast<std::size_t>(interval.part)].element).EmittedRadiance(interval.side);
    if (!sum.Changes(after)) continue;
    if (IsSlit(intervals, i, parts, receiver)) {
      // As wide as it is computed to be, to the accuracy of both ends.
      const Edge &begin = interval.begin, &end = intervals[i + 1].begin;
      Spectrum most;
      for (int channel = 0; channel < kChannels; ++channel)
        most[channel] = std::max(after[channel], sum.before()[channel]);
      AddDoubt<kChannels>(begin, Length(end.point - begin.point), most, receiver, value);
      continue;
    }
    sum.Next() = interval.begin;
    sum.Turn(after);
  }
  turn_at_horizon(1, {});
  AddMeetings<kChannels>(receiver, value);
}

template <int kChannels>
void ExactSolver::AddDoubt(const Edge& edge, double wide, const Spectrum& most, const Receiver& receiver,
                           ExactValue& value) const {
  const EdgeErrors errors = BoundErrors(edge, receiver.curvature, scene_.coordinate_error() + receiver.displaced + wide,
                                        receiver.curvature_change);
  for (int channel = 0; channel < kChannels; ++channel) {
    const double size = most[channel];
    // Where radiance is summed up by angle, and in rotation, no cosine makes it less.
    value.irradiance_error[channel] += size * (receiver.half_angle > 0 ? errors.c : errors.s);
    if (options_.derivatives >= 1) value.rotation_error[channel] += size * errors.c;
    if (options_.derivatives >= 1) value.gradient_error[channel] += size * errors.s_first;
    if (options_.derivatives >= 2) value.hessian_error[channel] += size * errors.s_second;
  }
}

template <int kChannels>
void ExactSolver::AddUndecided(const std::vector<VisibleInterval>& intervals, std::size_t i,
                               const std::vector<Part>& parts, const Receiver& receiver, ExactValue& value) const {
  if (i == 0) return;
  const Edge& before = intervals[i - 1].begin;
  Edge edge = intervals[i].begin;
  // One that ends before it begins: coordinates don't tell the directions of its edges apart, and what is between them
  // is lit or not. Derivatives are those of the order that edges have just beyond the receiver.
  if (edge.key < before.key) {
    for (int channel = 0; channel < kChannels; ++channel) {
      value.irradiance_error[channel] +=
          brightest_[channel] * (receiver.half_angle > 0 ? 2 * (before.key - edge.key) : std::abs(before.s - edge.s));
      if (options_.derivatives >= 1) value.rotation_error[channel] += brightest_[channel] * std::abs(before.c - edge.c);
    }
  }
  if (edge.kind == Edge::Kind::kHorizon || edge.kind == Edge::Kind::kTouch) return;
  // Ends are known as coordinates are, however flat the angle at which curves meet there.
  edge.turn = edge.stretch = 0;
  // Two edges of one small thing, or of one gap, in an order that rounding decides.
  const double known = scene_.coordinate_error() + receiver.displaced;
  const double doubt = 2 * known * (before.q + edge.q) + 8 * kUnitRoundoff;
  if (before.kind != Edge::Kind::kHorizon && before.kind != Edge::Kind::kTouch && edge.key - before.key <= doubt &&
      std::abs(before.q - edge.q) <= kBehind * edge.q && (before.kind != edge.kind || before.point != edge.point)) {
    AddDifference<kChannels>(before, edge, receiver, value);
    AddDoubt<kChannels>(edge, 0, brightest_, receiver, value);
  }
  const std::int32_t last = intervals[i - 1].part, next = intervals[i].part;
  if (edge.kind != Edge::Kind::kVertex || last == next) return;
  if (last == VisibleInterval::kNothing || next == VisibleInterval::kNothing) return;
  const Element& e = scene_.element(parts[static_cast<std::size_t>(last)].element);
  const Element& f = scene_.element(parts[static_cast<std::size_t>(next)].element);
  const double near = 2 * scene_.touch_distance() + 8 * known;
  for (const Point2 end : {e.a, e.b})
    for (const Point2 other : {f.a, f.b})
      if (end != other && Length(end - edge.point) <= near && Length(other - edge.point) <= near)
        AddDoubt<kChannels>(edge, Length(other - end), brightest_, receiver, value);
}

template <int kChannels>
void ExactSolver::AddDifference(const Edge& a, const Edge& b, const Receiver& receiver, ExactValue& value) const {
  const EdgeDerivatives at_a = Derive(a, receiver.curvature, receiver.curvature_change);
  const EdgeDerivatives at_b = Derive(b, receiver.curvature, receiver.curvature_change);
  for (int channel = 0; channel < kChannels; ++channel) {
    const double size = brightest_[channel];
    // An angle is at most twice the difference of its keys.
    value.irradiance_error[channel] += size * std::abs(receiver.half_angle > 0 ? 2 * (a.key - b.key) : a.s - b.s);
    if (options_.derivatives >= 1) value.rotation_error[channel] += size * std::abs(a.c - b.c);
    if (options_.derivatives >= 1) value.gradient_error[channel] += size * std::abs(at_a.s_first - at_b.s_first);
    if (options_.derivatives >= 2) value.hessian_error[channel] += size * std::abs(at_a.s_second - at_b.s_second);
  }
}

bool ExactSolver::IsSlit(const std::vector<VisibleInterval>& intervals, std::size_t i, const std::vector<Part>& parts,
                         const Receiver& receiver) const {
  // Between the ends of two things, and behind both.
  if (i == 0 || i + 1 >= intervals.size()) return false;
  const VisibleInterval &before = intervals[i - 1], &here = intervals[i], &after = intervals[i + 1];
  if (before.part == VisibleInterval::kNothing || after.part == VisibleInterval::kNothing) return false;
  const Edge &begin = here.begin, &end = after.begin;
  if (begin.kind != Edge::Kind::kVertex || end.kind != Edge::Kind::kVertex) return false;
  // Ends in one direction that are not one place are an event: as the receiver moves on, the gap opens.
  if (!(Length(end.point - begin.point) <= 2 * scene_.touch_distance())) return false;
  if (here.part == VisibleInterval::kNothing) return true;
  const Part& part = parts[static_cast<std::size_t>(here.part)];
  const double distance = DistanceAlong(scene_.element(part.element), part, receiver, begin.s, begin.c);
  const double farther = std::max(begin.Distance(), end.Distance());
  return distance > farther * (1 + kBehind) + scene_.touch_distance();
}

template <int kChannels>
void ExactSolver::AddMeetings(const Receiver& receiver, ExactValue& value) const {
  for (const Sweep::Meeting& meeting : sweep_.meetings()) {
    const Curve &first = scene_.curve_of(meeting.first), &second = scene_.curve_of(meeting.second);
    const EdgeErrors errors =
        BoundErrors(meeting.edge, receiver.curvature, scene_.coordinate_error() + receiver.displaced);
    for (int channel = 0; channel < kChannels; ++channel) {
      const double size = std::max(first.radiance[channel], second.radiance[channel]);
      value.irradiance_error[channel] += size * (receiver.half_angle > 0 ? errors.c : errors.s);
      if (options_.derivatives >= 1) value.rotation_error[channel] += size * errors.c;
      if (options_.derivatives >= 1) value.gradient_error[channel] += size * errors.s_first;
      if (options_.derivatives >= 2) value.hessian_error[channel] += size * errors.s_second;
    }
  }
}

}  // namespace flatlight
