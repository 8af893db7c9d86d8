// SPDX-License-Identifier: Apache-2.0
#include "core/plane/ray_tracing/edge_on.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flatlight {
namespace {

constexpr std::size_t kMostElements = 256;
// Less than that is lost among what rays miss elsewhere; per normalised length.
constexpr double kLeastSize = 0.05;
// What is seen more broadside than that is small from all sides.
constexpr double kSteepness = 2;

// Where to look for the whole piece: a little inside its ends.
constexpr std::array<double, 2> kInside = {0.02, 0.98};

}  // namespace

EdgeOnPieces::EdgeOnPieces(const RayCaster& caster, const Receiver& receiver, std::uint32_t rays) {
  const Scene& scene = caster.scene();
  if (scene.elements().size() > kMostElements) return;
  const std::uint32_t own = receiver.element == ElementId::kNone ? 0xffffffff : scene.element(receiver.element).carrier;
  const double widest = 4.0 / rays;
  for (std::size_t e = 0; e < scene.elements().size(); ++e) {
    const Element& element = scene.elements()[e];
    if (element.kind != Element::Kind::kSegment || element.carrier == own) continue;
    const Vector2 a = element.a - receiver.position, b = element.b - receiver.position;
    const double least = scene.touch_distance();
    if (!(Dot(receiver.normal, a) > least && Dot(receiver.normal, b) > least)) continue;
    // By the sine of the angle between its ends, of which the depth below allows half.
    const double cross = Cross(a, b), squares = LengthSquared(a) * LengthSquared(b);
    if (cross * cross * (kSteepness * kSteepness) > squares) continue;
    EdgeOnPiece piece;
    piece.element = static_cast<ElementId>(e);
    piece.low = VertexEdge(receiver, element.a), piece.high = VertexEdge(receiver, element.b);
    const double width = std::abs(piece.high.s - piece.low.s), depth = std::abs(piece.high.q - piece.low.q);
    const double angle = std::abs(cross) * piece.low.q * piece.high.q;
    if (width > widest || depth < kSteepness * angle * std::max(piece.low.q, piece.high.q)) continue;
    piece.size = depth * piece.low.c * piece.high.c;
    if (piece.size < kLeastSize) continue;
    const bool flat = width <= 8 * least * std::max(piece.low.q, piece.high.q);
    // The nearer end falls behind.
    if (flat ? piece.low.q < piece.high.q : piece.low.s > piece.high.s) std::swap(piece.low, piece.high);
    const bool seen = std::all_of(kInside.begin(), kInside.end(), [&](double t) {
      return caster.Visible({receiver.position, receiver.element},
                            {element.a + t * (element.b - element.a), piece.element});
    });
    if (!seen) continue;
    const Vector2 middle = 0.5 * (a + b);
    const Vector2 front = Normalized(Left(element.b - element.a));
    const double side = flat ? Dot(front, receiver.tangent) : -Dot(front, middle);
    piece.middle = {1, piece.element, receiver.position + middle, front};
    // Off the piece by an angle that its side can be told by.
    constexpr double kTurn = 1e-3;
    piece.toward = middle;
    if (flat) piece.toward = middle - (side > 0 ? kTurn : -kTurn) * Length(middle) * front;
    Keep(piece);
  }
  std::sort(pieces_.begin(), pieces_.begin() + static_cast<std::ptrdiff_t>(count_),
            [](const EdgeOnPiece& x, const EdgeOnPiece& y) { return x.low.s < y.low.s; });
}

void EdgeOnPieces::Keep(const EdgeOnPiece& piece) {
  if (count_ < kMost) {
    pieces_[count_++] = piece;
    return;
  }
  const auto smallest = std::min_element(pieces_.begin(), pieces_.end(),
                                         [](const EdgeOnPiece& x, const EdgeOnPiece& y) { return x.size < y.size; });
  if (smallest->size < piece.size) *smallest = piece;
}

}  // namespace flatlight
