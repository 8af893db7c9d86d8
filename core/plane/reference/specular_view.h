// SPDX-License-Identifier: Apache-2.0
// What a receiver sees over mirrors and through glass.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_SPECULAR_VIEW_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_SPECULAR_VIEW_H_

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <queue>
#include <vector>

#include "core/plane/chains/beam_cuts.h"
#include "core/plane/chains/chain_link.h"
#include "core/plane/chains/line_family.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/bezier_span.h"
#include "core/scene/scene.h"

namespace flatlight {

// A way from the receiver, against the light.
struct SpecularWay {
  std::vector<ChainLink> links;
  Spectrum tint = Spectrum::Grey(1);  // Product of the mirrors' reflectances.
  // Radiance is larger where light is slower: index of refraction at the receiver over that behind the last link
  // (THEORY 17 A6).
  double compression = 1;
  bool straight = true;  // Plane mirrors alone.
  // The receiver as plane mirrors show it: those of the first links that are, in a row.
  Point2 image;
  Vector2 tangent, normal;
  std::shared_ptr<const BezierSpans> spans;  // Of the scene: turnings point to them.
  // Of the links after them, what it takes to follow rays.
  struct Turning {
    const Element* element = nullptr;
    const BezierSpan* span = nullptr;  // In place of the element, if it follows a Bézier.
    bool front_side = false;           // On which side that is met.
    Vector2 front;                     // Unit normal of a segment.
    double ior = 1;
    double inverse_ior = 1;
    bool glass = false;
    bool far = false;
    bool crosses = false;
    bool own_circle = false;  // Rays come from the circle of the same arc.
  };
  std::vector<Turning> turnings;
};

// Where a ray from the receiver is behind the last link, and how much of the radiance that comes from there reaches the
// receiver along it, but for the tint.
struct SpecularRay {
  Point2 from;
  Vector2 direction;
  double share = 1;
  double place = 0;  // Where it starts on a Bézier's span, if it does.
};

// Of the direction theta, from the receiver's normal toward its tangent. Absent if it misses a link's line or circle,
// or is totally reflected where it should cross.
std::optional<SpecularRay> FollowWay(const Scene& scene, const SpecularWay& way, double theta);

// Where rays of a way start behind it: on its last link or, without one, on the receiver's element.
ElementId LastOf(const Receiver& receiver, const SpecularWay& way);
// Whether rays go on from an element, by reflection or passage.
bool TurnsAt(const Scene& scene, ElementId element);
// Of the indices of refraction behind a curve and before it, for light that comes from a side; 1 for mirrors.
double IndexRatio(const Material& material, Side side);

// Whether an element is an arc on whose circle the way's rays begin: at its last link or, without one, the receiver.
bool ComesFromCircle(const Scene& scene, const Receiver& receiver, const SpecularWay& way, ElementId element);

// The way that a ray goes on to the line or circle of what it meets, `far` as in ChainLink.
std::optional<double> DistanceBehind(const Scene& scene, const Receiver& receiver, const SpecularWay& way,
                                     const SpecularRay& ray, ElementId element, bool far);

// Why a stretch of directions ends where it does: so its end moves as the receiver does.
struct MovingEnd {
  // A stretch that is cut for no such reason: at places that keep their parts of it.
  struct Between {
    double begin = 0, end = 0;
    std::shared_ptr<const MovingEnd> begins, ends;  // Null: do not move.
  };

  std::shared_ptr<const SpecularWay> way;  // Of the ray that ends it.
  LineMark mark;                           // That ray passes this behind the last link;
  // or, if there is a border, all rays beyond are reflected totally there;
  ElementId border = ElementId::kNone;
  Side side = Side::kFront;             // on which the border is met,
  bool far = false;                     // and where, as in ChainLink;
  std::optional<Between> between = {};  // or all this is nothing.
};

// Directions theta by a number in [0, 1] of which all that follows is a smooth function.
struct Directions {
  double from = 0;  // Theta or, if there is an outer, numbers of that.
  double to = 0;
  // Where rays touch an arc, or begin to be reflected totally, what follows moves as the root of theta; a cubic that is
  // level at its ends makes that smooth there.
  bool eased = false;
  std::shared_ptr<const Directions> outer;
  std::shared_ptr<const MovingEnd> begins = {}, ends = {};  // What from and to move with; null: they do not.

  // The number by which the outer knows the direction; theta, if there is none.
  double Outward(double x) const { return from + (to - from) * (eased ? x * x * (3 - 2 * x) : x); }
  double At(double x) const { return outer ? outer->At(Outward(x)) : Outward(x); }
  // Directions nearer to each other are the same but for rounding; numbers that differ by no more have such directions.
  static constexpr double kSameDirection = 4e-15;
  double Indistinct(double x) const;
  // d(theta)/dx.
  double Slope(double x) const {
    const double slope = (to - from) * (eased ? 6 * x * (1 - x) : 1);
    return outer ? outer->Slope(Outward(x)) * slope : slope;
  }
};

// What is seen by one way, in an interval of directions.
struct SpecularPiece {
  std::shared_ptr<const SpecularWay> way;
  ElementId element = ElementId::kNone;  // kNone: the environment.
  Side side = Side::kFront;
  bool far = false;
  std::shared_ptr<const Directions> directions;
  LineFamily lines;  // By the number of a direction, behind the last link.
  double begin = 0;  // Of the piece: numbers, too.
  double end = 0;
  std::shared_ptr<const MovingEnd> begins, ends;  // What these move with; null: they do not.
};

// What a piece holds, its way included, about.
std::size_t BytesOf(const SpecularPiece& piece);

// Ways that are not followed further.
struct UnfollowedBeam {
  std::shared_ptr<const Directions> directions;
  double begin = 0, end = 0;
  std::shared_ptr<const MovingEnd> begins, ends;
  double share = 0;  // Of radiance that could come, at most: times the difference of sines it is what is lost.
};

// What is seen from a point over mirrors and through glass.
struct SpecularSight {
  std::vector<SpecularPiece> pieces;
  // What else could have come: irradiance per radiance, in beams that are not followed, beside rays that fail and where
  // it is not known what is met.
  double lost = 0;
  std::vector<UnfollowedBeam> unfollowed;  // Those beams, where derivatives are wanted.

  std::size_t bytes() const;
};

// Whether a curve of the scene is a mirror or glass.
bool HasSpecular(const Scene& scene);
// Whether all that reflects is Lambertian, a mirror or glass, and what is seen over these can be followed: there are no
// lights without a surface then.
bool CanFollow(const Scene& scene);

struct SpecularViewOptions {
  // Ways are followed as long as they can carry so much irradiance per radiance, and there are not so many of them.
  double least_share = 1e-10;
  std::size_t most_ways = 1 << 14;
};

// Follows families of rays from the receiver. What a family meets first changes only where one of its rays passes an
// end of a piece, touches an arc or goes through a point that two pieces have in common: all these are roots, so that
// nothing is missed, however small. Holds working memory: one for each thread.
class SpecularView {
 public:
  // The caster must outlive this.
  SpecularView(const RayCaster& caster, const SpecularViewOptions& options);

  void set_least_share(double least_share) { options_.least_share = least_share; }

  // What emits or reflects by Lambertian curves, and the environment, over at least one link. In no order that means
  // anything. Valid until the next call.
  const std::vector<SpecularPiece>& From(const Receiver& receiver);
  // What ways that were not followed further could have brought the receiver of the last call: irradiance per radiance.
  double lost() const { return lost_; }
  const std::vector<UnfollowedBeam>& unfollowed() const { return unfollowed_; }

 private:
  struct Beam {
    std::shared_ptr<const SpecularWay> way;
    std::shared_ptr<const Directions> directions;
    LineFamily lines;
    double begin = 0, end = 0;
    std::shared_ptr<const MovingEnd> begins = {}, ends = {};
    double share = 0;   // The largest of its rays, about.
    double weight = 0;  // About the most irradiance per radiance that it can carry.
    std::size_t number = 0;
  };
  struct Weaker {
    bool operator()(const Beam& a, const Beam& b) const {
      return a.weight < b.weight || (a.weight == b.weight && a.number > b.number);
    }
  };
  struct Met {
    ElementId element = ElementId::kNone;
    Side side = Side::kFront;
    bool far = false;
    bool doubtful = false;  // What is met is not known.
    double distance = 0;    // Of some ray that meets it.
    friend bool operator==(const Met& a, const Met& b) {
      return a.element == b.element && a.side == b.side && a.far == b.far && a.doubtful == b.doubtful;
    }
  };

  void Grow(const Receiver& receiver, const Beam& beam);
  void FindCuts(const Receiver& receiver, const Beam& beam, Cuts& cuts) const;
  std::optional<Met> MetBy(const Receiver& receiver, const Beam& beam, double x) const;
  // Most irradiance per radiance of a part of a beam's rays.
  double MostOf(const Beam& beam, double begin, double end) const;
  bool IsNarrow(const Beam& beam, double from, double to) const;
  // Most irradiance per radiance of those that may meet the other thing, for elements are not quite where the Béziers
  // are that they follow: at the number where a beam passes from one thing to another.
  double DoubtAt(const Receiver& receiver, const Beam& beam, const Met& before, const Met& after, double x) const;
  std::optional<double> DistanceTo(const Receiver& receiver, const Beam& beam, const Met& met,
                                   const SpecularRay& ray) const;
  // Of a beam.
  struct Stretch {
    double begin = 0, end = 0;
    std::shared_ptr<const MovingEnd> begins, ends;
  };
  void Meet(const Receiver& receiver, const Beam& beam, const Met& met, const Stretch& stretch);
  void Turn(const Receiver& receiver, const Beam& beam, const Met& met, bool crosses, const Stretch& stretch);
  // Square of the cosine to the normal behind the border that is met, if `behind`, or before it; negative where all is
  // reflected.
  std::optional<double> SquaredCosine(const Receiver& receiver, const Beam& beam, const Met& met, bool behind,
                                      double x) const;
  // The same at the places that a polynomial goes through between two numbers; absent if one of them is.
  std::optional<std::array<double, Bernstein::kCount>> SquaresBehind(const Receiver& receiver, const Beam& beam,
                                                                     const Met& met, double from, double to) const;
  // Pushes the beams of a way's rays in a stretch of directions; as LineFamily::Fit. What is given up is not followed:
  // `worth` times its part of the half circle may be lost.
  template <typename Hopeful>
  void Fan(const std::shared_ptr<const SpecularWay>& way, const std::shared_ptr<const Directions>& directions,
           const Stretch& stretch, double worth, const Hopeful& hopeful, const LineFit& fit);
  void Push(Beam beam);

  const RayCaster& caster_;
  const Scene& scene_;
  SpecularViewOptions options_;
  std::shared_ptr<const BezierSpans> spans_;
  double growth_;                  // Of radiance, where light goes on to where it is slower.
  std::vector<Point2> crossings_;  // Points that two elements have in common, inside both.
  std::priority_queue<Beam, std::vector<Beam>, Weaker> beams_;
  std::size_t numbers_ = 0;
  std::vector<SpecularPiece> pieces_;
  double lost_ = 0;
  std::vector<UnfollowedBeam> unfollowed_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_SPECULAR_VIEW_H_
