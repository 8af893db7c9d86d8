// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_EXACT_SWEEP_H_
#define FLATLIGHT_CORE_PLANE_EXACT_SWEEP_H_

#include <cstdint>
#include <vector>

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
  explicit Sweep(const Scene& scene) : scene_(scene) {}

  // In the order of theta; the last interval sees nothing. Valid until the next call.
  const std::vector<VisibleInterval>& Run(const std::vector<Part>& parts, const Receiver& receiver);

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
  std::int32_t Nearest(double key, EdgeOn edge_on) const;
  bool IsEdgeOn(const Part& part) const;
  // Between two edges in one direction.
  void ResolveCoinciding(const Edge& from, const Edge& to);
  bool InFront(std::uint32_t p, std::uint32_t other, double key, double distance) const;
  // The same of parts that pass through the receiver: which one is nearer as it moves on.
  bool InFrontOnward(std::uint32_t p, std::uint32_t other, double key) const;
  double DistanceOf(std::uint32_t part, double key) const;
  // How far an edge's key may be off.
  double Uncertainty(const Edge& edge) const;
  void Emit(const Edge& from, std::int32_t part);
  // What parts the last visible part from the next: `from`, unless they cross in its direction.
  Edge BreakBetween(const Edge& from, std::int32_t part) const;
  // Directions strictly between two edges where an active arc crosses another active part.
  void FindArcCrossings(double low, double high);
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
  std::vector<Edge> arc_crossings_;
  std::vector<Edge> crossings_;
  std::vector<VisibleInterval> visible_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_SWEEP_H_
