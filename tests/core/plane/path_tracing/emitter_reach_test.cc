// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/emitter_reach.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "core/plane/path_tracing/emitter_range.h"
#include "core/plane/path_tracing/emitter_sights.h"
#include "core/plane/ray_caster.h"
#include "core/scene/element_frame.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

// Lamps and screens of all kinds; a probe on each of the first few, and free points.
SceneMaker Stage(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-1, 1);
  std::uniform_real_distribution<double> unit(0, 1);
  SceneMaker maker;
  for (int i = 0; i < 9; ++i) {
    const std::string name = "curve " + std::to_string(i);
    Look look{.reflectance = {unit(random) < 0.5 ? 0.0 : 0.5}};
    if (i % 2 == 1) look.radiance = {1}, look.two_sided = unit(random) < 0.2;
    const Point2 a{place(random), place(random)};
    if (unit(random) < 0.7) {
      const double size = i % 2 == 1 ? 0.2 : 1.5;
      maker.Segment(name, a, a + Vector2{size * place(random), size * place(random)}, look);
    } else {
      const double sweep = unit(random) < 0.5 ? 2 * std::numbers::pi : 0.3 + 3 * unit(random);
      maker.Arc(name, {a, 0.1 + 0.3 * unit(random), 6 * unit(random), unit(random) < 0.5 ? sweep : -sweep}, look);
    }
    if (i == 0) maker.Probe(name, 5, unit(random) < 0.5 ? Side::kFront : Side::kBack);
  }
  if (unit(random) < 0.5) maker.PointProbe({place(random), place(random)}, {place(random), place(random)});
  return maker;
}

// What is said to light nothing must not matter: without it exact light is the same, at points and at reflectors.
TEST(EmitterReachTest, UnseenEmittersGiveNoDirectLight) {
  int unseen_by_points = 0;
  int unseen_by_reflectors = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const std::shared_ptr<const Scene> scene = Stage(seed).Build();
    const EmitterReach reach = ReachOfEmitters(*scene);
    const RayCaster caster(scene);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const EmitterReach::Piece& piece : reach.pieces) {
      const Element& emitter = scene->element(piece.id);
      const EmittingSides sides = scene->curve_of(piece.id).two_sided ? EmittingSides::kBoth : EmittingSides::kFront;
      // Tries to see the emitter from a vertex, by some rays.
      const auto sees = [&](const Vertex& vertex) {
        const EmitterRange range = RangeOf(emitter, sides, vertex);
        if (range.kind == EmitterRange::Kind::kNone) return false;
        for (int k = 0; k < 4; ++k) {
          SurfacePoint point{FrameAt(emitter, unit(random)).position, piece.id};
          if (range.kind == EmitterRange::Kind::kSines) {
            const double sine = range.low + unit(random) * range.width;
            point.position = PointInDirection(emitter, range, vertex, vertex.Direction(sine, CosineOf(sine)));
          }
          if (caster.Visible(vertex.at, point)) return true;
        }
        return false;
      };
      if (!piece.lights_points) {
        ++unseen_by_points;
        for (const Probe& probe : scene->probes())
          for (const Receiver& receiver : probe.receivers)
            EXPECT_FALSE(sees(VertexAt(*scene, receiver))) << "scene " << seed;
      }
      if (!piece.lights_reflectors) {
        ++unseen_by_reflectors;
        for (std::size_t e = 0; e < scene->elements().size(); ++e) {
          const Element& element = scene->elements()[e];
          if (scene->curve_of(static_cast<ElementId>(e)).reflectance.IsBlack()) continue;
          for (int k = 0; k < 4; ++k) {
            const ElementFrame frame = FrameAt(element, unit(random));
            for (const Vector2 normal : {frame.normal, -frame.normal}) {
              const Vertex vertex{{frame.position, static_cast<ElementId>(e)}, normal, element.carrier};
              EXPECT_FALSE(sees(vertex)) << "scene " << seed;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(unseen_by_points, 100);
  EXPECT_GT(unseen_by_reflectors, 100);
}

// Light that is called clear or hidden is, from points and from whole pieces, arcs included.
TEST(EmitterSightsTest, AgreeWithRays) {
  int clear = 0;
  int hidden = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const std::shared_ptr<const Scene> scene = Stage(seed).Build();
    const RayCaster caster(scene);
    std::vector<ElementId> emitters;
    for (std::size_t e = 0; e < scene->elements().size(); ++e) {
      const ElementId id = static_cast<ElementId>(e);
      if (scene->curve_of(id).Emits()) emitters.push_back(id);
    }
    const EmitterSights sights(caster, emitters);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (std::size_t e = 0; e < scene->elements().size(); ++e) {
      const Element& element = scene->elements()[e];
      for (int k = 0; k < 6; ++k) {
        const ElementFrame frame = FrameAt(element, unit(random));
        const Vector2 normal = unit(random) < 0.5 ? frame.normal : -frame.normal;
        const Vertex vertex{{frame.position, static_cast<ElementId>(e)}, normal, element.carrier};
        for (const EmitterSight& sight : {sights.FromPoint(vertex), sights.FromElement(vertex)}) {
          for (std::size_t i = 0; i < std::min(emitters.size(), EmitterSight::kMost); ++i) {
            const bool two_sided = scene->curve_of(emitters[i]).two_sided;
            const Element& emitter = scene->element(emitters[i]);
            const EmitterRange range =
                RangeOf(emitter, two_sided ? EmittingSides::kBoth : EmittingSides::kFront, vertex);
            if (range.kind != EmitterRange::Kind::kSines) continue;
            const bool is_clear = range.alone && ((sight.clear >> i) & 1) != 0;
            const bool is_hidden = ((sight.hidden >> i) & 1) != 0;
            clear += is_clear ? 1 : 0;
            hidden += is_hidden ? 1 : 0;
            for (int n = 0; n < 4; ++n) {
              const double sine = range.low + unit(random) * range.width;
              const SurfacePoint point{PointInDirection(emitter, range, vertex, vertex.Direction(sine, CosineOf(sine))),
                                       emitters[i]};
              const bool visible = caster.Visible(vertex.at, point);
              EXPECT_FALSE(is_clear && !visible) << "scene " << seed << " element " << e << " emitter " << i;
              EXPECT_FALSE(is_hidden && visible) << "scene " << seed << " element " << e << " emitter " << i;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(clear, 1000);
  EXPECT_GT(hidden, 100);
}

}  // namespace
}  // namespace flatlight
