// SPDX-License-Identifier: Apache-2.0
#include "core/scene/validate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <unordered_map>

namespace flatlight {
namespace {

std::string Number(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, end.ptr);
}

// Cut to some 60 bytes, not inside a UTF-8 character: the API's strings must be UTF-8. Without control characters,
// which a terminal would obey.
std::string Quoted(std::string text) {
  constexpr std::size_t kShown = 60;
  std::size_t end = std::min(text.size(), kShown);
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end;
  const bool whole = end == text.size();
  text.resize(end);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return '"' + text + (whole ? "\"" : "...\"");
}

std::string Item(const std::string& list, std::size_t index) { return list + "[" + std::to_string(index) + "]"; }

// The unique names of one list, which must outlive this.
class Names {
 public:
  Names(std::string list, std::size_t size, Diagnostics& diagnostics)
      : list_(std::move(list)), diagnostics_(diagnostics) {
    index_.reserve(size);
  }

  void Add(const std::string& name, std::size_t index) {
    const auto path = [&] { return Item(list_, index) + ".name"; };
    if (name.empty()) {
      diagnostics_.Add(path(), "is missing or empty; every item needs a name");
    } else if (const auto [known, added] = index_.emplace(name, index); !added) {
      diagnostics_.Add(path(),
                       Quoted(name) + " is the name of " + Item(list_, known->second) + " too; names are unique");
    }
  }
  bool Has(const std::string& name) const { return index_.count(name) != 0; }
  // The names there are, a few of them.
  std::string Offer() const {
    constexpr std::size_t kShown = 8;
    if (index_.empty()) return "there is none";
    std::string text = "known:";
    std::size_t shown = 0;
    for (const auto& [name, index] : index_) {
      if (shown++ == kShown) return text + " ...";
      text += " " + Quoted(std::string(name));
    }
    return text;
  }

 private:
  std::string list_;
  Diagnostics& diagnostics_;
  std::unordered_map<std::string_view, std::size_t> index_;
};

class Validator {
 public:
  Validator(const SceneDescription& scene, const SceneLimits& limits, Diagnostics& diagnostics)
      : scene_(scene),
        limits_(limits),
        diagnostics_(diagnostics),
        materials_("plane.materials", scene.materials.size(), diagnostics),
        lights_("plane.lights", scene.lights.size(), diagnostics),
        curves_("plane.curves", std::min(scene.curves.size(), limits.max_curves), diagnostics),
        probes_("probes", scene.probes.size(), diagnostics) {}

  void Run() {
    if (scene_.name.size() > limits_.max_name_bytes) {
      diagnostics_.Add("name", "has " + std::to_string(scene_.name.size()) + " bytes; at most " +
                                   std::to_string(limits_.max_name_bytes) + " are allowed");
    }
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) CheckMaterial(i);
    if (scene_.curves.size() > limits_.max_curves) {
      diagnostics_.Add("plane.curves", "has " + std::to_string(scene_.curves.size()) + " curves; at most " +
                                           std::to_string(limits_.max_curves) + " are allowed");
      return;
    }
    for (std::size_t i = 0; i < scene_.curves.size(); ++i) CheckCurve(i);
    if (elements_ > limits_.max_elements) {
      diagnostics_.Add("plane.curves", "have " + std::to_string(elements_) + " pieces; at most " +
                                           std::to_string(limits_.max_elements) + " are allowed");
    }
    if (scene_.lights.size() > limits_.max_lights) {
      diagnostics_.Add("plane.lights", "has " + std::to_string(scene_.lights.size()) + " lights; at most " +
                                           std::to_string(limits_.max_lights) + " are allowed");
      return;
    }
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) CheckLight(i);
    if (scene_.environment) CheckBrightness(scene_.environment->radiance, "plane.environment.radiance");
    if (scene_.probes.empty()) diagnostics_.Add("probes", "is missing or empty; at least one probe is needed");
    for (std::size_t i = 0; i < scene_.probes.size(); ++i) CheckProbe(i);
    if (pixels_ > limits_.max_pixels) {
      diagnostics_.Add("probes", "have " + std::to_string(pixels_) + " pixels; at most " +
                                     std::to_string(limits_.max_pixels) + " are allowed");
    }
    if (probe_points_ > limits_.max_probe_points) {
      diagnostics_.Add("probes", "have " + std::to_string(probe_points_) + " points; at most " +
                                     std::to_string(limits_.max_probe_points) + " are allowed");
    }
  }

 private:
  void CheckSpectrum(const SpectrumValues& values, const std::string& path, double high, const std::string& allowed) {
    if (values.size() != 1 && values.size() != 3) {
      diagnostics_.Add(
          path, "has " + std::to_string(values.size()) + " values; 1 (grey) or 3 (red, green, blue) are allowed");
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!(values[i] >= 0 && values[i] <= high)) {
        diagnostics_.Add(Item(path, i), "is " + Number(values[i]) + "; allowed: " + allowed);
      }
    }
  }

  bool CheckRange(double value, double low, double high, const std::string& path) {
    if (value >= low && value <= high) return true;
    diagnostics_.Add(path, "is " + Number(value) + "; allowed: " + Number(low) + " to " + Number(high));
    return false;
  }

  bool CheckPoint(Point2 point, const std::string& path) {
    const bool x = CheckRange(point.x, -limits_.max_coordinate, limits_.max_coordinate, path + ".x");
    const bool y = CheckRange(point.y, -limits_.max_coordinate, limits_.max_coordinate, path + ".y");
    return x && y;
  }

  void CheckMaterial(std::size_t index) {
    const MaterialDescription& material = scene_.materials[index];
    const std::string path = Item("plane.materials", index);
    materials_.Add(material.name, index);
    if (const auto* lambertian = std::get_if<LambertianDescription>(&material.kind)) {
      CheckSpectrum(lambertian->reflectance, path + ".lambertian.reflectance", 1, "0 to 1");
    } else if (const auto* mirror = std::get_if<MirrorDescription>(&material.kind)) {
      CheckSpectrum(mirror->reflectance, path + ".mirror.reflectance", 1, "0 to 1");
    } else if (const auto* dielectric = std::get_if<DielectricDescription>(&material.kind)) {
      CheckRange(dielectric->ior, 0.01, 100, path + ".dielectric.ior");
    } else if (const auto* phong = std::get_if<PhongDescription>(&material.kind)) {
      CheckSpectrum(phong->reflectance, path + ".phong.reflectance", 1, "0 to 1");
      CheckRange(phong->exponent, 0, 1e6, path + ".phong.exponent");
    } else if (const auto* conductor = std::get_if<ConductorDescription>(&material.kind)) {
      CheckSpectrum(conductor->reflectance, path + ".conductor.reflectance", 1, "0 to 1");
      CheckRange(conductor->roughness, 0, 1, path + ".conductor.roughness");
    } else {
      diagnostics_.Add(path, "has no kind; allowed: lambertian, mirror, dielectric, phong, conductor");
    }
  }

  void CheckBrightness(const SpectrumValues& values, const std::string& path) {
    CheckSpectrum(values, path, limits_.max_radiance, "0 to " + Number(limits_.max_radiance));
  }

  bool CheckDirection(Vector2 direction, const std::string& path) {
    const bool x = CheckRange(direction.x, -limits_.max_coordinate, limits_.max_coordinate, path + ".x");
    const bool y = CheckRange(direction.y, -limits_.max_coordinate, limits_.max_coordinate, path + ".y");
    if (x && y && direction == Vector2{}) diagnostics_.Add(path, "is (0, 0); a direction is needed");
    return x && y && !(direction == Vector2{});
  }

  void CheckLight(std::size_t index) {
    const LightDescription& light = scene_.lights[index];
    const std::string path = Item("plane.lights", index);
    lights_.Add(light.name, index);
    if (const auto* point = std::get_if<PointLightDescription>(&light.kind)) {
      CheckPoint(point->position, path + ".point.position");
      CheckBrightness(point->power, path + ".point.power");
    } else if (const auto* spot = std::get_if<SpotLightDescription>(&light.kind)) {
      CheckPoint(spot->position, path + ".spot.position");
      CheckDirection(spot->direction, path + ".spot.direction");
      CheckBrightness(spot->power, path + ".spot.power");
      const bool cone = CheckRange(spot->cone_angle, 0, std::numbers::pi, path + ".spot.coneAngle");
      if (cone && CheckRange(spot->edge_angle, spot->cone_angle, std::numbers::pi, path + ".spot.edgeAngle") &&
          spot->edge_angle == 0) {
        diagnostics_.Add(path + ".spot.edgeAngle",
                         "is 0: the cone is empty; allowed: above 0 to " + Number(std::numbers::pi));
      }
    } else if (const auto* directional = std::get_if<DirectionalLightDescription>(&light.kind)) {
      CheckDirection(directional->direction, path + ".directional.direction");
      CheckBrightness(directional->irradiance, path + ".directional.irradiance");
    } else {
      diagnostics_.Add(path, "has no kind; allowed: point, spot, directional");
    }
  }

  void CheckCurve(std::size_t index) {
    const CurveDescription& curve = scene_.curves[index];
    const std::string path = Item("plane.curves", index);
    curves_.Add(curve.name, index);
    if (const auto* segment = std::get_if<SegmentDescription>(&curve.shape)) {
      CheckSegment(*segment, path + ".segment");
    } else if (const auto* polyline = std::get_if<PolylineDescription>(&curve.shape)) {
      CheckPolyline(*polyline, path + ".polyline");
    } else if (const auto* arc = std::get_if<ArcDescription>(&curve.shape)) {
      CheckArc(*arc, path + ".arc");
    } else if (const auto* bezier = std::get_if<BezierDescription>(&curve.shape)) {
      CheckBezier(*bezier, path + ".bezier");
    } else {
      diagnostics_.Add(path, "has no shape; allowed: segment, polyline, arc, bezier");
    }
    if (curve.material.empty()) {
      diagnostics_.Add(path + ".material", "is missing or empty; the name of a material is needed");
    } else if (!materials_.Has(curve.material)) {
      diagnostics_.Add(path + ".material", Quoted(curve.material) + " is not a material; " + materials_.Offer());
    }
    if (curve.emission) {
      CheckBrightness(curve.emission->radiance, path + ".emission.radiance");
    }
  }

  void CheckSegment(const SegmentDescription& segment, const std::string& path) {
    elements_ += 1;
    const bool a = CheckPoint(segment.a, path + ".a");
    const bool b = CheckPoint(segment.b, path + ".b");
    if (a && b && segment.a == segment.b) {
      diagnostics_.Add(path, "has zero length: a and b are both (" + Number(segment.a.x) + ", " + Number(segment.a.y) +
                                 "); they must differ");
    }
  }

  void CheckPolyline(const PolylineDescription& polyline, const std::string& path) {
    const std::size_t count = polyline.points.size();
    elements_ += count;
    if (count < 2) {
      diagnostics_.Add(path + ".points", "has " + std::to_string(count) + " points; at least 2 are needed");
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::string point = Item(path + ".points", i);
      if (!CheckPoint(polyline.points[i], point)) continue;
      if (i > 0 && polyline.points[i] == polyline.points[i - 1]) {
        diagnostics_.Add(point, "equals the point before it, (" + Number(polyline.points[i].x) + ", " +
                                    Number(polyline.points[i].y) + "); neighbours must differ");
      }
    }
    if (polyline.closed && count >= 2 && polyline.points.front() == polyline.points.back()) {
      diagnostics_.Add(Item(path + ".points", count - 1),
                       "equals the first point; a closed polyline returns to it by itself");
    }
  }

  void CheckArc(const ArcDescription& arc, const std::string& path) {
    elements_ += 5;
    CheckPoint(arc.center, path + ".center");
    if (!(arc.radius > 0 && arc.radius <= limits_.max_coordinate)) {
      diagnostics_.Add(path + ".radius",
                       "is " + Number(arc.radius) + "; allowed: above 0 to " + Number(limits_.max_coordinate));
    }
    CheckRange(arc.start_angle, -1e6, 1e6, path + ".startAngle");
    if (CheckRange(arc.sweep_angle, -2 * std::numbers::pi, 2 * std::numbers::pi, path + ".sweepAngle") &&
        arc.sweep_angle == 0) {
      diagnostics_.Add(path + ".sweepAngle", "is 0: the arc has zero length; allowed: -2 pi to 2 pi without 0");
    }
  }

  void CheckBezier(const BezierDescription& bezier, const std::string& path) {
    elements_ += 256;
    const bool p0 = CheckPoint(bezier.p0, path + ".p0"), p1 = CheckPoint(bezier.p1, path + ".p1");
    const bool p2 = CheckPoint(bezier.p2, path + ".p2"), p3 = CheckPoint(bezier.p3, path + ".p3");
    if (p0 && p1 && p2 && p3 && bezier.p1 == bezier.p0 && bezier.p2 == bezier.p0 && bezier.p3 == bezier.p0) {
      diagnostics_.Add(path, "has zero length: p0, p1, p2 and p3 are all (" + Number(bezier.p0.x) + ", " +
                                 Number(bezier.p0.y) + "); one of them must differ");
    }
  }

  void CheckProbe(std::size_t index) {
    const ProbeDescription& probe = scene_.probes[index];
    const std::string path = Item("probes", index);
    probes_.Add(probe.name, index);
    const int kinds =
        (probe.curve ? 1 : 0) + (probe.points.empty() ? 0 : 1) + (probe.fluence ? 1 : 0) + (probe.camera ? 1 : 0);
    if (kinds > 1) {
      diagnostics_.Add(path, "has more than one of curve, points, fluence and camera; exactly one is allowed");
    }
    if (kinds == 0) diagnostics_.Add(path, "has none of curve, points, fluence and camera; exactly one is needed");
    if (probe.camera) CheckCamera(*probe.camera, path + ".camera");
    if (probe.fluence) CheckPicture(*probe.fluence, path + ".fluence");
    if (probe.curve) {
      CheckCurveProbe(probe, path);
    } else {
      const auto refuse = [&](bool given, const char* field) {
        if (given) diagnostics_.Add(path + "." + field, "is given, but goes with a curve only");
      };
      refuse(probe.count.has_value(), "count");
      refuse(probe.from.has_value(), "from");
      refuse(probe.to.has_value(), "to");
      refuse(probe.side.has_value(), "side");
    }
    probe_points_ += probe.points.size();
    for (std::size_t i = 0; i < probe.points.size(); ++i) {
      const std::string point = Item(path + ".points", i);
      CheckPoint(probe.points[i].position, point + ".position");
      CheckDirection(probe.points[i].normal, point + ".normal");
    }
  }

  void CheckPicture(const FluenceDescription& picture, const std::string& path) {
    const bool min = picture.min && CheckPoint(*picture.min, path + ".min");
    const bool max = picture.max && CheckPoint(*picture.max, path + ".max");
    if (picture.min.has_value() != picture.max.has_value()) {
      diagnostics_.Add(
          path, picture.min ? "has min but no max; give both or neither" : "has max but no min; give both or neither");
    } else if (!picture.min && scene_.curves.empty()) {
      diagnostics_.Add(path, "has no min and max, and the scene no curves to put into the picture");
    }
    const auto check_order = [&](double low, double high, const char* axis) {
      if (!(low < high)) {
        diagnostics_.Add(path + ".max." + axis,
                         "is " + Number(high) + "; allowed: above min." + axis + ", " + Number(low));
      }
    };
    if (min && max) {
      check_order(picture.min->x, picture.max->x, "x");
      check_order(picture.min->y, picture.max->y, "y");
    }
    const auto check_side = [&](const std::optional<std::uint32_t>& side, const char* name) {
      const std::string allowed = "1 to " + std::to_string(limits_.max_picture_side);
      if (!side.has_value()) {
        diagnostics_.Add(path + "." + name, "is missing; a whole number of pixels, " + allowed + ", is needed");
      } else if (*side < 1 || *side > limits_.max_picture_side) {
        diagnostics_.Add(path + "." + name, "is " + std::to_string(*side) + "; allowed: " + allowed);
      } else {
        return true;
      }
      return false;
    };
    const bool width = check_side(picture.width, "width");
    const bool height = check_side(picture.height, "height");
    if (width && height) pixels_ += std::size_t{*picture.width} * *picture.height;
  }

  void CheckCamera(const CameraDescription& camera, const std::string& path) {
    const bool position = CheckPoint(camera.position, path + ".position");
    const bool target = CheckPoint(camera.target, path + ".target");
    const Vector2 sight = camera.target - camera.position;
    const double largest = std::max(std::abs(sight.x), std::abs(sight.y));
    if (position && target && !(largest > 0)) {
      diagnostics_.Add(path + ".target", "is the camera's position; it must be another point");
    }
    if (camera.up && CheckDirection(*camera.up, path + ".up") && position && target && largest > 0 &&
        Cross(ScaledToUnit(sight), ScaledToUnit(*camera.up)) == 0) {
      diagnostics_.Add(path + ".up", "lies along the line of sight; it must point to one of its sides");
    }
    if (!(camera.field_of_view > 0 && camera.field_of_view < std::numbers::pi)) {
      diagnostics_.Add(path + ".fieldOfView",
                       "is " + Number(camera.field_of_view) + "; allowed: between 0 and pi, without these");
    }
    const std::string allowed = "1 to " + std::to_string(limits_.max_probe_points);
    if (!camera.width) {
      diagnostics_.Add(path + ".width", "is missing; a whole number of pixels, " + allowed + ", is needed");
    } else if (*camera.width < 1 || *camera.width > limits_.max_probe_points) {
      diagnostics_.Add(path + ".width", "is " + std::to_string(*camera.width) + "; allowed: " + allowed);
    } else {
      probe_points_ += *camera.width;
    }
  }

  void CheckCurveProbe(const ProbeDescription& probe, const std::string& path) {
    if (!curves_.Has(*probe.curve)) {
      diagnostics_.Add(path + ".curve", Quoted(*probe.curve) + " is not a curve; " + curves_.Offer());
    }
    if (!probe.count) {
      diagnostics_.Add(path + ".count", "is missing; the number of points, 1 to " +
                                            std::to_string(limits_.max_probe_points) + ", is needed");
    } else if (*probe.count < 1 || *probe.count > limits_.max_probe_points) {
      diagnostics_.Add(path + ".count", "is " + std::to_string(*probe.count) + "; allowed: 1 to " +
                                            std::to_string(limits_.max_probe_points));
    } else {
      probe_points_ += *probe.count;
    }
    const double from = probe.from.value_or(0);
    const double to = probe.to.value_or(1);
    const bool from_good = CheckRange(from, 0, 1, path + ".from");
    const bool to_good = CheckRange(to, 0, 1, path + ".to");
    if (from_good && to_good && from == to)
      diagnostics_.Add(path + ".to", "equals from, " + Number(from) + "; they must differ");
  }

  const SceneDescription& scene_;
  const SceneLimits& limits_;
  Diagnostics& diagnostics_;
  Names materials_;
  Names lights_;
  Names curves_;
  Names probes_;
  std::size_t elements_ = 0;
  std::size_t probe_points_ = 0;
  std::size_t pixels_ = 0;
};

}  // namespace

void ValidateScene(const SceneDescription& description, const SceneLimits& limits, Diagnostics& diagnostics) {
  Validator(description, limits, diagnostics).Run();
}

}  // namespace flatlight
