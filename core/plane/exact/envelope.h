// SPDX-License-Identifier: Apache-2.0
// What a receiver sees in each direction, built up part by part: the lower envelope of their distances.
//
// It decides only what is certain: which of two parts is nearer is asked where both begin or end, with bounds on
// rounding. Where directions or distances agree to the accuracy of the coordinates it says so (`doubtful`), and leaves
// the decision to the sweep (sweep.h). It never hides what might be seen.
#ifndef FLATLIGHT_CORE_PLANE_EXACT_ENVELOPE_H_
#define FLATLIGHT_CORE_PLANE_EXACT_ENVELOPE_H_

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/plane/exact/edge.h"
#include "core/plane/exact/part.h"
#include "core/plane/exact/sectors.h"
#include "core/plane/exact/sight.h"
#include "core/scene/scene.h"

namespace flatlight {

class Envelope {
 public:
  explicit Envelope(const Scene& scene) : scene_(scene) {}

  void Start(const Receiver& receiver);
  // Where the next sight is to be written.
  SightBetween& Next() { return seen_[used_]; }
  // Adds the one in Next().
  void Add();

  // Whether everything at the keys [low, high] and at this squared distance or beyond is hidden.
  bool Hides(double low, double high, double near_squared) const;

  // Set once a decision would need more than bounds on rounding; the sectors then serve only to hide what is far
  // behind.
  bool doubtful() const { return doubtful_; }
  void SetDoubtful() { doubtful_ = true; }

  const Sectors& sectors() const { return sectors_; }
  const Sight& SightOf(const Sector& sector) const { return seen_[static_cast<std::size_t>(sector.sight)].sight; }
  // The edge where a sector begins; a vertex without its key.
  void SetEdge(const Sector& sector, Edge& edge) const {
    const SightEnd& end = End(sector.end);
    if (end.kind == SightEnd::Kind::kVertex) {
      SetVertexEdge(end.tangent, end.normal, end.point, edge);
      if (sector.end >= kCrossing) AddCrossingError(sector.end - kCrossing, edge);
      edge.crossing = end.crossing;
    } else {
      edge = end.kind == SightEnd::Kind::kHorizon ? HorizonEdge(end.tangent) : *end.edge;
    }
  }

 private:
  // Far above rounding, far below what would cost time.
  static constexpr double kSquareMargin = 1 - 1e-10;

  enum class Nearer { kYes, kNo, kEqual, kDoubt };
  // Whether one sight is in front of another between two ends: at first, and changing where they cross.
  struct Order {
    Nearer first = Nearer::kDoubt;
    int changes = 0;
    SightEnd crossings[2];
  };

  // Ends have numbers: a sight's two follow each other; those of crossings are counted from kCrossing on.
  static constexpr std::uint32_t kCrossing = 0x80000000;
  const SightEnd& End(std::uint32_t end) const {
    if (end >= kCrossing) return crossings_[end - kCrossing];
    const SightBetween& seen = seen_[end / 2];
    return end % 2 == 0 ? seen.low : seen.high;
  }
  void AddCrossingError(std::uint32_t crossing, Edge& edge) const;
  // Moves an end of a new part to the boundary between sectors that it coincides with.
  void Align(const Sight& sight, double inward, std::size_t at, double& key, std::uint32_t& end);
  bool IsBehind(const Sight& sight, std::size_t sector, const SightEnd& at) const;
  Nearer CompareAt(const Sight& sight, const Sight& other, const SightEnd& at) const;
  // Between two ends in which both are seen.
  void Compare(const Sight& sight, const Sight& other, const SightEnd& low, const SightEnd& high, Order& order) const;
  void CompareStraight(const Sight& sight, const Sight& other, const SightEnd& low, const SightEnd& high,
                       Order& order) const;
  void CompareBent(const Sight& sight, const Sight& other, const SightEnd& low, const SightEnd& high,
                   Order& order) const;
  // The points that two elements have in common strictly between two ends, in their order; -1 if that is uncertain.
  int Crossings(const Sight& sight, const Sight& other, const SightEnd& low, const SightEnd& high,
                SightEnd (&crossings)[2]) const;
  // Whether they touch, to the accuracy of the coordinates, in a direction between two keys.
  bool IsTangentBetween(const Element& e, const Element& f, double low, double high) const;
  Nearer CompareBetween(const Sight& sight, const Sight& other, double low, double high) const;
  // The sight takes the directions between two ends within a sector. Returns the last sector it touched.
  std::size_t Take(std::size_t sector, std::int32_t sight, double low, std::uint32_t low_end, double high,
                   std::uint32_t high_end);
  // The pieces of them in which it is in front.
  std::size_t TakePieces(std::size_t sector, std::int32_t sight, const Order& order, double from,
                         std::uint32_t from_end, double to, std::uint32_t to_end);
  double FarSquared(const Sight& sight, std::uint32_t low_end, std::uint32_t high_end) const;
  double FarAt(const Sight& sight, const SightEnd& end) const;
  double DistanceOf(const Sight& sight, double key) const;
  double DistanceDoubt(const Sight& sight, double key, double distance) const;

  const Scene& scene_;
  const Receiver* receiver_ = nullptr;
  bool doubtful_ = false;
  double most_uncertain_ = 0;
  Sectors sectors_;
  std::vector<SightBetween> seen_;  // The first one's ends are the horizon.
  std::size_t used_ = 0;
  std::vector<SightEnd> crossings_;
  std::vector<std::pair<ElementId, ElementId>> crossing_elements_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_ENVELOPE_H_
