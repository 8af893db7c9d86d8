// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/minimise.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

#include "core/math/trig.h"

namespace flatlight::stress {
namespace {

double Rounded(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.*e", digits - 1, value);
  return std::strtod(text, nullptr);
}

class Minimiser {
 public:
  using Fails = std::function<bool(const SceneDescription&)>;
  Minimiser(SceneDescription scene, const Fails& fails, int calls)
      : best_(std::move(scene)), fails_(fails), calls_(calls) {}

  SceneDescription Run() {
    for (bool smaller = true; smaller && calls_ > 0;) {
      smaller = DropProbes();
      smaller = DropCurves() || smaller;
      smaller = SimplifyCurves() || smaller;
    }
    DropMaterials();
    RoundNumbers();
    return std::move(best_);
  }

 private:
  bool Try(SceneDescription candidate) {
    if (calls_ <= 0) return false;
    --calls_;
    if (!fails_(candidate)) return false;
    best_ = std::move(candidate);
    return true;
  }

  // Leaves out runs of items, long ones first.
  template <typename Items>
  bool Drop(Items items_of) {
    bool any = false;
    for (std::size_t run = std::max<std::size_t>(items_of(best_).size() / 2, 1);; run /= 2) {
      for (std::size_t first = 0; first < items_of(best_).size() && calls_ > 0;) {
        SceneDescription candidate = best_;
        auto& items = items_of(candidate);
        const auto begin = items.begin() + static_cast<std::ptrdiff_t>(first);
        items.erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(run, items.size() - first)));
        if (Try(std::move(candidate))) {
          any = true;
        } else {
          first += run;
        }
      }
      if (run == 1) return any;
    }
  }

  bool DropCurves() {
    return Drop([](SceneDescription & scene) -> auto& { return scene.curves; });
  }

  bool DropProbes() {
    bool any = Drop([](SceneDescription & scene) -> auto& { return scene.probes; });
    for (std::size_t p = 0; p < best_.probes.size(); ++p) {
      if (!best_.probes[p].curve) {
        any = Drop([p](SceneDescription & scene) -> auto& { return scene.probes[p].points; }) || any;
        continue;
      }
      // One point of many, where it was.
      const std::uint32_t count = *best_.probes[p].count;
      const double from = best_.probes[p].from.value_or(0), to = best_.probes[p].to.value_or(1);
      for (std::uint32_t i = 0; count > 1 && i < count; ++i) {
        SceneDescription candidate = best_;
        candidate.probes[p].count = 1;
        candidate.probes[p].from = from + i * (to - from) / count;
        candidate.probes[p].to = from + (i + 1) * (to - from) / count;
        if (Try(std::move(candidate))) {
          any = true;
          break;
        }
      }
    }
    return any;
  }

  bool SimplifyCurves() {
    bool any = false;
    for (std::size_t c = 0; c < best_.curves.size(); ++c) {
      const auto change = [&](auto edit) {
        SceneDescription candidate = best_;
        edit(candidate.curves[c]);
        any = Try(std::move(candidate)) || any;
      };
      if (const auto* arc = std::get_if<ArcDescription>(&best_.curves[c].shape)) {
        const auto at = [&](double angle) {
          const SinCosValue turn = SinCos(angle);
          return arc->center + arc->radius * Vector2{turn.cos, turn.sin};
        };
        change([&, chord = SegmentDescription{at(arc->start_angle), at(arc->start_angle + arc->sweep_angle)}](
                   CurveDescription& curve) { curve.shape = chord; });
      }
      if (const auto* polyline = std::get_if<PolylineDescription>(&best_.curves[c].shape)) {
        if (polyline->points.size() == 2) {
          change([&, a = polyline->points[0], b = polyline->points[1]](CurveDescription& curve) {
            curve.shape = SegmentDescription{a, b};
          });
        } else {
          any = Drop([c](SceneDescription & scene) -> auto& {
                  static std::vector<Point2> none;
                  auto* shape = std::get_if<PolylineDescription>(&scene.curves[c].shape);
                  return shape ? shape->points : none;
                }) ||
                any;
          if (std::get<PolylineDescription>(best_.curves[c].shape).closed) {
            change([](CurveDescription& curve) { std::get<PolylineDescription>(curve.shape).closed = false; });
          }
        }
      }
      if (best_.curves[c].emission) {
        change([](CurveDescription& curve) { curve.emission.reset(); });
      }
      if (best_.curves[c].emission && best_.curves[c].emission->radiance != std::vector<double>{1}) {
        change([](CurveDescription& curve) { curve.emission->radiance = {1}; });
      }
      if (best_.curves[c].emission && best_.curves[c].emission->two_sided) {
        change([](CurveDescription& curve) { curve.emission->two_sided = false; });
      }
    }
    return any;
  }

  void DropMaterials() {
    SceneDescription candidate = best_;
    candidate.materials = {{"black", LambertianDescription{{0}}}};
    for (CurveDescription& curve : candidate.curves) curve.material = "black";
    if (Try(std::move(candidate))) return;
    Drop([](SceneDescription & scene) -> auto& { return scene.materials; });
  }

  static std::vector<double*> NumbersOf(SceneDescription& scene) {
    std::vector<double*> numbers;
    const auto add = [&](Point2& p) { numbers.insert(numbers.end(), {&p.x, &p.y}); };
    for (CurveDescription& curve : scene.curves) {
      if (auto* segment = std::get_if<SegmentDescription>(&curve.shape)) {
        add(segment->a), add(segment->b);
      } else if (auto* polyline = std::get_if<PolylineDescription>(&curve.shape)) {
        for (Point2& point : polyline->points) add(point);
      } else if (auto* arc = std::get_if<ArcDescription>(&curve.shape)) {
        add(arc->center);
        numbers.insert(numbers.end(), {&arc->radius, &arc->start_angle, &arc->sweep_angle});
      }
    }
    for (ProbeDescription& probe : scene.probes) {
      for (ProbePointDescription& point : probe.points) {
        add(point.position);
        numbers.insert(numbers.end(), {&point.normal.x, &point.normal.y});
      }
    }
    return numbers;
  }

  void RoundNumbers() {
    // All at once first, then one by one.
    for (const int digits : {1, 2, 3, 4, 6, 8, 10, 12}) {
      SceneDescription candidate = best_;
      for (double* number : NumbersOf(candidate)) *number = Rounded(*number, digits);
      if (Try(std::move(candidate))) return;
    }
    for (std::size_t i = 0; i < NumbersOf(best_).size(); ++i) {
      for (const int digits : {1, 2, 3, 5, 8, 12}) {
        SceneDescription candidate = best_;
        double& number = *NumbersOf(candidate)[i];
        const double rounded = Rounded(number, digits);
        if (rounded == number) break;
        number = rounded;
        if (Try(std::move(candidate))) break;
      }
    }
  }

  SceneDescription best_;
  const Fails& fails_;
  int calls_;
};

}  // namespace

SceneDescription Minimised(SceneDescription scene, const std::function<bool(const SceneDescription&)>& fails,
                           int most_calls) {
  return Minimiser(std::move(scene), fails, most_calls).Run();
}

}  // namespace flatlight::stress
