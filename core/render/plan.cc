// SPDX-License-Identifier: Apache-2.0
#include "core/render/plan.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <variant>

#include "core/render/caching_plan.h"
#include "core/render/light_paths.h"
#include "core/render/panel_plan.h"
#include "core/render/photon_plan.h"
#include "core/render/plan_passes.h"
#include "core/render/plan_text.h"
#include "core/render/skips.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kDefaultSamples = 1024;
// Of ray tracing, whose rays branch.
constexpr std::uint32_t kDefaultFirstRays = 256;
// Of a pixel: a path goes through hundreds of them.
constexpr std::uint32_t kDefaultPictureSamples = 8;
constexpr double kReferenceError = 1e-6;
constexpr double kSpecularReferenceError = 1e-3;  // What is seen over mirrors and glass takes far longer.

std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void CheckRanges(const Settings& settings, Diagnostics& diagnostics) {
  if (settings.samples == 0u) diagnostics.Add("settings.samples", "is 0, must be at least 1");
  if (settings.threads == 0u) diagnostics.Add("settings.threads", "is 0, must be at least 1");
  if (settings.target_error.has_value() && !(*settings.target_error > 0 && *settings.target_error <= 1)) {
    diagnostics.Add("settings.targetError", "is " + Text(*settings.target_error) + ", must be in (0, 1]");
  }
  if (settings.time_limit.has_value() && !(*settings.time_limit > 0 && std::isfinite(*settings.time_limit))) {
    diagnostics.Add("settings.timeLimit", "is " + Text(*settings.time_limit) + " s, must be a number above 0");
  }
  for (std::size_t i = 0; i < settings.no_skip.size(); ++i) {
    const std::vector<std::string>& names = SkipNames();
    if (std::find(names.begin(), names.end(), settings.no_skip[i]) == names.end()) {
      diagnostics.Add("settings.noSkip[" + std::to_string(i) + "]",
                      "\"" + settings.no_skip[i] + "\" is no skip, must be one of " + Listed(names));
    }
  }
}

bool PicturesAlone(const Scene& scene) {
  const SceneTraits& traits = scene.traits();
  return traits.pixels + traits.camera_pixels > 0 && traits.probe_points == traits.camera_pixels;
}

std::string NameOf(const Settings& settings) { return MethodNames()[static_cast<std::size_t>(*settings.method)]; }

void CheckDerivatives(const Scene& scene, const Settings& settings, Diagnostics& diagnostics) {
  const bool none = settings.derivatives.value_or(Derivatives::kHessian) == Derivatives::kNone;
  const bool gives_none = settings.method == Method::kPathTracing || settings.method == Method::kIrradianceCaching;
  if (gives_none && settings.derivatives.has_value() && !none) {
    diagnostics.Add("settings.derivatives",
                    NameOf(settings) + " gives none: leave this out, or use exact, ray-tracing or reference");
  }
  // Where radiance varies along what appears behind an edge, the second derivative has a term that rays do not tell
  // (THEORY 18 B6).
  const bool gathers = settings.method == Method::kRayTracing || settings.method == Method::kPhotonMapping;
  if (gathers && settings.derivatives == Derivatives::kHessian && !DirectLightOnly(scene, settings)) {
    diagnostics.Add("settings.derivatives",
                    NameOf(settings) +
                        " gives the Hessian of direct light alone, and this scene reflects: ask for the gradient, "
                        "set max bounces to 0, or use reference");
  }
  if (settings.method == Method::kExact && settings.derivatives.has_value() && !none && PicturesAlone(scene)) {
    diagnostics.Add("settings.derivatives", "pictures and cameras have none: leave this out");
  }
  if (!settings.formulation.has_value()) return;
  if (settings.method != Method::kRayTracing) {
    diagnostics.Add("settings.formulation", "applies to ray-tracing alone: leave this out, or use that");
  } else if (none) {
    diagnostics.Add("settings.formulation", "says how derivatives are found, but derivatives none asks for none");
  }
}

void CheckFading(const Scene& scene, const Settings& settings, Diagnostics& diagnostics) {
  if (settings.max_bounces.has_value() || !LightNeverFades(scene)) return;
  diagnostics.Add(
      "settings.maxBounces",
      "is absent, but every curve reflects all light and some enclose an area, where light never fades: set "
      "it, or give a curve a reflectance below 1");
}

// Of deterministic methods.
void RefuseSampling(const Settings& settings, Diagnostics& diagnostics) {
  const std::string reason = "does not apply to " + NameOf(settings) + ", which draws no samples";
  if (settings.samples.has_value()) diagnostics.Add("settings.samples", reason);
  if (settings.seed.has_value()) diagnostics.Add("settings.seed", reason);
}

// Of light that is reflected.
void CheckReferenceDerivatives(const Scene& scene, Diagnostics& diagnostics) {
  const std::string path = "settings.derivatives", cure = ": leave this out, set max bounces to 0, or use ray-tracing";
  if (scene.traits().has_beziers)
    diagnostics.Add(path, "reference gives none of light reflected in a scene with Bézier curves" + cure);
  const std::string glossy = NameOfPhongCurve(scene);
  if (!glossy.empty()) {
    diagnostics.Add(path, "reference gives none of light that phong lobes reflect, and curve \"" + glossy +
                              "\" has one" + cure);
  }
}

void CheckReference(const Scene& scene, const Settings& settings, Diagnostics& diagnostics) {
  RefuseSampling(settings, diagnostics);
  if (!DirectLightOnly(scene, settings)) {
    CheckPanels(scene, "settings.method", "path-tracing", diagnostics);
    if (settings.derivatives.value_or(Derivatives::kNone) != Derivatives::kNone)
      CheckReferenceDerivatives(scene, diagnostics);
    if (settings.max_bounces && !scene.traits().lambertian) {
      diagnostics.Add("settings.maxBounces",
                      "is " + Text(*settings.max_bounces) +
                          ", but over mirrors, glass and phong lobes reference counts all bounces: leave this out, set "
                          "it to 0, or use path-tracing");
    }
  }
  CheckFading(scene, settings, diagnostics);
}

// Settings that the method would ignore, and scenes that it cannot do.
void CheckMethod(const Scene& scene, const Settings& settings, Diagnostics& diagnostics) {
  CheckDerivatives(scene, settings, diagnostics);
  CheckCaching(scene, settings, diagnostics);
  CheckPhotonMapping(scene, settings, diagnostics);
  if (settings.method != Method::kPathTracing && settings.method != Method::kExact && scene.traits().pixels > 0) {
    diagnostics.Add("settings.method", NameOf(settings) +
                                           " gives irradiance at points, and a probe of this scene is a "
                                           "picture: use path-tracing");
  }
  if (settings.method != Method::kPathTracing && settings.method != Method::kExact &&
      scene.traits().camera_pixels > 0) {
    diagnostics.Add("settings.method", NameOf(settings) +
                                           " gives irradiance at points, and a probe of this scene is a "
                                           "camera: use path-tracing");
  }
  if (settings.method == Method::kExact) {
    RefuseSampling(settings, diagnostics);
    if (settings.target_error.has_value())
      diagnostics.Add("settings.targetError", "does not apply to exact, which draws no samples");
    if (settings.time_limit.has_value())
      diagnostics.Add("settings.timeLimit", "does not apply to exact, which draws no samples");
    if (!DirectLightOnly(scene, settings)) {
      const std::string cure = "set max bounces to 0, or use reference or path-tracing";
      if (settings.max_bounces.has_value()) {
        diagnostics.Add("settings.maxBounces", "is " + Text(*settings.max_bounces) +
                                                   ", but exact gives direct light, and this scene reflects: " + cure);
      } else {
        diagnostics.Add("settings.method", "exact gives direct light, and this scene reflects: " + cure);
      }
    }
    return;
  }
  if (settings.method == Method::kReference) return CheckReference(scene, settings, diagnostics);
  if (settings.method == Method::kIrradianceCaching && !DirectLightOnly(scene, settings) && HasChainedLight(scene)) {
    diagnostics.Add("settings.method",
                    NameOf(settings) +
                        " leaves out the light that plane.lights send over mirrors and glass: use path-tracing or "
                        "ray-tracing, or set max bounces to 0");
  }
  CheckFading(scene, settings, diagnostics);
}

void FillMethodDefaults(const Scene& scene, Plan& plan) {
  Settings& settings = plan.settings;
  if (settings.method == Method::kExact) {
    if (!settings.derivatives.has_value()) {
      settings.derivatives = PicturesAlone(scene) ? Derivatives::kNone : Derivatives::kHessian;
    }
    return;
  }
  if (settings.method == Method::kReference) {
    if (!settings.derivatives.has_value()) {
      const bool all = DirectLightOnly(scene, settings) || PanelsTellAll(scene);
      settings.derivatives = all ? Derivatives::kHessian : Derivatives::kNone;
    }
    if (!settings.target_error.has_value()) {
      const bool specular = !scene.traits().lambertian && !DirectLightOnly(scene, settings);
      settings.target_error = specular ? kSpecularReferenceError : kReferenceError;
    }
    return;
  }
  if (settings.method == Method::kIrradianceCaching) {
    FillCachingDefaults(scene, settings);
    if (DirectLightOnly(scene, settings)) return;
  }
  if (!settings.seed.has_value()) settings.seed = 0;
  if (settings.method == Method::kIrradianceCaching) return;
  if (settings.method == Method::kPhotonMapping) return FillPhotonDefaults(scene, settings);
  const bool open_ended = settings.target_error.has_value() || settings.time_limit.has_value();
  if (settings.method == Method::kRayTracing) {
    if (!settings.derivatives.has_value()) {
      settings.derivatives = DirectLightOnly(scene, settings) ? Derivatives::kHessian : Derivatives::kGradient;
    }
    if (settings.derivatives != Derivatives::kNone && !settings.formulation.has_value()) {
      settings.formulation = Formulation::kStratified;
    }
    if (!settings.samples.has_value() && !open_ended) settings.samples = kDefaultFirstRays;
    return;
  }
  settings.derivatives = Derivatives::kNone;
  if (scene.traits().pixels > 0) {
    plan.picture_samples = settings.samples;
    if (!settings.samples.has_value() && !open_ended) plan.picture_samples = kDefaultPictureSamples;
  }
  if (!settings.samples.has_value() && !open_ended) {
    settings.samples = scene.traits().probe_points > 0 ? kDefaultSamples : kDefaultPictureSamples;
  }
}

// A triangulation is made in 1 to 4 us an element, and saves 3 to 170 us a point, both growing with the scene (./run
// bench exact_light): from 0.3 times as many points as elements on it pays, with another thread from twice that. With
// more elements a job would be deaf for seconds.
bool TrianglesPay(const Scene& scene, const Plan& plan) {
  constexpr std::size_t kMostElements = 1 << 18;
  const SceneTraits& traits = scene.traits();
  return plan.settings.method == Method::kExact && !plan.Takes(skip::kEmission) && !plan.Takes(skip::kVisibility) &&
         (traits.emitting_curves > 0 || traits.environment) && !traits.has_arcs && traits.elements <= kMostElements &&
         2 * (traits.probe_points + traits.pixels) >= traits.elements;
}

std::string Bounces(const Plan& plan) {
  const auto most = plan.settings.max_bounces;
  if (most == 0u || plan.Takes(skip::kBounces)) return "direct light";
  return most ? "up to " + Text(*most) + (*most == 1 ? " bounce" : " bounces") : "all bounces";
}

std::string Summary(const Scene& scene, const Plan& plan) {
  const std::size_t points = scene.traits().probe_points;
  const std::size_t pixels = scene.traits().pixels;
  std::string text = "Exact direct light";
  if (plan.settings.method == Method::kPathTracing) {
    text = (points == 0 && pixels > 0 ? "Light tracing of " : "Path tracing of ") + Bounces(plan);
  }
  if (plan.settings.method == Method::kRayTracing) text = "Ray tracing of " + Bounces(plan);
  if (plan.settings.method == Method::kReference) text = "Reference of " + Bounces(plan);
  if (plan.settings.method == Method::kIrradianceCaching) text = "Irradiance caching of " + Bounces(plan);
  if (plan.settings.method == Method::kPhotonMapping) text = "Photon mapping of " + Bounces(plan);
  if (plan.settings.derivatives == Derivatives::kGradient) text += " and its gradient";
  if (plan.settings.derivatives == Derivatives::kHessian) text += " with gradient and Hessian";
  text += " at ";
  if (points > 0 || pixels == 0) {
    const std::size_t seen = scene.traits().camera_pixels, others = points - seen;
    if (others > 0 || seen == 0) text += std::to_string(others) + (others == 1 ? " point" : " points");
    if (seen > 0) text += (others > 0 ? " and " : "") + std::to_string(seen) + " pixels of cameras";
  }
  if (pixels > 0) text += (points > 0 ? " and in " : "") + std::to_string(pixels) + " pixels";
  if (plan.settings.method == Method::kPhotonMapping || plan.settings.method == Method::kIrradianceCaching) {
    const bool cached = plan.settings.method == Method::kIrradianceCaching;
    text += cached ? HowRecordsTell(plan.settings, plan.Takes(skip::kBounces)) : HowPhotonsTell(scene, plan.settings);
    const bool closed_form = !cached && *plan.settings.final_gather;
    // Caching takes 1.9 to 55 times as long as exact (penumbra, city, blocker, unit-light; 256 and 65536 points).
    if (!closed_form && DirectLightOnly(scene, plan.settings) && !plan.Takes(skip::kEmission))
      text += "; the method exact would be done sooner, with no error but rounding";
    return text + ".";
  }
  if (plan.settings.method != Method::kExact) {
    const bool branching = plan.settings.method == Method::kRayTracing;
    if (plan.settings.samples.has_value()) {
      text += ", at most " + Text(plan.passes[0].samples) + (branching ? " branching rays each" : " paths each");
    }
    if (plan.settings.target_error.has_value())
      text += ", until the error is " + Text(100 * *plan.settings.target_error) + " %";
    if (plan.settings.time_limit.has_value()) text += ", for " + Text(*plan.settings.time_limit) + " s";
    const bool open_ended = plan.settings.target_error.has_value() || plan.settings.time_limit.has_value();
    const std::size_t at_most = text.find("at most ");
    if (!open_ended && at_most != std::string::npos) text.erase(at_most, std::string("at most ").size());
  }
  return text + ".";
}

}  // namespace

const std::vector<std::string>& MethodNames() {
  static const auto& names = *new std::vector<std::string>{"exact",     "path-tracing",       "ray-tracing",
                                                           "reference", "irradiance-caching", "photon-mapping"};
  return names;
}

std::optional<Plan> MakePlan(const Scene& scene, const Settings& settings, Diagnostics& diagnostics) {
  const std::size_t before = diagnostics.count();
  Plan plan;
  plan.settings = settings;
  if (!settings.method.has_value()) {
    const bool sampling = settings.samples || settings.seed || settings.target_error || settings.time_limit;
    const bool exact = DirectLightOnly(scene, settings) && !sampling;
    plan.settings.method = exact ? Method::kExact : Method::kPathTracing;
  }
  CheckRanges(settings, diagnostics);
  CheckMethod(scene, plan.settings, diagnostics);
  if (diagnostics.count() != before) return std::nullopt;
  FillMethodDefaults(scene, plan);
  plan.skips = DecideSkips(scene, plan.settings);
  plan.triangles = TrianglesPay(scene, plan);
  AddPasses(scene, plan);
  plan.summary = Summary(scene, plan);
  return plan;
}

}  // namespace flatlight
