// SPDX-License-Identifier: Apache-2.0
// What a number of cache records makes of a floor below a lamp, by error control: medians over scenes of one kind.
//
//   record_placement [VARIANTS [CSV]]      default: 15, out/record_placement.csv
//
// Where records go is a function of the scene, so chance is in the scene: in each variant but the first, lamp, blocker
// and the ends of the floor stand a little elsewhere. Errors are root mean squares over 257 points, relative to the
// mean irradiance. Ratios are to split sphere, degree 1, in the same variant: the median and, in brackets, the lower
// and upper quartile.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/render/rendering.h"
#include "core/sampling/hash.h"
#include "tests/bench/bench_report.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

enum class Wall { kNone, kBlack, kDim };

struct Kind {
  const char* name;
  Wall walls;
  bool blocker;
  double reflectance;  // Of everything but black walls.
};

constexpr Kind kKinds[] = {
    {"open", Wall::kNone, false, 0},
    {"black walls", Wall::kBlack, false, 0},
    {"dim wall", Wall::kDim, false, 0},
    {"blocker", Wall::kNone, true, 0},
    {"dim wall, blocker", Wall::kDim, true, 0},
    {"open, bounces", Wall::kNone, false, 0.5},
    {"black walls, bounces", Wall::kBlack, false, 0.5},
    {"dim wall, bounces", Wall::kDim, false, 0.5},
    {"blocker, bounces", Wall::kNone, true, 0.5},
    {"dim wall, blocker, bounces", Wall::kDim, true, 0.5},
};

std::shared_ptr<const Scene> Variant(const Kind& kind, std::uint32_t variant) {
  // In [-1, 1); 0 in the first variant.
  const auto random = [&](std::uint64_t what) {
    return variant == 0 ? 0.0 : 2 * ToUnitInterval(ChildKey(ChildKey(7, what), variant)) - 1;
  };
  const double shift = 0.1 * random(0), width = 1 + 0.15 * random(1), height = 1 + 0.15 * random(2);
  const Look look = {.reflectance = {kind.reflectance}};
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {1, 0}, look).Probe("floor", 257);
  const double left = std::max(0.5 + shift - 0.5 * width, 0.0), right = std::min(0.5 + shift + 0.5 * width, 1.0);
  maker.Segment("lamp", {right, height}, {left, height}, {.reflectance = {kind.reflectance}, .radiance = {1}});
  if (kind.walls != Wall::kNone) {
    Look dim = kind.walls == Wall::kDim ? look : Look{};
    maker.Segment("left", {0, 1.2}, {0, 0}, dim);
    if (kind.walls == Wall::kDim) dim.radiance = {0.1};
    maker.Segment("right", {1, 0}, {1, 1.2}, dim);
  }
  if (kind.blocker) {
    const double at = 0.45 + 0.1 * random(3), y = 0.5 + 0.1 * random(4), size = 0.25 + 0.05 * random(5);
    maker.Segment("blocker", {at, y}, {at + size, y}, look);
  }
  return maker.Build();
}

double ErrorOf(const std::shared_ptr<const Scene>& scene, const Field& truth, ErrorControl control,
               std::uint32_t degree, std::uint32_t records) {
  Settings settings;
  settings.method = Method::kIrradianceCaching;
  settings.error_control = control;
  settings.extrapolation = degree;
  settings.max_records = records;
  const auto field = Render(scene, settings).field;
  double squares = 0, sum = 0;
  const std::vector<double>& truths = truth.probes[0].irradiance;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const double off = field->probes[0].irradiance[i] - truths[i];
    squares += off * off, sum += truths[i];
  }
  const auto n = static_cast<double>(truths.size());
  return std::sqrt(squares / n) / (sum / n);
}

void Measure(const Kind& kind, std::uint32_t variants, BenchTable& table) {
  struct Way {
    ErrorControl control;
    std::uint32_t degree;
  };
  constexpr Way kWays[] = {{ErrorControl::kSplitSphere, 1},
                           {ErrorControl::kOcclusionHessian, 1},
                           {ErrorControl::kVisibilityEvents, 1},
                           {ErrorControl::kVisibilityEvents, 2}};
  std::vector<std::shared_ptr<const Scene>> scenes;
  std::vector<std::shared_ptr<const Field>> truths;
  for (std::uint32_t v = 0; v < variants; ++v) {
    Settings truth;
    truth.method = kind.reflectance > 0 ? Method::kReference : Method::kExact;
    truth.derivatives = Derivatives::kNone;
    scenes.push_back(Variant(kind, v));
    truths.push_back(Render(scenes.back(), truth).field);
  }
  for (const std::uint32_t records : {8u, 9u, 10u, 12u, 16u}) {
    std::vector<std::string> row = {kind.name, std::to_string(records)};
    std::vector<double> split;
    for (const Way& way : kWays) {
      std::vector<double> errors, ratios;
      for (std::uint32_t v = 0; v < variants; ++v) {
        errors.push_back(ErrorOf(scenes[v], *truths[v], way.control, way.degree, records));
        if (!split.empty()) ratios.push_back(split[v] / errors[v]);
      }
      row.push_back(Short(QuartilesOf(errors).median));
      if (split.empty()) {
        split = errors;
        continue;
      }
      const Quartiles q = QuartilesOf(ratios);
      row.push_back(Short(q.median) + " (" + Short(q.lower) + ", " + Short(q.upper) + ")");
    }
    table.Add(row);
  }
}

int Run(std::uint32_t variants, const std::string& csv, const std::string& only) {
  BenchTable table({"scene", "records", "split sphere, 1", "occlusion Hessian, 1", "times below", "events, 1",
                    "times below", "events, 2", "times below"});
  for (const Kind& kind : kKinds)
    if (only.empty() || only == kind.name) Measure(kind, variants, table);
  return table.Report(csv) ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  const int variants = argc > 1 ? std::atoi(argv[1]) : 15;
  if (variants < 1 || variants > 1000) {
    std::fprintf(stderr, "%s is no number of variants, 1 to 1000\n", argv[1]);
    return 2;
  }
  return flatlight::Run(static_cast<std::uint32_t>(variants), argc > 2 ? argv[2] : "out/record_placement.csv",
                        argc > 3 ? argv[3] : "");
}
