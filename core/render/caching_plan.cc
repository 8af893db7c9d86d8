// SPDX-License-Identifier: Apache-2.0
#include "core/render/caching_plan.h"

#include "core/render/light_paths.h"
#include "core/render/panel_plan.h"
#include "core/render/plan_text.h"

namespace flatlight {
namespace {

// Of a record, whose rays branch or end in a photon map.
constexpr std::uint32_t kDefaultGatherRays = 1024;
constexpr double kDefaultTolerance = 0.01;
constexpr std::uint32_t kDefaultPhotons = 1 << 16;
constexpr std::uint32_t kMostPhotons = 1 << 24;  // Some 100 bytes each.

}  // namespace

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
  if (settings.photons && settings.gather != Gather::kPhotonMap)
    diagnostics.Add("settings.photons", "applies to irradiance-caching where it gathers from-photon-map: use that");
  if (settings.gather == Gather::kPhotonMap) {
    if (settings.photons == 0u) diagnostics.Add("settings.photons", "is 0, must be at least 1");
    if (settings.photons > kMostPhotons)
      diagnostics.Add("settings.photons", "is " + Text(*settings.photons) + ", must be at most " + Text(kMostPhotons) +
                                              " where records gather from a photon map, which is kept whole");
    if (DirectLightOnly(scene, settings))
      diagnostics.Add("settings.gather", "is from-photon-map, but nothing is reflected: leave this out");
  }
  if (settings.gather == Gather::kReference && settings.samples) {
    diagnostics.Add("settings.samples",
                    "does not apply where records gather from the reference, which draws no samples");
  }
  if (settings.gather == Gather::kReference && !DirectLightOnly(scene, settings))
    CheckPanelDerivatives(scene, "settings.gather", "from-ray-tracing", diagnostics);
  if (settings.target_error) {
    diagnostics.Add("settings.targetError", "does not apply to irradiance-caching: use tolerance or max records");
  }
  if (settings.time_limit) {
    diagnostics.Add("settings.timeLimit", "does not apply to irradiance-caching: use tolerance or max records");
  }
}

void FillCachingDefaults(const Scene& scene, Settings& settings) {
  settings.derivatives = Derivatives::kNone;
  if (!settings.error_control) settings.error_control = ErrorControl::kVisibilityEvents;
  if (!settings.extrapolation) settings.extrapolation = 2;
  if (!settings.tolerance && !settings.max_records) settings.tolerance = kDefaultTolerance;
  if (DirectLightOnly(scene, settings)) return;
  if (!settings.gather)
    settings.gather = PanelsTellAll(scene) && !settings.samples ? Gather::kReference : Gather::kRayTracing;
  if (settings.gather != Gather::kReference && !settings.samples) settings.samples = kDefaultGatherRays;
  if (settings.gather == Gather::kPhotonMap && !settings.photons) settings.photons = kDefaultPhotons;
}

std::string HowRecordsTell(const Settings& settings, bool direct) {
  std::string text =
      settings.max_records
          ? ", from " + Text(*settings.max_records) + (*settings.max_records == 1 ? " record" : " records")
          : ", from as many records as keep the estimated error below " + Text(100 * *settings.tolerance) + " %";
  if (!settings.samples || direct) return text;
  text += ", " + Text(*settings.samples);
  if (settings.gather != Gather::kPhotonMap) return text + " branching rays each";
  return text + " rays each that end in a map of " + Text(*settings.photons) + " photons";
}

}  // namespace flatlight
