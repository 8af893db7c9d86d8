// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/plane/path_tracing/emitter_sampler.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// Of a piece's weight, where its middle is hidden: what a closer look leaves to those of its points that are not.
constexpr double kBlockedShare = 0.25;

}  // namespace

EmitterSampler::View::View(const EmitterSampler& sampler, const Vertex& vertex, const EmitterSight& sight)
    : sampler_(sampler), vertex_(vertex) {
  if (!sampler_.weighs()) {
    total_ = sampler_.tree_.Reaches(vertex) ? 1 : 0;
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

void EmitterSampler::View::LookCloser(const RayCaster& caster) {
  if (sampler_.weighs()) return;
  sampler_.tree_.OpenNear(vertex_, [&](std::uint32_t cluster, double guess, const EmitterTree::Leaf& leaf) {
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      const Seen seen = See(i);
      if (seen.weight > 0) groups_.push_back({seen.weight, i, kOnePiece, seen});
    }
    if (leaf.count == 0) groups_.push_back({guess, sampler_.tree_.Begin(cluster), cluster, {}});
  });
  const auto is_tested = [](const Group& group) {
    return group.cluster == kOnePiece && group.seen.range.kind == EmitterRange::Kind::kSines;
  };
  std::vector<SurfacePoint> places;
  for (const Group& group : groups_)
    if (is_tested(group)) places.push_back(MiddleOf(group));
  const std::vector<SurfacePoint> here(places.size(), vertex_.at);
  const std::unique_ptr<bool[]> visible(new bool[places.size()]);
  caster.Visible(here, places, {visible.get(), places.size()});
  total_ = 0;
  // What is seen, by these rays: irradiance, and its integral with another factor of radiance.
  double likely = 0, squared = 0;
  bool all_known = true;
  std::size_t tested = 0;
  for (Group& group : groups_) {
    double weight = group.weight_end;
    if (!is_tested(group)) {
      all_known = false;
    } else if (visible[tested++]) {
      likely += weight;
      squared += weight * sampler_.pieces_[group.first].brightness;
    } else {
      weight *= kBlockedShare;
    }
    group.weight_end = total_ += weight;
  }
  sufficient_ = all_known && likely > 0 && total_ * likely <= 2 * squared;
}

SurfacePoint EmitterSampler::View::MiddleOf(const Group& group) const {
  const Piece& piece = sampler_.pieces_[group.first];
  const EmitterRange& range = group.seen.range;
  const double sine = std::clamp(range.low + 0.5 * range.width, -1.0, 1.0);
  return {PointInDirection(piece.element, range, vertex_, vertex_.Direction(sine, CosineOf(sine))), piece.id};
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

// Chooses one of some pieces side by side by weight; `choice` holds the chance of getting there.
bool EmitterSampler::View::ChooseAmong(std::span<const Seen> seen, std::uint32_t first, double total, double u,
                                       Choice& choice) {
  if (total == 0) return false;
  const double target = u * total;
  std::size_t chosen = 0;
  double begin = 0;
  double weight = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i].weight == 0) continue;
    begin += weight;
    chosen = i;
    weight = seen[i].weight;
    if (target < begin + weight) break;
  }
  choice.piece = first + static_cast<std::uint32_t>(chosen);
  choice.range = seen[chosen].range;
  choice.probability *= weight / total;
  choice.place = std::clamp((target - begin) / weight, 0.0, 1.0);
  return true;
}

bool EmitterSampler::View::ChooseInLeaf(const EmitterTree::Leaf& leaf, Choice& choice) const {
  std::array<Seen, EmitterTree::kLeafSize> seen;
  double total = 0;
  for (std::uint32_t i = 0; i < leaf.count; ++i) total += (seen[i] = See(leaf.first + i)).weight;
  choice.probability *= leaf.probability;
  return ChooseAmong(std::span(seen).first(leaf.count), leaf.first, total, leaf.rest, choice);
}

// A piece is chosen, and the same number, rescaled, then chooses the place on it.
bool EmitterSampler::View::Choose(double u, Choice& choice) const {
  if (sampler_.weighs()) return ChooseAmong(std::span(seen_).first(sampler_.pieces_.size()), 0, total_, u, choice);
  if (groups_.empty()) return ChooseInLeaf(sampler_.tree_.Choose(vertex_, u), choice);
  const double target = u * total_;
  const auto group = std::upper_bound(groups_.begin(), groups_.end() - 1, target,
                                      [](double t, const Group& g) { return t < g.weight_end; });
  const double begin = group == groups_.begin() ? 0 : std::prev(group)->weight_end;
  const double weight = group->weight_end - begin;
  if (!(weight > 0)) return false;
  choice.probability = weight / total_;
  choice.place = std::clamp((target - begin) / weight, 0.0, 1.0);
  if (group->cluster != kOnePiece)
    return ChooseInLeaf(sampler_.tree_.ChooseIn(group->cluster, vertex_, choice.place), choice);
  choice.piece = group->first;
  choice.range = group->seen.range;
  return true;
}

bool EmitterSampler::View::FindInLeaf(const EmitterTree::Leaf& leaf, Choice& choice) const {
  if (choice.piece - leaf.first >= leaf.count) return false;
  double total = 0;
  double weight = 0;
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    const Seen seen = See(leaf.first + i);
    total += seen.weight;
    if (leaf.first + i != choice.piece) continue;
    weight = seen.weight;
    choice.range = seen.range;
  }
  if (weight == 0) return false;
  choice.probability *= leaf.probability * (weight / total);
  return true;
}

// Fills in the range and the chance with which Choose gives choice.piece.
bool EmitterSampler::View::Find(Choice& choice) const {
  if (total_ == 0) return false;
  if (sampler_.weighs()) {
    choice.range = seen_[choice.piece].range;
    choice.probability = seen_[choice.piece].weight / total_;
    return choice.probability > 0;
  }
  if (groups_.empty()) return FindInLeaf(sampler_.tree_.Find(vertex_, choice.piece), choice);
  const auto after = std::upper_bound(groups_.begin(), groups_.end(), choice.piece,
                                      [](std::uint32_t piece, const Group& g) { return piece < g.first; });
  if (after == groups_.begin()) return false;
  const auto group = std::prev(after);
  choice.probability = (group->weight_end - (group == groups_.begin() ? 0 : std::prev(group)->weight_end)) / total_;
  if (!(choice.probability > 0)) return false;
  // What gives nothing is in no group; then the group before it may be another's.
  if (group->cluster != kOnePiece)
    return FindInLeaf(sampler_.tree_.FindIn(group->cluster, vertex_, choice.piece), choice);
  choice.range = group->seen.range;
  return group->first == choice.piece;
}

std::optional<EmitterSample> EmitterSampler::View::Sample(double u) const {
  Choice choice;
  if (!Choose(u, choice)) return std::nullopt;
  if (choice.range.kind == EmitterRange::Kind::kLength) return SampleLength(choice);
  const Piece& piece = sampler_.pieces_[choice.piece];
  const double sine = std::clamp(choice.range.low + choice.place * choice.range.width, -1.0, 1.0);
  EmitterSample sample;
  sample.cosine = CosineOf(sine);
  if (sample.cosine == 0) return std::nullopt;
  const Vector2 direction = vertex_.Direction(sine, sample.cosine);
  sample.point = {PointInDirection(piece.element, choice.range, vertex_, direction), piece.id};
  sample.radiance = piece.radiance;
  sample.density = choice.probability * sample.cosine / choice.range.width;
  return sample;
}

std::optional<EmitterSample> EmitterSampler::View::SampleLength(const Choice& choice) const {
  const Piece& piece = sampler_.pieces_[choice.piece];
  EmitterSample sample;
  sample.point = {FrameAt(piece.element, choice.place).position, piece.id};
  const Vector2 toward = sample.point.position - vertex_.at.position;
  const double distance = Length(toward);
  sample.cosine = Dot(vertex_.normal, toward) / distance;
  double emitter_cosine = -Dot(FrontNormal(piece.element, sample.point.position), toward) / distance;
  if (piece.sides == EmittingSides::kBoth) emitter_cosine = std::abs(emitter_cosine);
  // Written so that a vertex at the very same place (0/0) gives nothing too.
  if (!(sample.cosine > 0) || !(emitter_cosine > 0)) return std::nullopt;
  sample.radiance = piece.radiance;
  sample.density = choice.probability * distance / (emitter_cosine * piece.element.length);
  return sample;
}

double EmitterSampler::View::Density(const Hit& hit, Vector2 direction, double cosine) const {
  Choice choice;
  choice.piece = sampler_.piece_of_element_[static_cast<std::size_t>(hit.element)];
  if (choice.piece == kNotAPiece) return 0;
  if (certain_pieces_ != 0 && ((certain_pieces_ >> choice.piece) & 1) != 0)
    return std::numeric_limits<double>::infinity();
  if (!Find(choice)) return 0;
  if (choice.range.kind == EmitterRange::Kind::kLength) {
    const double emitter_cosine = std::abs(Dot(hit.normal, direction));
    return choice.probability * hit.distance / (emitter_cosine * sampler_.pieces_[choice.piece].element.length);
  }
  return choice.probability * cosine / choice.range.width;
}

}  // namespace flatlight
