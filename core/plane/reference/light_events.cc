// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/light_events.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>

namespace flatlight {
namespace {

// From a corner on, beyond the curves that meet there, and off a circle that is touched.
constexpr double kBeyond = 1e-9;
// Within this of where a shadow's edge seems to be, in the chart, it is looked for.
constexpr double kAround = 1e-6;

class Finder {
 public:
  Finder(const RayCaster& caster, const std::vector<Chart>& charts)
      : caster_(caster), charts_(charts), events_(charts.size()) {}

  void Add(const Light& light) {
    light_ = &light;
    const auto* point = std::get_if<PointLight>(&light.kind);
    for (std::size_t i = 0; i < charts_.size(); ++i) {
      const Element& e = caster_.scene().elements()[i];
      for (const Point2 corner : {e.a, e.b}) {
        const Vector2 away = point ? corner - point->position : std::get<DirectionalLight>(light.kind).direction;
        const double length = Length(away);
        if (length > 0) Land(corner + (kBeyond / length) * away, away);
      }
      if (e.kind == Element::Kind::kSegment) continue;
      // Where the light's rays touch the circle: cos(angle from the line to the light) = radius / distance.
      double cosine = 0;
      Vector2 toward;
      if (point) {
        toward = point->position - e.center;
        const double distance = Length(toward);
        if (!(distance > e.radius)) continue;
        cosine = e.radius / distance;
        toward = toward / distance;
      } else {
        toward = -std::get<DirectionalLight>(light.kind).direction;
      }
      const double sine = std::sqrt(1 - cosine * cosine);
      for (const double sign : {-1.0, 1.0}) {
        const Point2 touch = e.center + e.radius * (cosine * toward + (sign * sine) * Left(toward));
        const double u = charts_[i].Find(touch);
        if (!(u > 0 && u < 1)) continue;
        events_[i].push_back(u);
        Land(touch + kBeyond * (touch - e.center), point ? touch - point->position : -toward);
      }
    }
  }

  std::vector<std::vector<double>> Take() { return std::move(events_); }

 private:
  bool IsLit(std::size_t element, double u) const {
    const SurfacePoint at = {charts_[element].At(u).position, static_cast<ElementId>(element)};
    if (const auto* point = std::get_if<PointLight>(&light_->kind))
      return caster_.Visible(at, {point->position, ElementId::kNone});
    return !caster_.ClosestHit(at, -std::get<DirectionalLight>(light_->kind).direction).has_value();
  }

  // The edge of a shadow that falls from there.
  void Land(Point2 from, Vector2 direction) {
    const auto hit = caster_.ClosestHit({from, ElementId::kNone}, direction);
    if (!hit) return;
    const auto element = static_cast<std::size_t>(hit->element);
    const double u = charts_[element].Find(hit->position);
    double low = std::max(u - kAround, 0.0), high = std::min(u + kAround, 1.0);
    const bool lit = IsLit(element, low);
    if (IsLit(element, high) == lit) return;
    for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high))
      (IsLit(element, middle) == lit ? low : high) = middle;
    events_[element].push_back(high);
  }

  const RayCaster& caster_;
  const std::vector<Chart>& charts_;
  const Light* light_ = nullptr;
  std::vector<std::vector<double>> events_;
};

}  // namespace

std::vector<std::vector<double>> LightEvents(const RayCaster& caster, const std::vector<Chart>& charts) {
  Finder finder(caster, charts);
  for (const Light& light : caster.scene().lights()) finder.Add(light);
  return finder.Take();
}

}  // namespace flatlight
