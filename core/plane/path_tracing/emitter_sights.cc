// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/emitter_sights.h"

#include <utility>

namespace flatlight {
namespace {

// In larger scenes few whole elements have a clear or a hidden way to an emitter, and the memory would be large.
constexpr std::size_t kMostElements = 1 << 14;

}  // namespace

EmitterSights::EmitterSights(const RayCaster& caster, std::vector<ElementId> emitters)
    : caster_(caster), emitters_(std::move(emitters)) {
  if (emitters_.size() > EmitterSight::kMost) emitters_.clear();
  if (!emitters_.empty() && caster.scene().elements().size() <= kMostElements) {
    elements_ = EmitterSightMemory(2 * caster.scene().elements().size());
  }
}

const Element* EmitterSights::HollowOf(const Vertex& vertex) const {
  if (vertex.at.element == ElementId::kNone) return nullptr;
  const Element& element = caster_.scene().element(vertex.at.element);
  const bool hollow =
      element.kind == Element::Kind::kArc && Dot(vertex.normal, element.center - vertex.at.position) > 0;
  return hollow ? &element : nullptr;
}

EmitterSight EmitterSights::FromPoint(const Vertex& vertex) const {
  return Look(CornersOf(vertex.at.position), vertex.carrier, HollowOf(vertex));
}

EmitterSight EmitterSights::FromElement(const Vertex& vertex) const {
  const std::size_t element = static_cast<std::size_t>(vertex.at.element);
  if (emitters_.empty() || caster_.scene().elements().size() > kMostElements) return {};
  const Element* hollow = HollowOf(vertex);
  return elements_.At(2 * element + (hollow != nullptr ? 1 : 0),
                      [&] { return Look(CornersOf(caster_.scene().elements()[element]), vertex.carrier, hollow); });
}

EmitterSight EmitterSights::Look(const Corners& from, std::uint32_t carrier, const Element* hollow) const {
  EmitterSight sight;
  for (std::size_t i = 0; i < emitters_.size(); ++i) {
    const Element& emitter = caster_.scene().element(emitters_[i]);
    const Corners to = CornersOf(emitter);
    OwnCarriers own{carrier, emitter.carrier};
    // A ray that leaves a circle toward its inside meets it again, unless it ends on or inside of it.
    if (hollow != nullptr && emitter.carrier != carrier && !CircleHolds(*hollow, to)) own.from = Vertex::kNoCarrier;
    const Passage passage = PassageBetween(caster_.scene(), caster_.bvh(), from, to, own);
    if (passage == Passage::kClear) sight.clear |= std::uint32_t{1} << i;
    if (passage == Passage::kHidden) sight.hidden |= std::uint32_t{1} << i;
  }
  return sight;
}

}  // namespace flatlight
