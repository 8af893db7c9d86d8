// SPDX-License-Identifier: Apache-2.0
#include "core/render/plan_passes.h"

#include <algorithm>
#include <cmath>

#include "core/plane/ray_tracing/ray_tree.h"
#include "core/render/light_paths.h"
#include "core/render/plan_text.h"
#include "core/render/skips.h"

namespace flatlight {
namespace {

// Paths of a block: samples come in whole ones.
constexpr double kBlockSamples = 16;

// Over all curves, weighed by length.
double MeanReflectance(const Scene& scene) {
  double length = 0;
  double reflected = 0;
  for (const Curve& curve : scene.curves()) {
    length += curve.length;
    reflected += curve.length * curve.reflectance.Max();
  }
  return length > 0 ? reflected / length : 0;
}

// Vertices of a path if all curves reflect as the average one does.
double ExpectedVertices(const Scene& scene, const Plan& plan) {
  const double most = plan.Takes(skip::kBounces) ? 0 : plan.settings.max_bounces.value_or(1e9);
  const double reflectance = MeanReflectance(scene);
  if (reflectance == 1) return std::min(most + 1, 1e6);
  return (1 - std::pow(reflectance, most + 1)) / (1 - reflectance);
}

// Rays of the tree behind one of `samples` rays of the first level.
double ExpectedTree(const Scene& scene, const Plan& plan, double samples) {
  const double most = plan.Takes(skip::kBounces) ? 0 : plan.settings.max_bounces.value_or(64);
  auto branches = static_cast<std::uint32_t>(samples / kBlockSamples);
  double rays = 1, level = 1;
  for (double depth = 0; depth < most && depth < 64; ++depth) {
    branches = RayTree::Branches(branches);
    level *= branches > 1 ? branches : MeanReflectance(scene);
    rays += level;
  }
  return rays;
}

PlanPass PhotonPass(const Scene& scene, const Plan& plan) {
  const Settings& settings = plan.settings;
  PlanPass photons;
  photons.name = (settings.photons ? Text(*settings.photons) + " " : "") +
                 "photons from where light shines, sorted along the curves on which they arrive";
  if (!plan.Takes(skip::kEmission))
    photons.expected_rays = settings.photons.value_or(0) * ExpectedVertices(scene, plan);
  return photons;
}

void AddPhotonPasses(const Scene& scene, Plan& plan) {
  const Settings& settings = plan.settings;
  const bool gathers = *settings.final_gather, direct = DirectLightOnly(scene, settings);
  PlanPass points;
  points.points = static_cast<double>(scene.traits().probe_points);
  if (gathers && direct) {
    points.name = "direct light in closed form";
    plan.passes.push_back(points);
    return;
  }
  plan.passes.push_back(PhotonPass(scene, plan));
  points.name = gathers ? "direct light in closed form, and rays that look up densities of photons where they arrive"
                        : "densities of photons at the points";
  if (gathers) {
    points.samples = settings.photons ? std::ceil(*settings.samples / kBlockSamples) * kBlockSamples : 0;
    // A quarter more tells the bias.
    if (!plan.Takes(skip::kEmission)) points.expected_rays = 1.25 * points.points * points.samples;
  }
  plan.passes.push_back(points);
}

}  // namespace

void AddPasses(const Scene& scene, Plan& plan) {
  if (plan.settings.method == Method::kPhotonMapping) return AddPhotonPasses(scene, plan);
  PlanPass pass;
  pass.points = static_cast<double>(scene.traits().probe_points);
  if (plan.settings.method == Method::kExact) {
    pass.name = plan.triangles ? "direct light in closed form, through triangles where they can be made"
                               : "direct light in closed form";
  } else if (plan.settings.method == Method::kReference) {
    pass.name = "light between panels, refined until its error is small";
  } else if (plan.settings.method == Method::kIrradianceCaching) {
    pass.name = "records where points need them, and interpolation between them";
    const double rays = plan.settings.samples.value_or(0);
    const bool photons = plan.settings.gather == Gather::kPhotonMap;
    if (photons && !plan.Takes(skip::kBounces)) plan.passes.push_back(PhotonPass(scene, plan));
    if (plan.settings.max_records && !plan.Takes(skip::kEmission) && !plan.Takes(skip::kBounces))
      pass.expected_rays = *plan.settings.max_records * rays * (photons ? 1 : ExpectedTree(scene, plan, rays));
  } else {
    const bool branching = plan.settings.method == Method::kRayTracing;
    pass.name = branching ? "branching rays from the points" : "paths from the points";
    if (plan.settings.samples.has_value())
      pass.samples = std::ceil(*plan.settings.samples / kBlockSamples) * kBlockSamples;
    const double rays_per_vertex = plan.Takes(skip::kVisibility) ? 1 : 2;
    if (!plan.Takes(skip::kEmission)) {
      pass.expected_rays =
          pass.points * pass.samples *
          (branching ? ExpectedTree(scene, plan, pass.samples) : rays_per_vertex * ExpectedVertices(scene, plan));
    }
  }
  if (pass.points > 0 || scene.traits().pixels == 0) plan.passes.push_back(pass);
  if (scene.traits().pixels == 0) return;
  PlanPass pictures;
  pictures.points = static_cast<double>(scene.traits().pixels);
  if (plan.settings.method == Method::kExact) {
    pictures.name = "fluence in closed form in the middle of each pixel, and all over those where it bends";
    plan.passes.push_back(pictures);
    return;
  }
  pictures.name = "light followed through the pictures";
  pictures.samples = plan.picture_samples.value_or(0);
  if (!plan.Takes(skip::kEmission)) {
    pictures.expected_rays = pictures.points * pictures.samples * ExpectedVertices(scene, plan);
  }
  plan.passes.push_back(pictures);
}

}  // namespace flatlight
