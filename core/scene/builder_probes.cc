// SPDX-License-Identifier: Apache-2.0
// The part of SceneBuilder that places probes.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "core/math/tolerances.h"
#include "core/math/trig.h"
#include "core/scene/attach.h"
#include "core/scene/bezier_chain.h"
#include "core/scene/builder.h"
#include "core/scene/element_frame.h"

namespace flatlight {

void SceneBuilder::AddProbes() {
  for (const ProbeDescription& description : description_.probes) {
    Probe probe;
    probe.name = description.name;
    if (description.curve) {
      AddCurveProbe(description, probe);
    } else if (description.fluence) {
      probe.picture = PictureOf(*description.fluence);
    } else if (description.camera) {
      AddCamera(*description.camera, probe);
    } else {
      AddPointProbe(description, probe);
    }
    scene_->probes_.push_back(std::move(probe));
  }
  // Free points may lie on curves, and curve points on pieces that another curve covers.
  std::vector<Receiver*> loose;
  for (Probe& probe : scene_->probes_)
    for (Receiver& receiver : probe.receivers)
      if (receiver.element == ElementId::kNone) loose.push_back(&receiver);
  for (Probe& probe : scene_->probes_) {
    probe.on_curve = probe.curve != CurveId::kNone;
    for (const Receiver& receiver : probe.receivers) probe.on_curve &= receiver.element != ElementId::kNone;
  }
  AttachReceivers(*scene_, 2 * scene_->touch_distance_, std::move(loose));
  for (Probe& probe : scene_->probes_) {
    if (probe.receivers.empty()) continue;
    probe.low = probe.high = probe.receivers.front().position;
    for (const Receiver& receiver : probe.receivers) {
      const Point2 p = receiver.position;
      probe.low = {std::min(probe.low.x, p.x), std::min(probe.low.y, p.y)};
      probe.high = {std::max(probe.high.x, p.x), std::max(probe.high.y, p.y)};
    }
  }
}

ElementId SceneBuilder::ElementAt(const Curve& curve, double arc_length) const {
  const auto first = scene_->elements_.begin() + curve.first_element;
  const auto last = first + curve.element_count;
  const auto next =
      std::upper_bound(first, last, arc_length, [](double s, const Element& e) { return s < e.arc_begin; });
  if (next == first) return ElementId::kNone;
  const auto element = std::prev(next);
  if (arc_length > element->arc_begin + element->length * (1 + 4 * kUnitRoundoff)) return ElementId::kNone;
  return static_cast<ElementId>(element - scene_->elements_.begin());
}

double SceneBuilder::LengthError(std::size_t curve) const {
  double error = 0, length = 0;
  for (std::uint32_t e = first_piece_[curve]; e < first_piece_[curve + 1]; ++e) {
    const Element& piece = pieces_[e];
    const BezierPiece* on = scene_->bezier_piece(piece);
    if (on == nullptr) return 0;
    // A quadrature rule of this degree in halves has all but none of its error.
    const Bezier& bezier = scene_->beziers_[on->bezier];
    const double middle = 0.5 * (on->from + on->to);
    error += std::abs(piece.length - (bezier.Length(on->from, middle) + bezier.Length(middle, on->to)));
    length += piece.length;
  }
  return 2 * error + 16 * kUnitRoundoff * length;
}

void SceneBuilder::AddCurveProbe(const ProbeDescription& description, Probe& probe) const {
  std::size_t c = 0;
  while (scene_->curves_[c].name != *description.curve) ++c;
  probe.curve = static_cast<CurveId>(c);
  const Curve& curve = scene_->curves_[c];
  const auto first = pieces_.begin() + first_piece_[c];
  const auto last = pieces_.begin() + first_piece_[c + 1];
  const double from = description.from.value_or(0);
  const double to = description.to.value_or(1);
  const double side = description.side.value_or(Side::kFront) == Side::kBack ? -1 : 1;
  const double length_error = LengthError(c);
  for (std::uint32_t i = 0; i < *description.count; ++i) {
    const double fraction = from + (i + 0.5) / *description.count * (to - from);
    Receiver receiver;
    receiver.arc_length = fraction * curve.length;
    // The last piece that starts at or before the point: a point on a vertex belongs to the piece that starts there.
    const auto piece = std::prev(std::upper_bound(first + 1, last, receiver.arc_length,
                                                  [](double s, const Element& e) { return s < e.arc_begin; }));
    const double local = std::clamp((receiver.arc_length - piece->arc_begin) / piece->length, 0.0, 1.0);
    const ElementFrame frame = FrameAt(*piece, last - first == 1 ? fraction : local);
    if (const BezierPiece* on = scene_->bezier_piece(*piece); on != nullptr && on->bends) {
      const Bezier& bezier = scene_->beziers_[on->bezier];
      const double u = bezier.AtLength(local * piece->length, on->from, on->to);
      PlaceOnBezier(*piece, bezier, u, side, receiver);
      BoundPlaceOnBezier(bezier, u, length_error, scene_->coordinate_error_, receiver);
    } else {
      receiver.position = frame.position;
      receiver.tangent = frame.tangent;
      receiver.normal = side * frame.normal;
      receiver.curvature = side * frame.curvature;
      if (on != nullptr && !scene_->beziers_[on->bezier].IsStraight()) {
        // The tip of a cusp, as good as a point: it turns any way on it.
        receiver.displaced = piece->length + length_error;
        receiver.tilt = 2, receiver.curvature_error = 2 / piece->length;
        receiver.curvature_change_error = 2 / (piece->length * piece->length);
      }
    }
    receiver.element = ElementAt(curve, receiver.arc_length);
    probe.receivers.push_back(receiver);
  }
}

void SceneBuilder::AddPointProbe(const ProbeDescription& description, Probe& probe) {
  for (const ProbePointDescription& point : description.points) {
    Receiver receiver;
    receiver.position = ToFrame(point.position);
    receiver.normal = Normalized(ScaledToUnit(point.normal));
    receiver.tangent = Right(receiver.normal);
    probe.receivers.push_back(receiver);
  }
}

void SceneBuilder::AddCamera(const CameraDescription& camera, Probe& probe) {
  const Vector2 sight = Normalized(ScaledToUnit(camera.target - camera.position));
  const bool to_left = camera.up && Cross(sight, ScaledToUnit(*camera.up)) > 0;
  const Vector2 side = to_left ? Left(sight) : Right(sight);
  const SinCosValue half = SinCos(0.5 * camera.field_of_view);
  // Toward the borders between pixels, which are at equal distances on a screen.
  const auto border = [&](std::uint32_t i) {
    const double place = 2 * static_cast<double>(i) / *camera.width - 1;
    return Normalized(half.cos * sight + place * half.sin * side);
  };
  probe.camera = true;
  for (std::uint32_t i = 0; i < *camera.width; ++i) {
    const Vector2 from = border(i), to = border(i + 1);
    Receiver receiver;
    receiver.position = ToFrame(camera.position);
    receiver.normal = Normalized(from + to);
    receiver.tangent = Right(receiver.normal);
    receiver.half_angle = 0.5 * AngleOf(Dot(from, to), std::abs(Cross(from, to)));
    probe.receivers.push_back(receiver);
  }
}

}  // namespace flatlight
