// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_EXACT_GATHER_H_
#define FLATLIGHT_CORE_PLANE_EXACT_GATHER_H_

#include <cstdint>
#include <deque>
#include <vector>

#include "core/plane/bvh.h"
#include "core/plane/exact/envelope.h"
#include "core/plane/exact/part.h"
#include "core/scene/scene.h"

namespace flatlight {

// Collects what a receiver sees: walks the tree from near to far and leaves out what lies wholly behind what was found
// before. So the work follows what is visible, not what there is. A part that is partly visible is always found.
class Gatherer {
 public:
  Gatherer(const Scene& scene, const Bvh& bvh) : scene_(scene), bvh_(bvh), envelope_(scene) {}

  // The result is valid until the next call, of either kind.
  const Envelope& Gather(const Receiver& receiver);
  // The same, where these, in the order of their elements, are all that there is to see: the tree is not looked at.
  const Envelope& GatherAmong(const std::vector<Bvh::Slot>& slots, const Receiver& receiver);
  // Where the last envelope is doubtful: the parts of everything that it may show.
  const std::vector<Part>& PartsInDoubt(const Receiver& receiver);

  // Boxes and elements looked at so far.
  double tests() const { return tests_; }

  // For the walk, in vector code (gather.cc).
  const Bvh& bvh() const { return bvh_; }
  const Envelope& envelope() const { return envelope_; }
  // What is seen of a straight element, if nothing hides it; others are added at once.
  const SightBetween* See(const Bvh::Slot& slot, bool straight);
  // Adds what See returned.
  void Add(const SightBetween& seen) {
    elements_.push_back(seen.sight.element);
    envelope_.Add();
  }
  void AddTests(double tests) { tests_ += tests; }

 private:
  void Start(const Receiver& receiver);
  void AddParts(ElementId element);

  const Scene& scene_;
  const Bvh& bvh_;
  const Receiver* receiver_ = nullptr;
  bool left_handed_ = false;
  std::uint32_t own_carrier_ = 0;
  bool has_own_ = false;
  Envelope envelope_;
  std::vector<ElementId> elements_;
  std::deque<Part> parts_;  // Keeps its places.
  std::size_t used_parts_ = 0;
  std::vector<Part> in_doubt_;
  double tests_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_GATHER_H_
