// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/outlook.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flatlight {

const std::vector<VisiblePiece>& Outlook::From(const Receiver& receiver) {
  pieces_.clear();
  const Envelope& envelope = gatherer_.Gather(receiver);
  if (!envelope.doubtful()) {
    Edge begin, end;
    const Sectors& sectors = envelope.sectors();
    std::size_t next = 0;
    bool after_sky = false;
    for (std::size_t i = 0; i < sectors.size(); i = next) {
      // What lies behind may have split a sector.
      for (next = i + 1; next < sectors.size() && sectors[next].sight == sectors[i].sight; ++next) continue;
      if (sectors[i].sight == Sector::kNothing) {
        after_sky = true;
        continue;
      }
      const Sight& sight = envelope.SightOf(sectors[i]);
      envelope.SetEdge(sectors[i], begin);
      envelope.SetEdge(sectors[next], end);
      Add(receiver, sight.element, sight.front ? Side::kFront : Side::kBack, sight.part, begin, end, after_sky);
      after_sky = false;
    }
    return pieces_;
  }
  const std::vector<Part>& parts = gatherer_.PartsInDoubt(receiver);
  const std::vector<VisibleInterval>& intervals = sweep_.Run(parts, receiver);
  bool after_sky = false;
  std::size_t next = 0;
  for (std::size_t i = 0; i + 1 < intervals.size(); i = next) {
    for (next = i + 1; next + 1 < intervals.size() && intervals[next].part == intervals[i].part; ++next) continue;
    if (intervals[i].part == VisibleInterval::kNothing) {
      after_sky = true;
      continue;
    }
    const Part& part = parts[static_cast<std::size_t>(intervals[i].part)];
    Add(receiver, part.element, intervals[i].side, &part, intervals[i].begin, intervals[next].begin, after_sky);
    after_sky = false;
  }
  return pieces_;
}

void Outlook::Add(const Receiver& receiver, ElementId element, Side side, const Part* part, const Edge& begin,
                  const Edge& end, bool after_sky) {
  VisiblePiece piece;
  piece.after_sky = after_sky;
  piece.element = element;
  piece.side = side;
  piece.begin = Locate(receiver, element, part, begin);
  piece.end = Locate(receiver, element, part, end);
  // What is not seen yet may come into view as the receiver moves on.
  piece.extent = std::max(0.0, SineDifference(begin, end, receiver));
  pieces_.push_back(piece);
}

Spectrum Outlook::Direct(const Receiver& receiver) const {
  Spectrum direct;
  double seen = 0;
  for (const VisiblePiece& piece : pieces_) {
    seen += piece.extent;
    const Spectrum emitted = scene_.curve_of(piece.element).EmittedRadiance(piece.side);
    if (!emitted.IsBlack()) direct = direct + piece.extent * emitted;
  }
  // The sines run from -1 to 1.
  if (scene_.traits().environment) direct = direct + std::max(0.0, 2 - seen) * scene_.environment();
  if (scene_.lights().empty()) return direct;
  ExactValue value;
  lights_.Add(receiver, value);
  return direct + value.irradiance;
}

PieceEnd Outlook::Locate(const Receiver& receiver, ElementId element, const Part* part, const Edge& edge) const {
  const Element& e = scene_.element(element);
  PieceEnd end;
  end.edge = edge;
  // An arc's end may also lie behind another part of the same arc.
  const auto ends_part = [&](const Edge& own) { return own.kind == Edge::Kind::kVertex && own.point == edge.point; };
  if (edge.kind == Edge::Kind::kVertex && (edge.point == e.a || edge.point == e.b) &&
      (e.kind == Element::Kind::kSegment || ends_part(part->first) || ends_part(part->last))) {
    end.u = edge.point == e.a ? 0 : 1;
    end.own = true;
    return end;
  }
  const double reach = std::abs(edge.tangent) + std::abs(edge.normal);
  const double tangent = edge.tangent / reach, normal = edge.normal / reach;
  const Vector2 direction = tangent * receiver.tangent + normal * receiver.normal;
  if (e.kind == Element::Kind::kSegment) {
    const Vector2 along = e.b - e.a;
    const double slope = Cross(direction, along);
    const Vector2 to_a = e.a - receiver.position, to_b = e.b - receiver.position;
    const double at_a = Cross(direction, to_a), at_b = Cross(direction, to_b);
    const double u = std::abs(at_a) <= std::abs(at_b) ? -at_a / slope : 1 - at_b / slope;
    end.u = slope != 0 ? std::clamp(u, 0.0, 1.0) : 0.5;
    return end;
  }
  const Chart& chart = charts_[static_cast<std::size_t>(element)];
  if (edge.kind == Edge::Kind::kHorizon && receiver.element != ElementId::kNone &&
      scene_.element(receiver.element).carrier == e.carrier) {
    // The receiver's own circle runs on to the receiver itself.
    end.u = std::clamp(chart.Find(receiver.position), 0.0, 1.0);
    return end;
  }
  const double length = std::sqrt(tangent * tangent + normal * normal);
  const double distance = DistanceAlong(e, *part, receiver, tangent / length, normal / length);
  end.u = std::clamp(chart.Find(receiver.position + (distance / length) * direction), 0.0, 1.0);
  if (edge.kind == Edge::Kind::kSilhouette) {
    end.own = std::abs(distance * edge.q - 1) <= 1e-6;
    if (end.own) end.u = std::clamp(chart.Find(edge.point), 0.0, 1.0);
  }
  return end;
}

}  // namespace flatlight
