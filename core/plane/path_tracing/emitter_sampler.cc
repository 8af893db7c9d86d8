// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/emitter_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/tolerances.h"
#include "core/plane/box.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// Of very many pieces a part is summed and scaled up: the sum is needed once a point, as a scale of errors.
constexpr std::size_t kMostSummed = 4096;
constexpr double kTreeOff = 4;

}  // namespace

EmitterSampler::EmitterSampler(std::shared_ptr<const Scene> scene, const std::vector<ElementId>& pieces)
    : scene_(std::move(scene)) {
  for (const ElementId id : pieces) {
    const Element& element = scene_->element(id);
    const Curve& curve = scene_->curve(element.curve);
    Piece piece;
    piece.id = id;
    piece.element = element;
    piece.sides = curve.two_sided ? EmittingSides::kBoth : EmittingSides::kFront;
    piece.radiance = curve.radiance;
    piece.brightness = curve.radiance.Max();
    pieces_.push_back(piece);
  }
  if (!weighs()) PlantTree();
  piece_of_element_.assign(scene_->elements().size(), kNotAPiece);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    piece_of_element_[static_cast<std::size_t>(pieces_[i].id)] = static_cast<std::uint32_t>(i);
  }
}

void EmitterSampler::PlantTree() {
  std::vector<EmitterTree::Emitter> emitters;
  for (const Piece& piece : pieces_) {
    const Element& element = piece.element;
    const Box box = BoxOf(element, 4 * scene_->touch_distance());
    EmitterTree::Emitter emitter{box.low, box.high, piece.brightness * element.length, {}};
    if (piece.sides == EmittingSides::kBoth) {
      emitter.power *= 2;
    } else {
      // The mean normal of a curve is that of its chord, shorter by what the curve is longer.
      emitter.facing = piece.brightness * Left(element.b - element.a);
    }
    emitters.push_back(emitter);
  }
  tree_ = EmitterTree(emitters);
  std::vector<Piece> in_order;
  for (const std::uint32_t i : tree_.order()) in_order.push_back(pieces_[i]);
  pieces_ = std::move(in_order);
}

Spectrum EmitterSampler::Unblocked(const Vertex& vertex, const EmitterSight& sight) const {
  const std::size_t stride = pieces_.size() / kMostSummed + 1;
  Spectrum sum;
  Spectrum brightest;
  for (std::size_t i = 0; i < pieces_.size(); i += stride) {
    const Piece& piece = pieces_[i];
    const EmitterRange range = RangeOf(piece.element, piece.sides, vertex);
    if (range.kind == EmitterRange::Kind::kNone) continue;
    if (IsHidden(i, sight) || IsCertain(i, range, sight)) continue;
    sum = sum + (static_cast<double>(stride) * range.width) * piece.radiance;
    for (int c = 0; c < kMaxChannels; ++c) brightest[c] = std::max(brightest[c], piece.radiance[c]);
  }
  // Emitters in one direction hide each other: all directions at the largest radiance are the most there can be. The
  // chances that a tree gives, or a closer look, are off by some factor from what each would have to have.
  const double off = weighs() ? 1 : kTreeOff;
  for (int c = 0; c < kMaxChannels; ++c) sum[c] = off * std::min(sum[c], 2 * brightest[c]);
  return sum;
}

Spectrum EmitterSampler::Rounding(const Vertex& vertex, const EmitterSight& sight) const {
  // Each end is seen in a direction known to the coordinates' error over its distance (as for exact light, edge.cc).
  Spectrum sum;
  const std::size_t stride = pieces_.size() / kMostSummed + 1;
  for (std::size_t i = 0; i < pieces_.size(); i += stride) {
    const Piece& piece = pieces_[i];
    if (IsHidden(i, sight)) continue;
    if (RangeOf(piece.element, piece.sides, vertex).kind == EmitterRange::Kind::kNone) continue;
    const double distance = DistanceTo(piece.element, vertex.at.position);
    const double turn = 2 * scene_->coordinate_error() / distance + 8 * kUnitRoundoff;
    sum = sum + (2 * static_cast<double>(stride) * std::min(turn, 1.0)) * piece.radiance;
  }
  return sum;
}

}  // namespace flatlight
