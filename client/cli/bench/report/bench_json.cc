// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/report/bench_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "client/cli/bench/analysis/findings.h"
#include "client/cli/bench/analysis/time_to.h"
#include "client/cli/bench/report/versus_text.h"
#include "client/cli/formats/json_text.h"

namespace flatlight {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMissed = 0.05;

std::string Text(const Json& json) {
  return LayOutJson(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

Json PointJson(const PointSummary& point) {
  Json json;
  if (point.budget) json["budget"] = *point.budget;
  json["runs"] = point.runs;
  json["seeds"] = point.seeds;
  json["cpuSeconds"] = {{"median", point.cpu_median}, {"least", point.cpu_least}};
  json["wallSeconds"] = {{"median", point.wall_median}, {"least", point.wall_least}};
  json["rays"] = point.rays;
  json["rms"] = point.rms;
  json["max"] = point.largest;
  json["relative"] = point.relative;
  if (point.truth_relative > 0) json["truthRelative"] = point.truth_relative;
  if (point.bias)
    json["bias"] = {
        {"rms", point.bias->rms}, {"noise", point.bias->noise_rms}, {"probability", point.bias->probability}};
  if (point.mean_z2) json["meanZ2"] = point.mean_z2->value;
  if (point.relative > kRoundingError && point.Efficiency()) json["efficiency"] = *point.Efficiency();
  return json;
}

Json FitJson(const PowerFit& fit) {
  const double half = HalfWidth(fit.slope, kMissed);
  return {{"slope", fit.slope.value}, {"low", fit.slope.value - half}, {"high", fit.slope.value + half}};
}

Json TimesToJson(const Curve& curve) {
  Json json = Json::array();
  for (const double error : kTargetErrors) {
    const TimeTo time = TimeToError(curve, error);
    constexpr const char* kSources[] = {"MEASURED", "AT_MOST", "EXTRAPOLATED", "UNKNOWN"};
    json.push_back({{"relativeError", error}, {"source", kSources[static_cast<int>(time.source)]}});
    if (time.source != TimeTo::Source::kUnknown) json.back()["cpuSeconds"] = time.seconds;
  }
  return json;
}

void AddRatio(Json& json, const char* name, const std::optional<Ratio>& ratio) {
  if (!ratio) return;
  json[name] = {{"ratio", ratio->value}};
  if (std::isfinite(ratio->high)) {
    json[name]["low"] = ratio->low;
    json[name]["high"] = ratio->high;
  }
  json[name]["verdict"] = ChangeText(ratio->change);
}

Json VersusPointJson(const PointVersus& point) {
  Json json;
  if (!point.scene.empty()) {
    json["scene"] = point.scene;
    json["method"] = point.method;
    if (point.budget) json["budget"] = *point.budget;
    json["quantity"] = NameOf(point.quantity);
  }
  json["runs"] = {point.runs_a, point.runs_b};
  AddRatio(json, "time", point.time);
  AddRatio(json, "error", point.error);
  AddRatio(json, "efficiency", point.efficiency);
  json["verdict"] = ChangeText(point.verdict);
  if (point.runs_needed) json["runsNeeded"] = *point.runs_needed;
  return json;
}

}  // namespace

std::string BenchJson(const std::vector<Curve>& curves, const std::vector<BenchRow>& rows) {
  Json json;
  if (!rows.empty()) {
    const BenchRow& row = rows.back();
    json["machine"] = {{"processor", row.processor}, {"processors", row.processors}, {"threads", row.threads}};
    json["client"] = row.client;
    json["server"] = row.server;
  }
  json["curves"] = Json::array();
  for (const Curve& curve : curves) {
    Json entry = {{"scene", curve.scene},
                  {"method", curve.method},
                  {"settings", curve.settings},
                  {"truth", curve.truth},
                  {"quantity", NameOf(curve.quantity)}};
    entry["points"] = Json::array();
    for (const PointSummary& point : curve.points) entry["points"].push_back(PointJson(point));
    if (curve.over_time) entry["slopeOverTime"] = FitJson(*curve.over_time);
    if (curve.over_samples) entry["slopeOverSamples"] = FitJson(*curve.over_samples);
    entry["timeTo"] = TimesToJson(curve);
    json["curves"].push_back(std::move(entry));
  }
  json["findings"] = FindingsOf(curves);
  return Text(json);
}

std::string VersusJson(const Versus& versus) {
  Json json;
  json["points"] = Json::array();
  for (const PointVersus& point : versus.points) json["points"].push_back(VersusPointJson(point));
  json["overall"] = VersusPointJson(versus.overall);
  json["notes"] = versus.notes;
  return Text(json);
}

}  // namespace flatlight
