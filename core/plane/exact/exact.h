// SPDX-License-Identifier: Apache-2.0
// Direct irradiance with occlusion and its derivatives, in closed form.
//
// In the plane the irradiance from a piece of constant radiance L seen between the directions theta_a and theta_b is
// L (sin theta_b - sin theta_a), whatever its shape; so E and its derivatives are sums over the visible pieces' end
// directions. Jarosz et al. 2012, "Theory, Analysis and Applications of 2D Global Illumination"; curved receivers and
// silhouettes of arcs are derived here (see Derive in edge.h).
#ifndef FLATLIGHT_CORE_PLANE_EXACT_EXACT_H_
#define FLATLIGHT_CORE_PLANE_EXACT_EXACT_H_

#include <optional>
#include <vector>

#include "core/plane/bvh.h"
#include "core/plane/exact/gather.h"
#include "core/plane/exact/sweep.h"
#include "core/plane/triangulation/triangulation.h"
#include "core/plane/triangulation/view.h"
#include "core/scene/scene.h"

namespace flatlight {

// Of curves that emit, and of the environment. Normalised units: radiance; radiance per length; radiance per length
// squared. Of a receiver that sums up radiance by angle the sum stands for irradiance, and there are no derivatives.
// Derivatives are per arc length along the receiver's tangent, its curvature included; at a visibility event toward
// increasing arc length.
struct ExactValue {
  Spectrum irradiance;
  Spectrum gradient;
  Spectrum hessian;
  // Per radian that the normal turns toward the tangent, the point fixed. With the gradient.
  Spectrum rotation;
  // Bounds on the distance from the truth: rounding of coordinates and of the sums.
  Spectrum irradiance_error;
  Spectrum gradient_error;
  Spectrum hessian_error;
  Spectrum rotation_error;

  // For a stream of states (see core/render/state_stream.h).
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.irradiance, self.gradient, self.hessian, self.rotation, self.irradiance_error, self.gradient_error,
           self.hessian_error, self.rotation_error);
  }
};

struct ExactOptions {
  int derivatives = 2;  // 0: irradiance alone; 1: and the gradient and rotation; 2: and the Hessian.
  // False where nothing can stand between an emitter and a receiver: the search is left out. Needed if the environment
  // shines.
  bool occlusion = true;
  int channels = kMaxChannels;  // The first ones are computed, the others get the first one's values.
};

// Holds working memory: one for each thread.
class ExactSolver {
 public:
  // With a triangulation (see Triangulation::coordinate_error), what it can decide is found in it, and the rest in the
  // tree. The values are the same; those of the first kind come sooner.
  ExactSolver(const Scene& scene, const Bvh& bvh, ExactOptions options, const Triangulation* triangulation = nullptr);

  ExactValue Evaluate(const Receiver& receiver) {
    ExactValue value;
    Evaluate(receiver, value);
    return value;
  }
  // The same in its place, where many are kept: what has just been written in parts is slow to be copied.
  void Evaluate(const Receiver& receiver, ExactValue& value);

  // Boxes, elements and triangles looked at so far.
  double tests() const { return gatherer_.tests() + (view_ ? view_->steps() : 0); }
  // Points so far that were left to the tree, though there is a triangulation.
  double undecided() const { return undecided_; }

 private:
  // What the last sum needs of an element, close together.
  struct Emission {
    double first_channel;
    bool front;
    bool back;
  };

  template <int kChannels>
  void Add(const Receiver& receiver, ExactValue& value);
  // False if the triangulation cannot decide what is seen; `value` is then as it was.
  template <int kChannels>
  bool AddView(const Receiver& receiver, ExactValue& value);
  // The light that may be left out, or put in, beside a vertex of the triangulation.
  template <int kChannels>
  void AddSlit(std::uint32_t vertex, const Receiver& receiver, ExactValue& value) const;
  // The edge at a vertex of the triangulation, above the horizon.
  void SetEdgeAt(std::uint32_t vertex, const Receiver& receiver, Edge& edge) const;
  template <int kChannels>
  void AddEnvelope(const Envelope& envelope, const Receiver& receiver, ExactValue& value) const;
  template <int kChannels>
  void AddIntervals(const std::vector<VisibleInterval>& intervals, const std::vector<Part>& parts,
                    const Receiver& receiver, ExactValue& value) const;
  // Whether an interval shows what is behind two ends that touch.
  bool IsSlit(const std::vector<VisibleInterval>& intervals, std::size_t i, const std::vector<Part>& parts,
              const Receiver& receiver) const;
  // What may be seen between an interval's edge and the last one's, where rounding decides whether anything is: of two
  // edges in one direction and at one distance, and of two things side by side that end in one place to rounding only.
  template <int kChannels>
  void AddUndecided(const std::vector<VisibleInterval>& intervals, std::size_t i, const std::vector<Part>& parts,
                    const Receiver& receiver, ExactValue& value) const;
  // What light between two edges makes of irradiance and its derivatives.
  template <int kChannels>
  void AddDifference(const Edge& a, const Edge& b, const Receiver& receiver, ExactValue& value) const;
  // What up to so much light may change if it comes, or does not, from beside an edge, no farther from it than the
  // accuracy of coordinates and `wide`.
  template <int kChannels>
  void AddDoubt(const Edge& edge, double wide, const Spectrum& most, const Receiver& receiver, ExactValue& value) const;
  template <int kChannels>
  void AddMeetings(const Receiver& receiver, ExactValue& value) const;

  const Scene& scene_;
  ExactOptions options_;
  Gatherer gatherer_;
  Sweep sweep_;
  const Triangulation* triangulation_;
  std::optional<View> view_;
  double undecided_ = 0;
  Spectrum brightest_;               // Of all that is seen anywhere.
  std::vector<Emission> emissions_;  // By element.
  std::vector<Bvh::Slot> emitters_;  // Where occlusion is left out.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_EXACT_H_
