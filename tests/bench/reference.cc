// SPDX-License-Identifier: Apache-2.0
// `reference`: how long scenes of many curves take to a bound, and whether bounds hold, and how wide they are, in
// random rooms.  reference [ROOMS [CURVES [FIRST ROOM]]]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/execution/thread_pool.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/reference_solver.h"
#include "tests/bench/random_scenes.h"
#include "tests/bench/scattered_segments.h"
#include "tests/support/transport/random_room.h"
#include "tests/support/transport/solve_reference.h"

namespace flatlight {
namespace {

constexpr int kThreads = 2;
constexpr double kLongest = 10;  // s
constexpr std::uint32_t kPoints = 64;

// Straight curves between a floor and a lamp, reflecting 0.5 to 0.8.
class Town {
 public:
  explicit Town(const std::string& name) : random_(1) {
    scene_.name = name;
    Add({0, 0}, {1, 0});
    Add({1, 1}, {0, 1}, EmissionDescription{{1}});
    ProbeDescription probe;
    probe.name = "floor";
    probe.curve = "curve 0";
    probe.count = kPoints;
    scene_.probes.push_back(probe);
  }
  void Add(Point2 a, Point2 b, std::optional<EmissionDescription> emission = {}) {
    const std::string name = "curve " + std::to_string(scene_.curves.size());
    scene_.materials.push_back({name, LambertianDescription{{0.5 + 0.3 * random_.Next()}}});
    scene_.curves.push_back({name, SegmentDescription{a, b}, name, std::move(emission)});
  }
  double Random() { return random_.Next(); }
  std::shared_ptr<const Scene> Build() const { return Built(scene_); }
  const std::string& name() const { return scene_.name; }

 private:
  SceneDescription scene_;
  RandomNumbers random_;
};

Town Scattered(int count, double factor) {
  Town town("segments of " + std::to_string(factor).substr(0, 3) + "/sqrt(n)");
  const auto segments = ScatteredApart(count, factor / std::sqrt(count), 1);
  if (!segments) std::abort();
  for (const SegmentDescription& s : *segments) town.Add(s.a, s.b);
  return town;
}

// Boxes, each turned as it likes.
Town Boxes(int count) {
  Town town("boxes");
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int b = 0; b < count; ++b) {
    const double half = (0.15 + 0.15 * town.Random()) / side, angle = std::numbers::pi / 2 * town.Random();
    const Vector2 u{half * std::cos(angle), half * std::sin(angle)}, v{-u.y, u.x};
    const Point2 middle{(b % side + 0.5) / side, 0.05 + 0.9 * (b / side + 0.5) / side};
    const Point2 corners[4] = {middle + u + v, middle + v - u, middle - u - v, middle + u - v};
    for (int k = 0; k < 4; ++k) town.Add(corners[(k + 1) % 4], corners[k]);
  }
  return town;
}

void Time(const Town& town) {
  const auto scene = town.Build();
  ThreadPool pool(kThreads);
  ReferenceOptions options;
  options.derivatives = 0;
  options.channels = 1;
  options.target_error = 1e-4;
  const SteadyClock clock;
  const Cancellation never;
  const Clock::Time start = clock.Now();
  const auto seconds = [&] { return std::chrono::duration<double>(clock.Now() - start).count(); };
  ReferenceSolver solver(scene, std::make_shared<const RayCaster>(scene), options);
  for (int rounds = 0; solver.state() == ReferenceSolver::State::kWorks && seconds() < kLongest;) {
    solver.Advance(pool, kThreads, never, clock, Clock::Duration(0));
    if (solver.rounds() == rounds) continue;
    rounds = solver.rounds();
    std::printf("%-24s %5zu %5d %7zu %9.1e %8.2f\n", town.name().c_str(), scene->curves().size(), rounds,
                solver.panels(), solver.relative_error(), seconds());
    std::fflush(stdout);
  }
}

struct Widths {
  std::size_t values = 0, beyond = 0;
  std::vector<double> ratios;  // Bound over error.

  void Add(double value, double bound, double truth, double truth_bound) {
    ++values;
    const double error = std::abs(value - truth);
    if (error > bound + truth_bound) ++beyond;
    if (error > 3 * truth_bound) ratios.push_back(bound / error);
  }
  double Quantile(double part) {
    if (ratios.empty()) return 0;
    std::sort(ratios.begin(), ratios.end());
    return ratios[static_cast<std::size_t>(part * static_cast<double>(ratios.size() - 1))];
  }
};

void CheckBounds(const char* kind, std::shared_ptr<const Scene> (*room)(std::uint64_t, std::uint32_t), int derivatives,
                 std::uint64_t first, std::uint64_t rooms) {
  Widths widths[3];
  std::size_t beyond = 0;
  ReferenceOptions options;
  options.channels = 1;
  options.derivatives = derivatives;
  for (std::uint64_t seed = first; seed < first + rooms; ++seed) {
    const auto scene = room(seed, 1);
    options.target_error = seed % 3 == 0 ? 1e-1 : seed % 3 == 1 ? 1e-2 : 1e-3;
    const SolvedReference coarse = SolveReference(scene, options, kThreads);
    options.target_error *= 1e-3;
    const SolvedReference fine = SolveReference(scene, options, kThreads);
    for (std::size_t i = 0; i < fine.values.size(); ++i) {
      const ExactValue &a = coarse.values[i], &b = fine.values[i];
      widths[0].Add(a.irradiance[0], a.irradiance_error[0], b.irradiance[0], b.irradiance_error[0]);
      widths[1].Add(a.gradient[0], a.gradient_error[0], b.gradient[0], b.gradient_error[0]);
      widths[2].Add(a.hessian[0], a.hessian_error[0], b.hessian[0], b.hessian_error[0]);
    }
    std::size_t all = 0;
    for (const Widths& w : widths) all += w.beyond;
    if (all > beyond)
      std::printf("room %llu: %zu values beyond\n", static_cast<unsigned long long>(seed), all - beyond);
    beyond = all;
  }
  std::printf("\n%llu %s rooms\nQUANTITY    VALUES  BEYOND  BOUND OVER ERROR: LEAST  MEDIAN  90 %%\n",
              static_cast<unsigned long long>(rooms), kind);
  const char* const names[] = {"irradiance", "gradient", "hessian"};
  for (int m = 0; m <= derivatives; ++m)
    std::printf("%-10s %7zu %7zu %24.2f %7.0f %5.0f\n", names[m], widths[m].values, widths[m].beyond,
                widths[m].Quantile(0), widths[m].Quantile(0.5), widths[m].Quantile(0.9));
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  using namespace flatlight;
  const int rooms = argc > 1 ? std::atoi(argv[1]) : 100, curves = argc > 2 ? std::atoi(argv[2]) : 200;
  if (curves > 0) {
    std::printf("SCENE                    CURVES ROUND PANELS   BOUND  SECONDS\n");
    Time(Scattered(curves, 0.5));
    Time(Scattered(curves, 0.1));
    Time(Boxes(curves / 4));
  }
  const std::uint64_t first = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1000;
  if (rooms > 0) CheckBounds("common", RandomRoom, 2, first, static_cast<std::uint64_t>(rooms));
  // These take longer.
  if (rooms > 3) CheckBounds("hard", HardRoom, 0, first, static_cast<std::uint64_t>(rooms / 4));
}
