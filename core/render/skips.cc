// SPDX-License-Identifier: Apache-2.0
#include "core/render/skips.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "core/plane/path_tracing/emitter_sampler.h"
#include "core/render/light_paths.h"

namespace flatlight {
namespace {

// Of a piece and a point. Above, planning would take longer than what the skip saves.
constexpr std::size_t kMostPairsFaced = 100'000;

bool IsGiven(const Settings& settings, const char* name) {
  return std::find(settings.no_skip.begin(), settings.no_skip.end(), name) != settings.no_skip.end();
}

// How many emitting pieces light no point directly; 0 where that would take long to find out.
std::size_t UnseenEmitters(const Scene& scene) {
  if (scene.traits().emitting_curves > EmitterSampler::kMostWeighed) return 0;
  EmitterSampler sampler(std::shared_ptr<const Scene>(std::shared_ptr<const Scene>(), &scene));
  if (sampler.empty() || !sampler.weighs()) return 0;
  if (scene.traits().probe_points > kMostPairsFaced / EmitterSampler::kMostWeighed) return 0;
  return sampler.DropUnseen();
}

class Decisions {
 public:
  explicit Decisions(const Settings& settings) : settings_(settings) {}

  // Either reason says why.
  void Add(const char* name, bool applies, const std::string& reason, const std::string& reason_against) {
    SkipEntry entry;
    entry.name = name;
    entry.reason = applies ? reason : reason_against;
    if (applies) entry.decision = IsGiven(settings_, name) ? SkipDecision::kDisabled : SkipDecision::kTaken;
    entries_.push_back(std::move(entry));
  }

  std::vector<SkipEntry> Take() { return std::move(entries_); }

 private:
  const Settings& settings_;
  std::vector<SkipEntry> entries_;
};

}  // namespace

std::vector<SkipEntry> DecideSkips(const Scene& scene, const Settings& settings) {
  const SceneTraits& traits = scene.traits();
  const bool exact = settings.method == Method::kExact;
  const bool direct = DirectLightOnly(scene, settings);
  Decisions decisions(settings);
  decisions.Add(
      skip::kEmission, traits.emitting_curves == 0, "nothing emits: all is dark",
      std::to_string(traits.emitting_curves) + (traits.emitting_curves == 1 ? " curve emits" : " curves emit"));
  decisions.Add(skip::kColour, traits.grey, "all spectra are grey: one channel is computed",
                "some spectra are coloured");
  decisions.Add(skip::kVisibility, NothingBlocks(scene),
                "nothing can stand between two points: blockers are not looked for", "curves may block each other");
  if (exact) {
    const bool none = settings.derivatives == Derivatives::kNone;
    decisions.Add(skip::kDerivatives, settings.derivatives != Derivatives::kHessian,
                  none ? "no derivatives were asked for" : "the second derivative was not asked for",
                  "both derivatives were asked for");
  } else {
    decisions.Add(skip::kDerivatives, false, "", "path tracing gives none");
  }
  if (exact) {
    const std::string reason = "exact light is direct: it has no paths and no samples";
    for (const char* name : {skip::kBounces, skip::kBlackPaths, skip::kUnseenEmitters, skip::kConvergedPoints}) {
      decisions.Add(name, false, "", reason);
    }
    return decisions.Take();
  }
  decisions.Add(skip::kBounces, traits.max_reflectance == 0, "nothing reflects: direct light is all",
                settings.max_bounces == 0u ? "max bounces 0 asks for none anyway" : "some curves reflect");
  const std::vector<Curve>& curves = scene.curves();
  const auto black =
      std::count_if(curves.begin(), curves.end(), [](const Curve& c) { return c.reflectance.IsBlack(); });
  decisions.Add(skip::kBlackPaths, black > 0,
                "paths end at " + std::to_string(black) + (black == 1 ? " black curve" : " black curves"),
                "no curve is black");
  const std::size_t unseen = direct ? UnseenEmitters(scene) : 0;
  decisions.Add(skip::kUnseenEmitters, unseen > 0,
                std::to_string(unseen) + " emitting " + (unseen == 1 ? "piece faces" : "pieces face") + " no point",
                direct ? "all emitters face some point, as far as a quick look tells"
                       : "light of any emitter may arrive by reflection");
  decisions.Add(skip::kConvergedPoints, settings.target_error.has_value(),
                "points that meet the target error get no more samples", "no target error was given");
  return decisions.Take();
}

const std::vector<std::string>& SkipNames() {
  static const auto& names =
      *new std::vector<std::string>{skip::kEmission, skip::kColour,     skip::kVisibility,     skip::kDerivatives,
                                    skip::kBounces,  skip::kBlackPaths, skip::kUnseenEmitters, skip::kConvergedPoints};
  return names;
}

}  // namespace flatlight
