// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/emitter_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/tolerances.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kNotAPiece = 0xffffffff;
// Of very many pieces a part is summed and scaled up: the sum is needed once a point, as a scale of errors.
constexpr std::size_t kMostSummed = 4096;

}  // namespace

EmitterSampler::EmitterSampler(std::shared_ptr<const Scene> scene, const std::vector<ElementId>& pieces)
    : scene_(std::move(scene)) {
  double power = 0;
  piece_of_element_.assign(scene_->elements().size(), kNotAPiece);
  for (const ElementId id : pieces) {
    const Element& element = scene_->element(id);
    const Curve& curve = scene_->curve(element.curve);
    Piece piece;
    piece.id = id;
    piece.element = element;
    piece.sides = curve.two_sided ? EmittingSides::kBoth : EmittingSides::kFront;
    piece.radiance = curve.radiance;
    piece.brightness = curve.radiance.Max();
    power += piece.brightness * element.length * (curve.two_sided ? 2 : 1);
    piece.power_end = power;
    piece_of_element_[static_cast<std::size_t>(id)] = static_cast<std::uint32_t>(pieces_.size());
    pieces_.push_back(piece);
  }
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
  // Emitters in one direction hide each other: all directions at the largest radiance are the most there can be.
  for (int c = 0; c < kMaxChannels; ++c) sum[c] = std::min(sum[c], 2 * brightest[c]);
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

EmitterSampler::View::View(const EmitterSampler& sampler, const Vertex& vertex, const EmitterSight& sight)
    : sampler_(sampler), vertex_(vertex) {
  if (!sampler_.weighs()) {
    total_ = sampler_.pieces_.back().power_end;
    return;
  }
  double dimmest = std::numeric_limits<double>::infinity();
  bool by_length = false;
  for (std::size_t i = 0; i < sampler_.pieces_.size(); ++i) {
    seen_[i] = sampler_.IsHidden(i, sight) ? Seen{} : See(i);
    if (seen_[i].weight == 0) continue;
    if (sampler_.IsCertain(i, seen_[i].range, sight)) {
      certain_ = certain_ + seen_[i].range.width * sampler_.pieces_[i].radiance;
      certain_pieces_ |= std::uint32_t{1} << i;
      seen_[i].weight = 0;
      continue;
    }
    total_ += seen_[i].weight;
    dimmest = std::min(dimmest, sampler_.pieces_[i].brightness);
    by_length = by_length || seen_[i].range.kind == EmitterRange::Kind::kLength;
  }
  sufficient_ = !by_length && total_ <= 2 * dimmest;
}

EmitterSampler::View::Seen EmitterSampler::View::See(std::size_t index) const {
  const Piece& piece = sampler_.pieces_[index];
  Seen seen;
  seen.range = RangeOf(piece.element, piece.sides, vertex_);
  if (seen.range.kind != EmitterRange::Kind::kNone) seen.weight = piece.brightness * seen.range.width;
  return seen;
}

SurfacePoint EmitterSampler::View::PlaceOn(std::size_t piece, double u) const {
  const EmitterRange& range = seen_[piece].range;
  const double sine = std::clamp(range.low + u * range.width, -1.0, 1.0);
  const Vector2 direction = vertex_.Direction(sine, CosineOf(sine));
  return {PointInDirection(sampler_.pieces_[piece].element, range, vertex_, direction), sampler_.pieces_[piece].id};
}

std::optional<EmitterSample> EmitterSampler::View::Sample(double u) const {
  const std::vector<Piece>& pieces = sampler_.pieces_;
  // Choose a piece; the same number, rescaled, then chooses the place on it.
  const double target = u * total_;
  std::size_t index = 0;
  double begin = 0;
  double weight = 0;
  Seen seen;
  if (sampler_.weighs()) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (seen_[i].weight == 0) continue;
      begin += weight;
      index = i;
      weight = seen_[i].weight;
      if (target < begin + weight) break;
    }
    seen = seen_[index];
  } else {
    const auto found = std::upper_bound(pieces.begin(), pieces.end() - 1, target,
                                        [](double t, const Piece& piece) { return t < piece.power_end; });
    index = static_cast<std::size_t>(found - pieces.begin());
    begin = index == 0 ? 0 : pieces[index - 1].power_end;
    weight = pieces[index].power_end - begin;
    seen = See(index);
  }
  const double probability = weight / total_;
  const double place = std::clamp((target - begin) / weight, 0.0, 1.0);
  if (seen.weight == 0) return std::nullopt;
  const Piece& piece = pieces[index];
  if (seen.range.kind == EmitterRange::Kind::kLength) return SampleLength(index, probability, place);
  const double sine = std::clamp(seen.range.low + place * seen.range.width, -1.0, 1.0);
  EmitterSample sample;
  sample.cosine = CosineOf(sine);
  if (sample.cosine == 0) return std::nullopt;
  const Vector2 direction = vertex_.Direction(sine, sample.cosine);
  sample.point = {PointInDirection(piece.element, seen.range, vertex_, direction), piece.id};
  sample.radiance = piece.radiance;
  sample.density = probability * sample.cosine / seen.range.width;
  return sample;
}

std::optional<EmitterSample> EmitterSampler::View::SampleLength(std::size_t index, double probability, double u) const {
  const Piece& piece = sampler_.pieces_[index];
  EmitterSample sample;
  sample.point = {FrameAt(piece.element, u).position, piece.id};
  const Vector2 toward = sample.point.position - vertex_.at.position;
  const double distance = Length(toward);
  sample.cosine = Dot(vertex_.normal, toward) / distance;
  double emitter_cosine = -Dot(FrontNormal(piece.element, sample.point.position), toward) / distance;
  if (piece.sides == EmittingSides::kBoth) emitter_cosine = std::abs(emitter_cosine);
  // Written so that a vertex at the very same place (0/0) gives nothing too.
  if (!(sample.cosine > 0) || !(emitter_cosine > 0)) return std::nullopt;
  sample.radiance = piece.radiance;
  sample.density = probability * distance / (emitter_cosine * piece.element.length);
  return sample;
}

double EmitterSampler::View::Density(const Hit& hit, Vector2 direction, double cosine) const {
  const std::uint32_t index = sampler_.piece_of_element_[static_cast<std::size_t>(hit.element)];
  if (index == kNotAPiece) return 0;
  if (certain_pieces_ != 0 && ((certain_pieces_ >> index) & 1) != 0) return std::numeric_limits<double>::infinity();
  if (total_ == 0) return 0;
  const Piece& piece = sampler_.pieces_[index];
  const Seen seen = sampler_.weighs() ? seen_[index] : See(index);
  if (seen.weight == 0) return 0;
  const double begin = index == 0 ? 0 : sampler_.pieces_[index - 1].power_end;
  const double probability = (sampler_.weighs() ? seen.weight : piece.power_end - begin) / total_;
  if (seen.range.kind == EmitterRange::Kind::kLength) {
    const double emitter_cosine = std::abs(Dot(hit.normal, direction));
    return probability * hit.distance / (emitter_cosine * piece.element.length);
  }
  return probability * cosine / seen.range.width;
}

}  // namespace flatlight
