// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/named_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "core/scene/description.h"
#include "core/scene/diagnostic.h"
#include "flatlight/v1/scene.pb.h"
#include "server/convert/describe_scene.h"
#include "server/convert/scene_reader.h"
#include "server/gallery/gallery.h"
#include "tests/bench/random_scenes.h"

namespace flatlight {
namespace {

[[noreturn]] void Stop(const Diagnostics& diagnostics) {
  for (const Diagnostic& mistake : diagnostics.kept())
    std::fprintf(stderr, "%s: %s\n", mistake.path.c_str(), mistake.message.c_str());
  std::exit(2);
}

class Maker {
 public:
  explicit Maker(std::string name) { scene_.name = std::move(name); }

  void Segment(Point2 a, Point2 b, double reflectance, double radiance = 0) {
    Add(SegmentDescription{a, b}, reflectance, radiance);
  }
  void Polyline(std::vector<Point2> points, bool closed, double reflectance) {
    Add(PolylineDescription{std::move(points), closed}, reflectance, 0);
  }
  // On the curve that was added last, its front.
  void Probe(std::uint32_t points) {
    ProbeDescription probe;
    probe.name = scene_.curves.back().name;
    probe.curve = scene_.curves.back().name;
    probe.count = points;
    scene_.probes.push_back(probe);
  }
  std::shared_ptr<const Scene> Build() const { return Built(scene_); }

 private:
  template <typename Shape>
  void Add(Shape shape, double reflectance, double radiance) {
    const std::string material = "reflects " + std::to_string(reflectance);
    if (std::none_of(scene_.materials.begin(), scene_.materials.end(),
                     [&](const auto& m) { return m.name == material; }))
      scene_.materials.push_back({material, LambertianDescription{{reflectance}}});
    CurveDescription curve;
    curve.name = "curve " + std::to_string(scene_.curves.size());
    curve.shape = std::move(shape);
    curve.material = material;
    if (radiance > 0) curve.emission = EmissionDescription{{radiance}};
    scene_.curves.push_back(std::move(curve));
  }

  SceneDescription scene_;
};

}  // namespace

std::vector<NamedScene> GalleryScenes(std::uint32_t points) {
  std::vector<NamedScene> scenes;
  for (const GalleryScene& from : Gallery()) {
    v1::Scene proto;
    Diagnostics diagnostics;
    if (!ReadSceneJson(from.json, proto, diagnostics)) Stop(diagnostics);
    SceneDescription description = DescribeScene(proto, diagnostics);
    if (!diagnostics.empty()) Stop(diagnostics);
    for (ProbeDescription& probe : description.probes) {
      if (probe.count) probe.count = std::min(*probe.count, points);
    }
    scenes.push_back({from.name, Built(description)});
  }
  return scenes;
}

std::shared_ptr<const Scene> ManyLamps(int lamps, double reflectance, std::uint32_t points) {
  Maker maker("many lamps");
  maker.Segment({0, 0}, {10, 0}, reflectance);
  maker.Probe(points);
  RandomNumbers random(7);
  const double size = 3 / std::sqrt(static_cast<double>(lamps));
  for (int i = 0; i < lamps; ++i) {
    const Point2 middle{10 * random.Next(), 0.5 + 9.5 * random.Next()};
    const double angle = std::numbers::pi * (0.75 + 0.5 * random.Next());  // Facing down, more or less.
    const double length = size * (0.1 + 0.4 * random.Next());
    const Vector2 half{0.5 * length * std::cos(angle), 0.5 * length * std::sin(angle)};
    // Powers over four decades.
    const double u = random.Next();
    maker.Segment(middle - half, middle + half, reflectance, std::exp(9.2 * u * u * u));
    if (i % 4 == 0) {
      const Point2 below = middle - Vector2{0.2 * size * random.Next(), 0.3 * size};
      maker.Segment(below - half, below + half, reflectance);
    }
  }
  return maker.Build();
}

std::shared_ptr<const Scene> City(int houses, double reflectance, std::uint32_t points) {
  Maker maker("city");
  maker.Segment({0, 0}, {static_cast<double>(houses), 0}, reflectance);
  maker.Probe(points);
  maker.Segment({static_cast<double>(houses), 6}, {0, 6}, reflectance, 0.2);
  RandomNumbers random(11);
  for (int i = 0; i < houses; ++i) {
    const double left = i + 0.2;
    const double right = i + 0.5 + 0.3 * random.Next();
    const double top = 0.5 + 3 * random.Next();
    const double ridge = top + 0.4 * random.Next();
    // Walls with the outside on their left, up the left one and down the right one.
    maker.Polyline({{right, 0.02}, {right, top}, {0.5 * (left + right), ridge}, {left, top}, {left, 0.02}}, false,
                   reflectance);
    for (double y = 0.3; y + 0.2 < top; y += 0.5) {
      if (random.Next() < 0.5)
        maker.Segment({right + 0.01, y + 0.15}, {right + 0.01, y}, reflectance, 3 * random.Next());
    }
  }
  return maker.Build();
}

std::shared_ptr<const Scene> RowOfRooms(int rooms, std::uint32_t points) {
  Maker maker("row of rooms");
  const double end = 2.0 * rooms;
  maker.Segment({0, 0}, {2, 0}, 0.7);
  maker.Probe(points);
  maker.Segment({2, 0}, {end, 0}, 0.7);
  maker.Segment({end, 0}, {end, 2}, 0.7);
  maker.Segment({end, 2}, {0, 2}, 0.7);
  maker.Segment({0, 2}, {0, 0}, 0.7);
  for (int i = 0; i < rooms; ++i) {
    const double left = 2.0 * i;
    maker.Segment({left + 1.2, 1.9}, {left + 0.8, 1.9}, 0.7, 4);
    if (i + 1 < rooms) maker.Segment({left + 2, 2}, {left + 2, 0.8}, 0.7);
  }
  return maker.Build();
}

std::shared_ptr<const Scene> ConvexRoom(int pieces, double reflectance, std::uint32_t points) {
  Maker maker("convex room");
  const auto corner = [&](int i) {
    const double angle = 2 * std::numbers::pi * i / pieces;
    return Point2{2 * std::cos(angle), std::sin(angle)};
  };
  for (int i = 0; i < pieces; ++i) {
    maker.Segment(corner(i), corner((i + 1) % pieces), reflectance, i == pieces / 4 ? 5 : 0);
    if (i == 3 * pieces / 4) maker.Probe(points);
  }
  return maker.Build();
}

std::shared_ptr<const Scene> TurnedLamps(std::uint32_t points) {
  Maker maker("turned lamps");
  maker.Segment({0, 0}, {4, 0}, 0);
  maker.Probe(points);
  maker.Segment({2.4, 2}, {1.6, 2}, 0.8, 5);
  maker.Segment({0, 1.2}, {1, 1.2}, 0);
  for (int i = 0; i < 12; ++i) {
    const double x = 0.3 * i;
    maker.Segment({x, 2.5}, {x + 0.2, 2.5}, 0, 3);  // Its front is up.
  }
  return maker.Build();
}

std::shared_ptr<const Scene> HalfBlackRoom(std::uint32_t points) {
  Maker maker("half black room");
  maker.Segment({0, 0}, {4, 0}, 0.8);
  maker.Probe(points);
  maker.Polyline({{4, 0}, {4, 3}, {0, 3}, {0, 0}}, false, 0);
  maker.Segment({2.5, 2.9}, {1.5, 2.9}, 0, 5);
  maker.Segment({1.2, 0.8}, {2.2, 0.8}, 0.5);
  return maker.Build();
}

std::shared_ptr<const Scene> NoLamp(std::uint32_t points) {
  Maker maker("no lamp");
  maker.Segment({0, 1}, {1, 1}, 0.5);
  maker.Segment({0, 0}, {1, 0}, 0.5);
  maker.Probe(points);
  return maker.Build();
}

}  // namespace flatlight
