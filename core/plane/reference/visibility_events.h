// SPDX-License-Identifier: Apache-2.0
// Where light along a curve may change its course: visibility events, and places near which something passes closely.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_VISIBILITY_EVENTS_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_VISIBILITY_EVENTS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/chart.h"

namespace flatlight {

struct EventPlace {
  std::size_t index = 0;  // PanelMesh::IndexOf the element and the side.
  double u = 0;           // In the element's chart.
  // How much the slope of irradiance may change there, by u, for light of radiance 1: the difference of the slopes of
  // the two sines that meet.
  double strength = 0;
  bool kink = false;  // The course of light does change there, it is not only steep.
};

// A line through two vertices, a vertex and a circle that it touches, or two such circles, that see each other there,
// goes on beyond both: where it lands the view gains or loses a piece (a kink of the light), and nowhere else. Between
// such places light is smooth; it may still be steep where a vertex or a circle is near, and so the foot below it and
// places around it count too, in steps that grow geometrically. Places that are no event may be among them.
class EventFinder {
 public:
  // `meetings`: places on each element where others meet it (see Meetings). The caster and the charts must outlive
  // this.
  EventFinder(const RayCaster& caster, const std::vector<Chart>& charts,
              const std::vector<std::vector<double>>& meetings);

  // Pieces of work: any of them may run at once.
  std::size_t count() const { return vertices_.size() + circles_.size(); }
  // Appends the places, on what reflects, that come of one and all that follow it.
  void Find(std::size_t i, std::vector<EventPlace>& places) const;

 private:
  struct Vertex {
    Point2 position;
    std::vector<Vector2> leaving;  // Unit, of the elements that end there.
    std::vector<ElementId> elements;
    bool crossed = false;  // A curve goes on through it: no line gets past.

    bool LetsPass(Vector2 direction) const;
  };
  struct Circle {
    Point2 center;
    double radius = 0;
    std::vector<ElementId> arcs;
  };
  // A line between two points that it touches or ends at.
  struct Candidate {
    Point2 from, to;  // A little inside of both, off circles.
    Vector2 direction;
    bool along = false;  // An element.
    bool passes_from = false, passes_to = false;
    EventPlace on_from, on_to;  // Of circles: where they are touched.
    bool touches_from = false, touches_to = false;
  };

  void AddVertices(const std::vector<std::vector<double>>& meetings);
  void AddCircles();
  bool TouchesAt(const Circle& circle, Point2 at, EventPlace& place) const;
  void AddCandidate(const Vertex* v, const Circle* c, Point2 at, const Vertex* w, const Circle* d, Point2 to,
                    std::vector<Candidate>& candidates) const;
  double Strength(const EventPlace& place, Vector2 direction, double near, double far) const;
  void LandAll(std::vector<Candidate>& candidates, std::vector<EventPlace>& places) const;
  void AddNear(Point2 p, const Vertex* vertex, const Circle* circle, std::vector<EventPlace>& places) const;
  bool JoinedTo(const Vertex& vertex, Point2 p) const;
  static void AddAround(std::size_t index, double place, double width, std::vector<EventPlace>& places);
  bool Reflects(ElementId id) const { return !scene_.curve_of(id).reflectance.IsBlack(); }

  const RayCaster& caster_;
  const Scene& scene_;
  const std::vector<Chart>& charts_;
  std::vector<Vertex> vertices_;
  std::vector<Circle> circles_;
};

// By PanelMesh::IndexOf, increasing, each once; but for those that change little along a whole element.
struct Event {
  double u = 0;
  double strength = 0;
};
using Events = std::vector<std::vector<Event>>;
Events SortedEvents(std::size_t elements, const std::vector<std::vector<EventPlace>>& found);
// Kinks alone, and weak ones too: where light is a polynomial to each side.
Events SortedKinks(std::size_t elements, const std::vector<std::vector<EventPlace>>& found);

// A stretch of a panel without an event inside, or so short that what happens there is as good as at one place.
struct Cell {
  double low = 0, high = 1;  // In the chart.
  double place = 0.5;
  double off = 0;  // What light there is off by, beside the polynomial of what is left over.
};
// Of the stretch from low to high; none if no event is inside that is strong there. (A weak one moves no narrow
// feature.)
std::vector<Cell> CellsBetween(const std::vector<Event>& events, double low, double high);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_VISIBILITY_EVENTS_H_
