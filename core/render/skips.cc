// SPDX-License-Identifier: Apache-2.0
#include "core/render/skips.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "core/plane/path_tracing/emitter_reach.h"
#include "core/plane/path_tracing/emitter_sampler.h"
#include "core/render/light_paths.h"

namespace flatlight {
namespace {

bool IsGiven(const Settings& settings, const char* name) {
  return std::find(settings.no_skip.begin(), settings.no_skip.end(), name) != settings.no_skip.end();
}

// What shapes tell of who lights what.
struct LightWays {
  LightWays(const Scene& scene, bool direct) {
    const EmitterReach reach = ReachOfEmitters(scene);
    const SceneTraits& traits = scene.traits();
    unlit_reflectors =
        traits.max_reflectance > 0 && traits.lights == 0 && !traits.environment && !reach.LightsReflectors();
    weighed = reach.pieces.size() <= EmitterSampler::kMostWeighed;
    if (!weighed) return;
    known = reach.ways;
    clear = reach.clear_ways;
    for (const EmitterReach::Piece& piece : reach.pieces) {
      unseen += EmitterReach::Counts(piece, direct) ? 0 : 1;
    }
  }

  bool unlit_reflectors = false;  // Something reflects, but no light comes to it.
  // Whether emitters are few enough to be weighed one by one. Only then is more known of each; and one that is left out
  // leaves the chances of the others as they are.
  bool weighed = false;
  std::size_t known = 0;   // Pairs of an emitting piece and a place it may light.
  std::size_t clear = 0;   // Those between which nothing stands.
  std::size_t unseen = 0;  // Emitting pieces whose light comes to nothing.
};

std::string Counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
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

void AddBounces(const Scene& scene, const Settings& settings, const LightWays& ways, Decisions& decisions) {
  const bool none_asked = settings.max_bounces == 0u;
  decisions.Add(skip::kBounces, !none_asked && (scene.traits().max_reflectance == 0 || ways.unlit_reflectors),
                ways.unlit_reflectors ? "no light comes to what reflects: direct light is all"
                                      : "nothing reflects: direct light is all",
                none_asked ? "max bounces 0 asks for none anyway" : "some curves reflect");
}

void AddBlackPaths(const Scene& scene, bool direct, Decisions& decisions) {
  const std::vector<Curve>& curves = scene.curves();
  const auto black = static_cast<std::size_t>(
      std::count_if(curves.begin(), curves.end(), [](const Curve& c) { return c.reflectance.IsBlack(); }));
  decisions.Add(skip::kBlackPaths, !direct && black > 0,
                "paths end at " + Counted(black, "black curve", "black curves"),
                direct ? "no path goes on from where it arrives" : "no curve is black");
}

}  // namespace

std::vector<SkipEntry> DecideSkips(const Scene& scene, const Settings& settings) {
  const SceneTraits& traits = scene.traits();
  Decisions decisions(settings);
  decisions.Add(skip::kEmission, AllDark(scene), "nothing emits: all is dark",
                traits.emitting_curves > 0 ? Counted(traits.emitting_curves, "curve emits", "curves emit")
                : traits.lights > 0        ? Counted(traits.lights, "light shines", "lights shine")
                                           : "the environment shines");
  const bool caching = settings.method == Method::kIrradianceCaching;
  const bool branching = settings.method == Method::kRayTracing || caching;
  const bool photons = settings.method == Method::kPhotonMapping;
  decisions.Add(skip::kColour, traits.grey && !branching && !photons, "all spectra are grey: one channel is computed",
                photons     ? "photons carry all channels at once"
                : caching   ? "records hold all channels at once"
                : branching ? "branching rays carry all channels at once"
                            : "some spectra are coloured");
  if (settings.method == Method::kReference) {
    const std::string reason = "light goes from panel to panel: it has no paths and no samples";
    decisions.Add(skip::kVisibility, false, "", "what each panel sees is found with what may hide it");
    for (const char* name : {skip::kBounces, skip::kBlackPaths, skip::kUnseenEmitters, skip::kConvergedPoints})
      decisions.Add(name, false, "", reason);
    return decisions.Take();
  }
  const bool nothing_blocks = NothingBlocks(scene);
  const std::string nothing_reason = "nothing can stand between two points: blockers are not looked for";
  if (settings.method == Method::kExact) {
    const bool pictures = traits.pixels > 0;
    decisions.Add(skip::kVisibility, nothing_blocks && !traits.environment && !pictures, nothing_reason,
                  !nothing_blocks ? "curves may block each other"
                  : pictures      ? "pictures may show what lies behind curves"
                                  : "curves block the environment");
    const std::string reason = "exact light is direct: it has no paths and no samples";
    for (const char* name : {skip::kBounces, skip::kBlackPaths, skip::kUnseenEmitters, skip::kConvergedPoints}) {
      decisions.Add(name, false, "", reason);
    }
    return decisions.Take();
  }
  const bool direct = DirectLightOnly(scene, settings);
  if (settings.method == Method::kPhotonMapping) {
    const std::string reason = "photons find out where light goes";
    decisions.Add(skip::kVisibility, false, "", reason);
    decisions.Add(skip::kBounces, false, "", direct ? "direct light is all that there is or is asked for" : reason);
    AddBlackPaths(scene, direct || !*settings.final_gather, decisions);
    decisions.Add(skip::kUnseenEmitters, false, "", reason);
    decisions.Add(skip::kConvergedPoints, false, "", "all points share their photons: they end together");
    return decisions.Take();
  }
  const LightWays ways(scene, direct);
  if (branching) {
    const bool rays = !caching || (settings.gather && settings.gather != Gather::kReference);
    const std::string reason = rays ? "branching rays find what they meet: no shadow tests, no emitters chosen"
                                    : "records find all that they see, in the order of its directions";
    decisions.Add(skip::kVisibility, false, "", reason);
    AddBounces(scene, settings, ways, decisions);
    if (rays) {
      AddBlackPaths(scene, direct, decisions);
    } else {
      decisions.Add(
          skip::kBlackPaths, false, "",
          direct ? "no path goes on from where it arrives" : "light goes from panel to panel: it has no paths");
    }
    decisions.Add(skip::kUnseenEmitters, false, "", reason);
    decisions.Add(
        skip::kConvergedPoints, false, "",
        caching ? "records are made where points need them" : "a point that has met the target error is done");
    return decisions.Take();
  }
  if (traits.probe_points == 0 && traits.pixels > 0) {
    const std::string reason = "light is followed from where it shines: no point looks for it";
    decisions.Add(skip::kVisibility, false, "", reason);
    AddBounces(scene, settings, ways, decisions);
    for (const char* name : {skip::kBlackPaths, skip::kUnseenEmitters, skip::kConvergedPoints}) {
      decisions.Add(name, false, "", reason);
    }
    return decisions.Take();
  }
  const std::string clear_reason = "nothing stands between an emitter and what it lights in " +
                                   std::to_string(ways.clear) + " of " + Counted(ways.known, "pair", "pairs") +
                                   ": no shadow tests there";
  decisions.Add(skip::kVisibility, nothing_blocks || ways.clear > 0, nothing_blocks ? nothing_reason : clear_reason,
                "curves may block each other");
  AddBounces(scene, settings, ways, decisions);
  AddBlackPaths(scene, direct, decisions);
  decisions.Add(skip::kUnseenEmitters, ways.unseen > 0,
                Counted(ways.unseen, "emitting piece lights ", "emitting pieces light ") +
                    (direct ? "no point" : "no point and nothing that reflects"),
                ways.weighed ? "all emitters light something, as far as shapes tell"
                             : "the emitters are too many to look at each");
  decisions.Add(skip::kConvergedPoints, settings.target_error.has_value(),
                "points that meet the target error get no more samples", "no target error was given");
  return decisions.Take();
}

const std::vector<std::string>& SkipNames() {
  static const auto& names =
      *new std::vector<std::string>{skip::kEmission,   skip::kColour,         skip::kVisibility,     skip::kBounces,
                                    skip::kBlackPaths, skip::kUnseenEmitters, skip::kConvergedPoints};
  return names;
}

}  // namespace flatlight
