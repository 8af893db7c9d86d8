// SPDX-License-Identifier: Apache-2.0
#include "core/render/plan.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <variant>

#include "core/plane/ray_tracing/ray_tree.h"
#include "core/render/light_paths.h"
#include "core/render/photon_plan.h"
#include "core/render/skips.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kDefaultSamples = 1024;
// Of ray tracing, whose rays branch.
constexpr std::uint32_t kDefaultFirstRays = 256;
// Of a cache record, whose rays branch.
constexpr std::uint32_t kDefaultGatherRays = 1024;
constexpr double kDefaultTolerance = 0.01;
// Of a pixel: a path goes through hundreds of them.
constexpr std::uint32_t kDefaultPictureSamples = 8;
constexpr double kReferenceError = 1e-6;
// Of straight and arced pieces: everything that a panel may see is kept, some 100 kB a piece.
constexpr std::size_t kMostReferencePieces = 2048;
// Paths of a block: samples come in whole ones.
constexpr double kBlockSamples = 16;

template <typename T>
std::string Text(const T& value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

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

// Whether panels can tell the light of a scene. `path`: of the setting that asks for them; `other`: what to use else.
void CheckPanels(const Scene& scene, bool reflects, const std::string& path, const std::string& other,
                 Diagnostics& diagnostics) {
  if (reflects && !scene.traits().lambertian) {
    const auto curve = std::find_if(scene.curves().begin(), scene.curves().end(), [](const Curve& c) {
      return !std::holds_alternative<Lambertian>(c.material) && !c.reflectance.IsBlack();
    });
    diagnostics.Add(path, "reference needs a scene that reflects by lambertian materials alone, and curve \"" +
                              curve->name + "\" has another: use " + other);
  }
  if (scene.traits().elements > kMostReferencePieces) {
    diagnostics.Add(path, "reference does scenes of up to " + Text(kMostReferencePieces) +
                              " straight and arced pieces, and this one has " + Text(scene.traits().elements) +
                              ": use " + other);
  }
}

// Settings of irradiance caching, and those that it has no use for.
void CheckCaching(const Scene& scene, const Settings& settings, Diagnostics& diagnostics) {
  if (settings.method != Method::kIrradianceCaching) {
    const std::string reason = "applies to irradiance-caching alone: leave this out, or use that";
    if (settings.error_control) diagnostics.Add("settings.errorControl", reason);
    if (settings.extrapolation) diagnostics.Add("settings.extrapolation", reason);
    if (settings.tolerance) diagnostics.Add("settings.tolerance", reason);
    if (settings.max_records) diagnostics.Add("settings.maxRecords", reason);
    if (settings.gather) diagnostics.Add("settings.gather", reason);
    if (settings.neighbour_clamping) diagnostics.Add("settings.neighbourClamping", reason);
    if (settings.overture) diagnostics.Add("settings.overture", reason);
    return;
  }
  if (settings.extrapolation > 2u)
    diagnostics.Add("settings.extrapolation", "is " + Text(*settings.extrapolation) + ", must be 0, 1 or 2");
  if (settings.tolerance && !(*settings.tolerance > 0 && *settings.tolerance <= 1))
    diagnostics.Add("settings.tolerance", "is " + Text(*settings.tolerance) + ", must be in (0, 1]");
  if (settings.max_records == 0u) diagnostics.Add("settings.maxRecords", "is 0, must be at least 1");
  if (settings.tolerance && settings.max_records) {
    diagnostics.Add("settings.maxRecords",
                    "is given together with a tolerance: one decides where records go, leave the other out");
  }
  if (settings.overture && settings.max_records) {
    diagnostics.Add("settings.overture", "places records for less than the tolerance, and max records leaves that out");
  }
  if (settings.gather == Gather::kReference && settings.samples) {
    diagnostics.Add("settings.samples",
                    "does not apply where records gather from the reference, which draws no samples");
  }
  if (settings.gather == Gather::kReference && !DirectLightOnly(scene, settings)) {
    CheckPanels(scene, true, "settings.gather", "from-ray-tracing", diagnostics);
    if (scene.traits().has_beziers) {
      diagnostics.Add("settings.gather",
                      "reference gives no derivatives of light reflected in a scene with Bézier curves: use "
                      "from-ray-tracing");
    }
  }
  if (settings.target_error) {
    diagnostics.Add("settings.targetError", "does not apply to irradiance-caching: use tolerance or max records");
  }
  if (settings.time_limit) {
    diagnostics.Add("settings.timeLimit", "does not apply to irradiance-caching: use tolerance or max records");
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

void CheckReference(const Scene& scene, const Settings& settings, Diagnostics& diagnostics) {
  RefuseSampling(settings, diagnostics);
  CheckPanels(scene, !DirectLightOnly(scene, settings), "settings.method", "path-tracing", diagnostics);
  if (!DirectLightOnly(scene, settings) && scene.traits().has_beziers &&
      settings.derivatives.value_or(Derivatives::kNone) != Derivatives::kNone) {
    diagnostics.Add("settings.derivatives",
                    "reference gives none of light reflected in a scene with Bézier curves: leave this out, set max "
                    "bounces to 0, or use ray-tracing");
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
      const bool none = scene.traits().has_beziers && !DirectLightOnly(scene, settings);
      settings.derivatives = none ? Derivatives::kNone : Derivatives::kHessian;
    }
    if (!settings.target_error.has_value()) settings.target_error = kReferenceError;
    return;
  }
  if (settings.method == Method::kIrradianceCaching) {
    settings.derivatives = Derivatives::kNone;
    if (!settings.error_control) settings.error_control = ErrorControl::kVisibilityEvents;
    if (!settings.extrapolation) settings.extrapolation = 2;
    if (!settings.tolerance && !settings.max_records) settings.tolerance = kDefaultTolerance;
    if (DirectLightOnly(scene, settings)) return;
    const SceneTraits& traits = scene.traits();
    const bool panels = traits.lambertian && !traits.has_beziers && traits.elements <= kMostReferencePieces;
    if (!settings.gather) settings.gather = panels && !settings.samples ? Gather::kReference : Gather::kRayTracing;
    if (settings.gather == Gather::kRayTracing && !settings.samples) settings.samples = kDefaultGatherRays;
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
  PlanPass photons;
  photons.name = (settings.photons ? Text(*settings.photons) + " " : "") +
                 "photons from where light shines, sorted along the curves on which they arrive";
  if (!plan.Takes(skip::kEmission))
    photons.expected_rays = settings.photons.value_or(0) * ExpectedVertices(scene, plan);
  plan.passes.push_back(photons);
  points.name = gathers ? "direct light in closed form, and rays that look up densities of photons where they arrive"
                        : "densities of photons at the points";
  if (gathers) {
    points.samples = settings.photons ? std::ceil(*settings.samples / kBlockSamples) * kBlockSamples : 0;
    // A quarter more tells the bias.
    if (!plan.Takes(skip::kEmission)) points.expected_rays = 1.25 * points.points * points.samples;
  }
  plan.passes.push_back(points);
}

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
    if (plan.settings.max_records && !plan.Takes(skip::kEmission) && !plan.Takes(skip::kBounces))
      pass.expected_rays = *plan.settings.max_records * rays * ExpectedTree(scene, plan, rays);
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
  if (plan.settings.method == Method::kPhotonMapping) return text + HowPhotonsTell(scene, plan.settings) + ".";
  if (plan.settings.method == Method::kIrradianceCaching) {
    text +=
        plan.settings.max_records
            ? ", from " + Text(*plan.settings.max_records) + (*plan.settings.max_records == 1 ? " record" : " records")
            : ", from as many records as keep the estimated error below " + Text(100 * *plan.settings.tolerance) + " %";
    if (plan.settings.samples && !plan.Takes(skip::kBounces))
      text += ", " + Text(*plan.settings.samples) + " branching rays each";
  } else if (plan.settings.method != Method::kExact) {
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
