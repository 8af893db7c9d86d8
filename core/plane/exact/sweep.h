// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_EXACT_SWEEP_H_
#define FLATLIGHT_CORE_PLANE_EXACT_SWEEP_H_

#include <cstdint>
#include <vector>

#include "core/plane/exact/far_filter.h"
#include "core/plane/exact/part.h"
#include "core/scene/scene.h"

namespace flatlight {

// From `begin` on, up to the next interval's, the receiver sees `part`.
struct VisibleInterval {
  Edge begin;
  std::int32_t part = kNothing;  // Index into the parts given.
  Side side = Side::kFront;      // Which side of the part's element is seen.
  static constexpr std::int32_t kNothing = -1;
};

// Finds which part is nearest in each direction, by turning a ray from horizon to horizon.
//
// Edges whose directions coincide, to the accuracy of the coordinates, are put in the order they have just beyond the
// receiver, toward increasing arc length (near ones first). So derivatives at a visibility event are one-sided that
// way, and a piece seen edge-on gets its place.
class Sweep {
 public:
  explicit Sweep(const Scene& scene) : scene_(scene), far_filter_(scene) {}

  // In the order of theta; the last interval sees nothing. Valid until the next call.
  const std::vector<VisibleInterval>& Run(const std::vector<Part>& parts, const Receiver& receiver);

  // Where two parts meet so that rounding decides which is seen, for as far as the edge's errors say. Of the last run.
  struct Meeting {
    Edge edge;
    ElementId first;
    ElementId second;
  };
  const std::vector<Meeting>& meetings() const { return meetings_; }

  // Parts that were compared with another one so far.
  double comparisons() const { return comparisons_; }

 private:
  struct Break {
    const Edge* edge;
    std::uint32_t part;
    double uncertain;  // Of the key.
  };

  void SortBreaks(double curvature);
  void Resolve(const Edge& from, const Edge& to, int depth);
  enum class EdgeOn { kCount, kLeaveOut };
  // Of the active parts, in the direction of a key.
  std::int32_t Nearest(double key, EdgeOn edge_on);
  bool IsEdgeOn(const Part& part) const;
  // Between two edges in one direction.
  void ResolveCoinciding(const Edge& from, const Edge& to);
  bool InFront(std::uint32_t p, std::uint32_t other, double key, double distance) const;
  // The same of parts that pass through the receiver: which one is nearer as it moves on.
  bool InFrontOnward(std::uint32_t p, std::uint32_t other) const;
  double DistanceOf(std::uint32_t part, double key) const;
  double DoubtOf(std::uint32_t part, double key, double distance) const;
  // Whether two distances in one direction may be those of curves that meet there.
  bool MayMeet(std::uint32_t p, double distance, std::uint32_t other, double other_distance, double key) const;
  // Looks for the place where another active part comes before `nearest` or meets it, seen from the direction of one of
  // the two edges between which that one is nearest in the middle.
  bool FindCrossing(std::uint32_t nearest, const Edge& from, const Edge& to, const Edge& at, Edge& crossing);
  void AddMeeting(std::uint32_t p, std::uint32_t other, const Edge& edge);
  // Of the nearest part with others, seen between two keys.
  void AddTangencies(std::uint32_t nearest, double low, double high);
  // How far an edge's key may be off.
  double Uncertainty(const Edge& edge) const;
  void Emit(const Edge& from, std::int32_t part);
  // What parts the last visible part from the next: `from`, unless they cross in its direction.
  Edge BreakBetween(const Edge& from, std::int32_t part) const;
  // The crossing of `nearest` with another active part, one of them an arc, that is next to the middle between two
  // keys.
  bool FindArcCrossing(std::uint32_t nearest, double low, double high, double middle, Edge& crossing);
  void AddCrossings(std::uint32_t first, std::uint32_t second, double low, double high,
                    std::vector<Edge>& crossings) const;

  const Scene& scene_;
  const std::vector<Part>* parts_ = nullptr;
  const Receiver* receiver_ = nullptr;
  bool left_handed_ = false;
  std::vector<Break> breaks_;
  std::vector<std::uint32_t> first_rank_;
  std::vector<std::uint32_t> last_rank_;
  std::vector<std::uint32_t> active_;
  std::vector<std::uint32_t> active_arcs_;
  FarFilter far_filter_;
  std::vector<Edge> crossings_;
  std::vector<VisibleInterval> visible_;
  std::vector<Meeting> meetings_;
  double comparisons_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_SWEEP_H_
