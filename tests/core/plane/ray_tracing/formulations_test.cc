// SPDX-License-Identifier: Apache-2.0
// Derivatives from gathered rays against those of exact direct light.
#include "core/plane/ray_tracing/formulations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "core/plane/exact/exact.h"
#include "core/sampling/hash.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

using Formulate = std::function<GatherDerivatives(const Receiver&, const std::vector<GatheredRay>&)>;

// Over many gathers of direct light: mean and its standard error.
struct Statistics {
  double mean[3] = {0, 0, 0};
  double error[3] = {0, 0, 0};
};

Statistics Gather(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, const Formulate& formulate) {
  constexpr int kGathers = 400;
  double sum[3] = {0, 0, 0}, squares[3] = {0, 0, 0}, cast = 0;
  const Cancellation never;
  std::vector<GatheredRay> gathered;
  for (std::uint64_t g = 0; g < kGathers; ++g) {
    GatherHemicircle(tree, receiver, rays, ChildKey(g, rays), never, gathered, cast);
    LookPastEnds(tree, receiver, rays, g, never, gathered, cast);
    const GatherDerivatives derivatives = formulate(receiver, gathered);
    const double values[3] = {IrradianceOf(gathered)[0], derivatives.first[0], derivatives.second[0]};
    for (int i = 0; i < 3; ++i) sum[i] += values[i], squares[i] += values[i] * values[i];
  }
  Statistics result;
  for (int i = 0; i < 3; ++i) {
    result.mean[i] = sum[i] / kGathers;
    result.error[i] = std::sqrt(std::max(squares[i] / kGathers - result.mean[i] * result.mean[i], 0.0) / kGathers);
  }
  return result;
}

struct Subject {
  std::string name;
  SceneMaker maker;
  enum class ArcLength { kRight, kFirstOrder, kWrong, kNoisy } arc_length = ArcLength::kRight;
};

std::vector<Subject> Subjects() {
  std::vector<Subject> subjects;
  SceneMaker open = UnitLight();
  open.Probe("floor", 5);
  subjects.push_back({"open", open, Subject::ArcLength::kRight});
  SceneMaker blocked = UnitLight();
  blocked.Probe("floor", 5);
  blocked.Segment("blocker", {0.5, 0.5}, {1.2, 0.5});
  subjects.push_back({"blocked", blocked, Subject::ArcLength::kWrong});
  SceneMaker disc;
  disc.Segment("floor", {0, 0}, {1, 0}).Probe("floor", 5);
  disc.Arc("sun", {{0.3, 0.8}, 0.25, 0, -kFullTurn}, {.radiance = {2}});
  subjects.push_back({"disc", disc, Subject::ArcLength::kFirstOrder});
  SceneMaker shaded = disc;
  shaded.Arc("moon", {{0.45, 0.35}, 0.12, 0, -kFullTurn});
  subjects.push_back({"disc behind a disc", shaded, Subject::ArcLength::kWrong});
  SceneMaker hill;
  hill.Arc("hill", {{0, -1}, 1, 2.2, -1.2}).Probe("hill", 5);
  hill.Segment("light", {1, 1}, {-1, 1.2}, {.radiance = {1}}).Segment("blocker", {0.1, 0.5}, {0.4, 0.55});
  subjects.push_back({"hill", hill, Subject::ArcLength::kWrong});
  SceneMaker bowl;
  bowl.Arc("bowl", {{0, 0}, 1, 3.5, 2.2}, {.radiance = {0.5}}).Probe("bowl", 5);
  bowl.Segment("light", {0.5, 0.4}, {-0.5, 0.3}, {.radiance = {1}});
  subjects.push_back({"bowl", bowl, Subject::ArcLength::kNoisy});
  return subjects;
}

struct Checked {
  int count = 0;
  double worst_bias[3] = {0, 0, 0};  // Beyond 5 standard errors, of the size of the values.
};

Checked Compare(const Subject& subject, std::uint32_t rays, const Formulate& formulate) {
  SceneMaker maker = subject.maker;
  const auto scene = maker.Build();
  const RayTree tree(std::make_shared<RayCaster>(scene), {.max_bounces = 0});
  ExactSolver exact(*scene, tree.caster().bvh(), {});
  Checked checked;
  double size[3] = {0, 0, 0};
  std::vector<std::pair<ExactValue, Statistics>> pairs;
  for (const Receiver& receiver : scene->probes()[0].receivers) {
    const ExactValue truth = exact.Evaluate(receiver);
    size[0] = std::max(size[0], truth.irradiance[0]);
    size[1] = std::max(size[1], std::abs(truth.gradient[0]));
    size[2] = std::max(size[2], std::abs(truth.hessian[0]));
    pairs.emplace_back(truth, Gather(tree, receiver, rays, formulate));
  }
  for (const auto& [truth, found] : pairs) {
    const double values[3] = {truth.irradiance[0], truth.gradient[0], truth.hessian[0]};
    for (int i = 0; i < 3; ++i) {
      const double beyond = std::abs(found.mean[i] - values[i]) - 5 * found.error[i];
      checked.worst_bias[i] = std::max(checked.worst_bias[i], beyond / size[i]);
    }
    ++checked.count;
  }
  return checked;
}

TEST(FormulationsTest, AgreeWithExactLight) {
  for (const Subject& subject : Subjects()) {
    for (const auto& [name, formulate] :
         {std::pair<const char*, Formulate>{"stratified", StratifiedDerivatives}, {"polyline", PolylineDerivatives}}) {
      const Checked checked = Compare(subject, 512, formulate);
      EXPECT_EQ(checked.count, 5);
      EXPECT_LE(checked.worst_bias[0], 0) << subject.name << ' ' << name;
      EXPECT_LE(checked.worst_bias[1], 0.003) << subject.name << ' ' << name;
      EXPECT_LE(checked.worst_bias[2], 0.003) << subject.name << ' ' << name;
    }
  }
}

// The visible part of a disc changes as the receiver moves: that is occlusion, of the second order.
TEST(FormulationsTest, ArcLengthIsRightWithoutOccludersAlone) {
  for (const Subject& subject : Subjects()) {
    const Checked checked = Compare(subject, 512, ArcLengthDerivatives);
    if (subject.arc_length == Subject::ArcLength::kNoisy) continue;  // The bowl's own wall is close.
    EXPECT_EQ(checked.worst_bias[1] <= 0.003, subject.arc_length != Subject::ArcLength::kWrong) << subject.name;
    EXPECT_EQ(checked.worst_bias[2] <= 0.003, subject.arc_length == Subject::ArcLength::kRight) << subject.name;
  }
}

// Light that comes from infinitely far, and light that is the same all around.
TEST(FormulationsTest, SkyOverAHill) {
  SceneMaker maker;
  maker.Arc("hill", {{0, -1}, 1, 2.2, -1.2}).Probe("hill", 5).Environment({2});
  maker.Segment("wall", {0.5, 0.2}, {0.5, 0.9});
  const Subject subject{"sky", maker, Subject::ArcLength::kWrong};
  for (const Formulate& formulate : {Formulate(StratifiedDerivatives), Formulate(PolylineDerivatives)}) {
    const Checked checked = Compare(subject, 512, formulate);
    EXPECT_LE(checked.worst_bias[1], 0.003);
    EXPECT_LE(checked.worst_bias[2], 0.003);
  }
}

TEST(HemicircleGatherTest, StretchesCoverTheHemicircle) {
  SceneMaker maker = UnitLight();
  maker.Probe("floor", 1);
  const auto scene = maker.Build();
  const Receiver& receiver = scene->probes()[0].receivers[0];
  const RayTree tree(std::make_shared<RayCaster>(scene), {});
  const Cancellation never;
  std::vector<GatheredRay> gathered;
  double cast = 0;
  for (std::uint64_t key = 0; key < 50; ++key) {
    for (const std::uint32_t rays : {1u, 2u, 5u, 16u}) {
      GatherHemicircle(tree, receiver, rays, key, never, gathered, cast);
      EXPECT_LE(gathered.size(), rays + 1u);
      const Spectrum irradiance = IrradianceOf(gathered);
      LookPastEnds(tree, receiver, rays, key, never, gathered, cast);
      EXPECT_EQ(IrradianceOf(gathered), irradiance);
      double at = -1, last = -1;
      for (const GatheredRay& ray : gathered) {
        EXPECT_EQ(ray.begin, at);
        EXPECT_GE(ray.sine, last);
        at = ray.end, last = ray.sine;
      }
      EXPECT_EQ(at, 1);
    }
  }
}

}  // namespace
}  // namespace flatlight
