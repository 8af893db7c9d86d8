// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/exact_contest.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include "core/plane/bvh.h"
#include "core/plane/exact/exact.h"
#include "core/plane/triangulation/triangulation.h"
#include "core/scene/scene.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/peers/cgal_visibility.h"
#include "tests/bench/peers/flatlight_scene.h"
#include "tests/bench/peers/visible_light.h"
#include "tests/bench/random_scenes.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kPoints = 1024;

struct World {
  std::vector<SegmentDescription> segments;  // Then the square's sides, the floor first.
  std::vector<double> radiance;
  std::vector<Point2> free_points;
  std::vector<Vector2> free_normals;
};

std::optional<World> MakeWorld(int size, double length, double emitting) {
  std::optional<std::vector<SegmentDescription>> apart = ScatteredApart(size, length, 1);
  if (!apart) return std::nullopt;
  World world{*std::move(apart), {}, {}, {}};
  RandomNumbers random(2);
  for (int i = 0; i < size; ++i) {
    const bool shines = random.Next() < emitting;
    world.radiance.push_back(shines ? 0.5 + random.Next() : 0);
  }
  const Point2 corner[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t i = 0; i < 4; ++i) {
    world.segments.push_back({corner[i], corner[(i + 1) % 4]});
    world.radiance.push_back(0);
  }
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const double x = random.Next(), y = random.Next(), angle = 2 * std::numbers::pi * random.Next();
    world.free_points.push_back({x, y});
    world.free_normals.push_back({std::cos(angle), std::sin(angle)});
  }
  return world;
}

// Probes: the free points, the same with opposite normals, the floor.
std::shared_ptr<const Scene> SceneOf(const World& world) {
  SceneDescription description = BlackSegments(world.segments);
  for (std::size_t i = 0; i < world.radiance.size(); ++i)
    if (world.radiance[i] > 0) description.curves[i].emission = EmissionDescription{{world.radiance[i]}};
  ProbeDescription front, back, floor;
  front.name = "front", back.name = "back", floor.name = "floor";
  for (std::size_t i = 0; i < world.free_points.size(); ++i) {
    front.points.push_back({world.free_points[i], world.free_normals[i]});
    back.points.push_back({world.free_points[i], -world.free_normals[i]});
  }
  floor.curve = description.curves[world.segments.size() - 4].name;
  floor.count = kPoints;
  description.probes = {front, back, floor};
  return BuiltOrExit(description);
}

// Which of the floor's points is asked for i-th: runs of neighbours, as a probe has them, that are spread over the
// floor, for what a point costs depends on where it is.
std::uint32_t FloorPlace(std::uint32_t i) {
  constexpr std::uint32_t kRun = 16, kRuns = kPoints / kRun, kStep = 25;  // Odd, and so prime to the number of runs.
  return i / kRun * kStep % kRuns * kRun + i % kRun;
}

std::vector<Point2> FloorPoints() {
  std::vector<Point2> points;
  for (std::uint32_t i = 0; i < kPoints; ++i) points.push_back({(FloorPlace(i) + 0.5) / kPoints, 0});
  return points;
}

std::vector<Receiver> FloorReceivers(const Scene& scene) {
  std::vector<Receiver> receivers;
  for (std::uint32_t i = 0; i < kPoints; ++i) receivers.push_back(scene.probes()[2].receivers[FloorPlace(i)]);
  return receivers;
}

// One way to ask both programs for light.
struct Question {
  std::string scene;
  std::vector<Point2> points;
  bool on_floor = false;
  std::vector<std::vector<Receiver>> receivers;  // Asked of Flatlight for each of CGAL's points.
};

class ExactCase {
 public:
  ExactCase(int size, const LengthRule& rule, World world)
      : size_(size),
        rule_(rule),
        world_(std::move(world)),
        scene_(SceneOf(world_)),
        bvh_(*scene_),
        triangulation_(Triangulation::Of(*scene_)),
        solver_(*scene_, bvh_, {2, true, scene_->channels()}, triangulation_.get()),
        cgal_({world_.segments.begin(), world_.segments.end() - 4}),
        light_(world_.segments, world_.radiance) {}

  bool Run(const ContestOptions& options, std::vector<Row>& rows) {
    const std::vector<Receiver>& front = scene_->probes()[0].receivers;
    const std::vector<Receiver>& back = scene_->probes()[1].receivers;
    bool agree = true;
    for (const Question& question :
         {Question{"light at free points", world_.free_points, false, {front}},
          Question{"light at free points both sides", world_.free_points, false, {front, back}},
          Question{"light on the floor", FloorPoints(), true, {FloorReceivers(*scene_)}}}) {
      agree = Ask(question, options, rows) && agree;
    }
    if (options.timing) TimeIndexes(rows);
    return agree;
  }

 private:
  // What both make before the first answer.
  void TimeIndexes(std::vector<Row>& rows) const {
    constexpr int kRounds = 5;
    const std::vector<SegmentDescription> inside(world_.segments.begin(), world_.segments.end() - 4);
    std::vector<double> ours, cgals, ratios;
    for (int round = 0; round < kRounds; ++round) {
      const double start = ThreadSeconds();
      const Bvh bvh(*scene_);
      const auto triangulation = Triangulation::Of(*scene_);
      const double between = ThreadSeconds();
      const CgalVisibility cgal(inside);
      const double end = ThreadSeconds();
      ours.push_back(size_ / (between - start)), cgals.push_back(size_ / (end - between));
      ratios.push_back(ours.back() / cgals.back());
    }
    const Quartiles ratio = QuartilesOf(ratios);
    const std::string name = "making the index for light";
    rows.push_back({"flatlight", name, size_, rule_.Name(), "segments/s", {QuartilesOf(ours).median, 1, 1, 1}, 0});
    rows.push_back({"cgal",
                    name,
                    size_,
                    rule_.Name(),
                    "segments/s",
                    {QuartilesOf(cgals).median, ratio.median, ratio.lower, ratio.upper},
                    0});
  }

  bool Ask(const Question& question, const ContestOptions& options, std::vector<Row>& rows) {
    cgal_.SetQueries(question.points, question.on_floor);
    const double share = DifferingShare(question);
    std::vector<Timing> timings(2);
    if (options.timing) {
      const Contestant flatlight{"flatlight", [&](std::size_t first, std::size_t count) {
                                   for (std::size_t i = first; i < first + count; ++i) Evaluate(question, i);
                                 }};
      const Contestant cgal{"cgal", [&](std::size_t first, std::size_t count) { cgal_.Compute(first, count); }};
      timings = TimeInTurns({flatlight, cgal}, kPoints, options.turns);
    }
    rows.push_back({"flatlight", question.scene, size_, rule_.Name(), "points/s", timings[0], 0});
    rows.push_back({"cgal", question.scene, size_, rule_.Name(), "points/s", timings[1], share});
    return share == 0;
  }

  void Evaluate(const Question& question, std::size_t point) {
    for (const std::vector<Receiver>& receivers : question.receivers) {
      const ExactValue value = solver_.Evaluate(receivers[point]);
      sink_ = sink_ + value.irradiance[0] + value.gradient[0] + value.hessian[0] + value.hessian_error[0];
    }
  }

  // All points are checked where that takes a moment, some hundred elsewhere.
  std::size_t CheckStep() const { return static_cast<std::size_t>(std::max(1, size_ / 1000)); }

  // Says what differs.
  double DifferingShare(const Question& question) {
    int differing = 0, asked = 0;
    for (std::size_t i = 0; i < question.points.size(); i += CheckStep()) {
      const std::vector<Point2> polygon = cgal_.Polygon(i);
      for (const std::vector<Receiver>& receivers : question.receivers) {
        const Receiver& receiver = receivers[i];
        const ExactValue value = solver_.Evaluate(receiver);
        const std::optional<double> peer = light_.Irradiance(question.points[i], receiver.normal, polygon);
        const double ours = value.irradiance[0] * scene_->frame().radiance_scale;
        const double bound = value.irradiance_error[0] * scene_->frame().radiance_scale;
        // CGAL's corners are rounded; radiance is near 1.
        constexpr double kTolerance = 1e-9;
        ++asked;
        if (peer && std::abs(*peer - ours) <= bound + kTolerance) continue;
        if (++differing > 3) continue;
        std::fprintf(stderr, "peers: %s, %d segments of %s, point (%.17g, %.17g): Flatlight %.12g, ",
                     question.scene.c_str(), size_, rule_.Name().c_str(), question.points[i].x, question.points[i].y,
                     ours);
        if (peer) {
          std::fprintf(stderr, "CGAL %.12g\n", *peer);
        } else {
          std::fprintf(stderr, "CGAL a polygon with a side on no segment\n");
        }
      }
    }
    return static_cast<double>(differing) / asked;
  }

  int size_;
  LengthRule rule_;
  World world_;
  std::shared_ptr<const Scene> scene_;
  Bvh bvh_;
  std::shared_ptr<const Triangulation> triangulation_;
  ExactSolver solver_;
  CgalVisibility cgal_;
  VisibleLight light_;
  volatile double sink_ = 0;
};

}  // namespace

bool RunExactContest(const ContestOptions& options, std::vector<Row>& rows) {
  bool agree = true;
  for (const int size : options.sizes) {
    for (const LengthRule& rule : options.lengths) {
      std::optional<World> world = MakeWorld(size, rule.For(size), options.emitting);
      if (!world) {
        std::fprintf(stderr, "peers: no room for %d segments of length %g that do not cross\n", size, rule.For(size));
        agree = false;
        continue;
      }
      agree = ExactCase(size, rule, *std::move(world)).Run(options, rows) && agree;
    }
  }
  return agree;
}

}  // namespace flatlight
