// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_SIGHTS_H_
#define FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_SIGHTS_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/plane/path_tracing/vertex.h"
#include "core/plane/ray_caster.h"
#include "core/plane/shaft.h"
#include "core/scene/scene.h"

namespace flatlight {

// What shapes tell of the ways between a place and each of up to kMost emitting pieces, before any ray is cast. A bit
// that is set is certain.
struct EmitterSight {
  static constexpr std::size_t kMost = 31;

  std::uint32_t clear = 0;   // Bit i: no other curve stands between the place and piece i.
  std::uint32_t hidden = 0;  // Bit i: no light of piece i comes straight to the place.

  // In one word, with the top bit set.
  std::uint64_t Packed() const { return kKnown | (std::uint64_t{hidden} << 32) | clear; }
  static EmitterSight Unpacked(std::uint64_t word) {
    return {static_cast<std::uint32_t>(word), static_cast<std::uint32_t>((word & ~kKnown) >> 32)};
  }
  static constexpr std::uint64_t kKnown = std::uint64_t{1} << 63;
};

// EmitterSights of places, looked up once each. Safe to use from several threads: whoever comes first works it out, and
// it is the same for all.
class EmitterSightMemory {
 public:
  explicit EmitterSightMemory(std::size_t places = 0)
      : words_(places > 0 ? new std::atomic<std::uint64_t>[places] {} : nullptr) {}

  template <typename Look>
  EmitterSight At(std::size_t place, const Look& look) const {
    const std::uint64_t known = words_[place].load(std::memory_order_relaxed);
    if (known != 0) return EmitterSight::Unpacked(known);
    const EmitterSight sight = look();
    words_[place].store(sight.Packed(), std::memory_order_relaxed);
    return sight;
  }

 private:
  std::unique_ptr<std::atomic<std::uint64_t>[]> words_;
};

// The sights of single points and of whole elements.
class EmitterSights {
 public:
  // `emitters` are the pieces by number; there may be more than EmitterSight::kMost, but then nothing is known of any.
  EmitterSights(const RayCaster& caster, std::vector<ElementId> emitters);

  // Worked out anew each time.
  EmitterSight FromPoint(const Vertex& vertex) const;
  // From every point of the vertex's element, on the vertex's side; remembered.
  EmitterSight FromElement(const Vertex& vertex) const;

 private:
  EmitterSight Look(const Corners& from, std::uint32_t carrier, const Element* hollow) const;
  // The arc from whose inner side the vertex looks, or null.
  const Element* HollowOf(const Vertex& vertex) const;

  const RayCaster& caster_;
  std::vector<ElementId> emitters_;
  EmitterSightMemory elements_;  // By element, then side.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_SIGHTS_H_
