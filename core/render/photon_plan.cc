// SPDX-License-Identifier: Apache-2.0
#include "core/render/photon_plan.h"

#include <cmath>
#include <cstdint>
#include <optional>

#include "core/render/light_paths.h"
#include "core/render/plan_text.h"

namespace flatlight {
namespace {

// Of a final gather, whose rays end where they arrive.
constexpr std::uint32_t kDefaultLookups = 256;
constexpr std::uint32_t kDefaultPhotons = 1 << 16;

// Whether photon mapping adds a gather of rays; a default has its say.
bool Gathers(const Scene& scene, const Settings& settings) {
  return settings.final_gather.value_or(!DirectLightOnly(scene, settings));
}

// The name of a probe that has points off all curves; absent if there is none.
std::optional<std::string> ProbeOffCurves(const Scene& scene) {
  for (const Probe& probe : scene.probes()) {
    for (const Receiver& receiver : probe.receivers)
      if (receiver.element == ElementId::kNone) return probe.name;
  }
  return std::nullopt;
}

void CheckPhotonRanges(const Settings& settings, Diagnostics& diagnostics) {
  if (settings.photons == 0u) diagnostics.Add("settings.photons", "is 0, must be at least 1");
  if (settings.neighbours && *settings.neighbours < 2)
    diagnostics.Add("settings.neighbours", "is " + Text(*settings.neighbours) + ", must be at least 2");
  if (settings.bandwidth && !(*settings.bandwidth > 0 && std::isfinite(*settings.bandwidth)))
    diagnostics.Add("settings.bandwidth", "is " + Text(*settings.bandwidth) + " m, must be a number above 0");
  if (settings.bandwidth && settings.neighbours) {
    diagnostics.Add("settings.neighbours",
                    "is given together with a bandwidth: one decides how far photons count, leave the other out");
  }
}

}  // namespace

void CheckPhotonMapping(const Scene& scene, const Settings& settings, Diagnostics& diagnostics) {
  const bool direct = DirectLightOnly(scene, settings);
  const bool gathers = Gathers(scene, settings);
  if (settings.method != Method::kPhotonMapping || (gathers && direct)) {
    const std::string reason =
        settings.method == Method::kPhotonMapping
            ? "does not apply: without reflection a final gather takes all light in closed form, "
              "and needs no photons; leave this out, or set final gather to false"
            : "applies to photon-mapping alone: leave this out, or use that";
    // Irradiance caching may have them too, see CheckCaching.
    if (settings.photons && settings.method != Method::kIrradianceCaching) diagnostics.Add("settings.photons", reason);
    if (settings.bandwidth) diagnostics.Add("settings.bandwidth", reason);
    if (settings.neighbours) diagnostics.Add("settings.neighbours", reason);
    if (settings.kernel) diagnostics.Add("settings.kernel", reason);
    if (settings.method != Method::kPhotonMapping) {
      if (settings.final_gather) diagnostics.Add("settings.finalGather", reason);
    } else if (settings.samples) {
      diagnostics.Add("settings.samples", reason);
    }
    return;
  }
  CheckPhotonRanges(settings, diagnostics);
  if (gathers) return;
  const std::string cure = direct && !settings.final_gather ? ", which is the default where nothing reflects" : "";
  if (settings.samples)
    diagnostics.Add("settings.samples", "are rays of a final gather, and there is none" + cure + ": leave this out");
  if (settings.derivatives.value_or(Derivatives::kNone) != Derivatives::kNone)
    diagnostics.Add("settings.derivatives", "come from a final gather, and there is none" + cure + ": leave this out");
  if (const auto off = ProbeOffCurves(scene)) {
    diagnostics.Add("settings.finalGather", "is false" + cure + ", and probe \"" + *off +
                                                "\" has points that lie on no curve, where no photon arrives: set "
                                                "it to true");
  }
}

void FillPhotonDefaults(const Scene& scene, Settings& settings) {
  const bool open_ended = settings.target_error.has_value() || settings.time_limit.has_value();
  settings.final_gather = Gathers(scene, settings);
  const bool direct = DirectLightOnly(scene, settings);
  if (!settings.derivatives) {
    settings.derivatives = !*settings.final_gather ? Derivatives::kNone
                           : direct                ? Derivatives::kHessian
                                                   : Derivatives::kGradient;
  }
  if (*settings.final_gather && direct) return;
  if (!settings.photons && !open_ended) settings.photons = kDefaultPhotons;
  if (*settings.final_gather && !settings.samples) settings.samples = kDefaultLookups;
  if (!settings.kernel) settings.kernel = *settings.final_gather ? Kernel::kBox : Kernel::kEpanechnikov;
}

std::string HowPhotonsTell(const Scene& scene, const Settings& settings) {
  if (*settings.final_gather && DirectLightOnly(scene, settings)) return ", all of it in closed form";
  std::string text = settings.photons ? ", from " + Text(*settings.photons) + " photons" : ", from photons";
  if (*settings.final_gather) {
    text += " and a final gather of " + Text(*settings.samples) + " rays each";
    if (!settings.photons) text += " for the first photons and more for more";
  } else {
    text += ", by their density";
  }
  if (settings.target_error) text += ", until the error is " + Text(100 * *settings.target_error) + " %";
  if (settings.time_limit) text += ", for " + Text(*settings.time_limit) + " s";
  return text;
}

}  // namespace flatlight
