// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/scene_json.h"

#include "nlohmann/json.hpp"

namespace flatlight::stress {
namespace {

using Json = nlohmann::ordered_json;

Json PointJson(double x, double y) { return {{"x", x}, {"y", y}}; }

Json CurveJson(const CurveDescription& curve) {
  Json json{{"name", curve.name}};
  if (const auto* segment = std::get_if<SegmentDescription>(&curve.shape)) {
    json["segment"] = {{"a", PointJson(segment->a.x, segment->a.y)}, {"b", PointJson(segment->b.x, segment->b.y)}};
  } else if (const auto* polyline = std::get_if<PolylineDescription>(&curve.shape)) {
    Json points = Json::array();
    for (const Point2 point : polyline->points) points.push_back(PointJson(point.x, point.y));
    json["polyline"] = {{"points", points}, {"closed", polyline->closed}};
  } else if (const auto* arc = std::get_if<ArcDescription>(&curve.shape)) {
    json["arc"] = {{"center", PointJson(arc->center.x, arc->center.y)},
                   {"radius", arc->radius},
                   {"startAngle", arc->start_angle},
                   {"sweepAngle", arc->sweep_angle}};
  } else if (const auto* bezier = std::get_if<BezierDescription>(&curve.shape)) {
    json["bezier"] = {{"p0", PointJson(bezier->p0.x, bezier->p0.y)},
                      {"p1", PointJson(bezier->p1.x, bezier->p1.y)},
                      {"p2", PointJson(bezier->p2.x, bezier->p2.y)},
                      {"p3", PointJson(bezier->p3.x, bezier->p3.y)}};
  }
  json["material"] = curve.material;
  if (curve.emission) {
    json["emission"] = {{"radiance", curve.emission->radiance}, {"twoSided", curve.emission->two_sided}};
  }
  return json;
}

Json ProbeJson(const ProbeDescription& probe) {
  Json json{{"name", probe.name}};
  if (probe.curve) json["curve"] = *probe.curve;
  if (probe.count) json["count"] = *probe.count;
  if (probe.from) json["from"] = *probe.from;
  if (probe.to) json["to"] = *probe.to;
  if (probe.side) json["side"] = *probe.side == Side::kFront ? "FRONT" : "BACK";
  for (const ProbePointDescription& point : probe.points) {
    json["points"].push_back({{"position", PointJson(point.position.x, point.position.y)},
                              {"normal", PointJson(point.normal.x, point.normal.y)}});
  }
  return json;
}

}  // namespace

std::string SceneJson(const SceneDescription& scene) {
  Json plane{{"materials", Json::array()}, {"curves", Json::array()}};
  for (const MaterialDescription& material : scene.materials) {
    Json json{{"name", material.name}};
    if (const auto* lambertian = std::get_if<LambertianDescription>(&material.kind)) {
      json["lambertian"] = {{"reflectance", lambertian->reflectance}};
    }
    plane["materials"].push_back(json);
  }
  for (const CurveDescription& curve : scene.curves) plane["curves"].push_back(CurveJson(curve));
  Json json{{"name", scene.name}, {"plane", plane}, {"probes", Json::array()}};
  for (const ProbeDescription& probe : scene.probes) json["probes"].push_back(ProbeJson(probe));
  return json.dump(1) + "\n";
}

}  // namespace flatlight::stress
