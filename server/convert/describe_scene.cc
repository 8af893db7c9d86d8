// SPDX-License-Identifier: Apache-2.0
#include "server/convert/describe_scene.h"

#include <limits>
#include <string>
#include <utility>

namespace flatlight {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// A place in the scene file. Text is made only when something is missing: scenes may have a million curves.
struct Place {
  const Place* parent;
  const char* name;
  int index = -1;

  std::string Path() const {
    std::string path = parent == nullptr ? name : parent->Path() + '.' + name;
    if (index >= 0) path += '[' + std::to_string(index) + ']';
    return path;
  }
};

class Describer {
 public:
  explicit Describer(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  MaterialDescription Describe(const v1::Material& proto, const Place& place) {
    MaterialDescription material;
    material.name = proto.name();
    if (proto.has_lambertian()) {
      material.kind = LambertianDescription{Values(proto.lambertian().reflectance())};
    } else if (proto.has_mirror()) {
      material.kind = MirrorDescription{Values(proto.mirror().reflectance())};
    } else if (proto.has_dielectric()) {
      const Place dielectric{&place, "dielectric"};
      material.kind = DielectricDescription{Number(proto.dielectric().has_ior(), proto.dielectric().ior(),
                                                   {&dielectric, "ior"}, "a number from 0.01 to 100")};
    } else if (proto.has_phong()) {
      const Place phong{&place, "phong"};
      material.kind = PhongDescription{Values(proto.phong().reflectance()),
                                       Number(proto.phong().has_exponent(), proto.phong().exponent(),
                                              {&phong, "exponent"}, "a number from 0 to 1e6")};
    } else if (proto.has_conductor()) {
      const Place conductor{&place, "conductor"};
      material.kind = ConductorDescription{Values(proto.conductor().reflectance()),
                                           Number(proto.conductor().has_roughness(), proto.conductor().roughness(),
                                                  {&conductor, "roughness"}, "a number from 0 to 1")};
    }
    return material;
  }

  LightDescription Describe(const v1::Light& proto, const Place& place) {
    LightDescription light;
    light.name = proto.name();
    if (proto.has_point()) {
      const Place point{&place, "point"};
      light.kind =
          PointLightDescription{Point(proto.point().has_position(), proto.point().position(), {&point, "position"}),
                                Values(proto.point().power())};
    } else if (proto.has_spot()) {
      light.kind = Describe(proto.spot(), Place{&place, "spot"});
    } else if (proto.has_directional()) {
      const Place directional{&place, "directional"};
      light.kind = DirectionalLightDescription{
          Direction(proto.directional().has_direction(), proto.directional().direction(), {&directional, "direction"}),
          Values(proto.directional().irradiance())};
    }
    return light;
  }

  CurveDescription Describe(const v1::Curve& proto, const Place& place) {
    CurveDescription curve;
    curve.name = proto.name();
    if (proto.has_segment()) {
      const Place segment{&place, "segment"};
      curve.shape = SegmentDescription{Point(proto.segment().has_a(), proto.segment().a(), {&segment, "a"}),
                                       Point(proto.segment().has_b(), proto.segment().b(), {&segment, "b"})};
    } else if (proto.has_polyline()) {
      curve.shape = Describe(proto.polyline(), Place{&place, "polyline"});
    } else if (proto.has_arc()) {
      curve.shape = Describe(proto.arc(), Place{&place, "arc"});
    } else if (proto.has_bezier()) {
      curve.shape = Describe(proto.bezier(), Place{&place, "bezier"});
    }
    curve.material = proto.material();
    if (proto.has_emission()) {
      curve.emission = EmissionDescription{Values(proto.emission().radiance()), proto.emission().two_sided()};
    }
    return curve;
  }

  ProbeDescription Describe(const v1::Probe& proto, const Place& place) {
    ProbeDescription probe;
    probe.name = proto.name();
    if (proto.has_curve()) probe.curve = proto.curve();
    if (proto.has_count()) probe.count = proto.count();
    if (proto.has_from()) probe.from = proto.from();
    if (proto.has_to()) probe.to = proto.to();
    if (proto.side() == v1::Probe::FRONT) probe.side = Side::kFront;
    if (proto.side() == v1::Probe::BACK) probe.side = Side::kBack;
    probe.points.reserve(static_cast<std::size_t>(proto.points_size()));
    for (int i = 0; i < proto.points_size(); ++i) {
      const v1::ProbePoint& from = proto.points(i);
      const Place point{&place, "points", i};
      const Vector2 normal = Direction(from.has_normal(), from.normal(), {&point, "normal"});
      probe.points.push_back({Point(from.has_position(), from.position(), {&point, "position"}), normal});
    }
    if (proto.has_fluence()) {
      const v1::FluencePicture& from = proto.fluence();
      const Place fluence{&place, "fluence"};
      probe.fluence.emplace();
      if (from.has_min()) probe.fluence->min = Point(true, from.min(), {&fluence, "min"});
      if (from.has_max()) probe.fluence->max = Point(true, from.max(), {&fluence, "max"});
      if (from.has_width()) probe.fluence->width = from.width();
      if (from.has_height()) probe.fluence->height = from.height();
    }
    if (proto.has_camera()) {
      const v1::Camera& from = proto.camera();
      const Place camera{&place, "camera"};
      probe.camera.emplace();
      probe.camera->position = Point(from.has_position(), from.position(), {&camera, "position"});
      probe.camera->target = Point(from.has_target(), from.target(), {&camera, "target"});
      if (from.has_up()) probe.camera->up = Direction(true, from.up(), {&camera, "up"});
      probe.camera->field_of_view = Number(from.has_field_of_view(), from.field_of_view(), {&camera, "fieldOfView"},
                                           "a number between 0 and pi, in radians,");
      if (from.has_width()) probe.camera->width = from.width();
    }
    return probe;
  }

 private:
  PolylineDescription Describe(const v1::Polyline& proto, const Place& place) {
    PolylineDescription polyline;
    polyline.closed = proto.closed();
    polyline.points.reserve(static_cast<std::size_t>(proto.points_size()));
    for (int i = 0; i < proto.points_size(); ++i) {
      polyline.points.push_back(Point(true, proto.points(i), {&place, "points", i}));
    }
    return polyline;
  }

  ArcDescription Describe(const v1::Arc& proto, const Place& place) {
    ArcDescription arc;
    arc.center = Point(proto.has_center(), proto.center(), {&place, "center"});
    arc.radius = Number(proto.has_radius(), proto.radius(), {&place, "radius"}, "a number above 0, in metres,");
    arc.start_angle =
        Number(proto.has_start_angle(), proto.start_angle(), {&place, "startAngle"}, "a number, in radians,");
    arc.sweep_angle = Number(proto.has_sweep_angle(), proto.sweep_angle(), {&place, "sweepAngle"},
                             "a number from -2 pi to 2 pi and not 0, in radians,");
    return arc;
  }

  BezierDescription Describe(const v1::Bezier& proto, const Place& place) {
    BezierDescription bezier;
    bezier.p0 = Point(proto.has_p0(), proto.p0(), {&place, "p0"});
    bezier.p1 = Point(proto.has_p1(), proto.p1(), {&place, "p1"});
    bezier.p2 = Point(proto.has_p2(), proto.p2(), {&place, "p2"});
    bezier.p3 = Point(proto.has_p3(), proto.p3(), {&place, "p3"});
    return bezier;
  }

  SpotLightDescription Describe(const v1::SpotLight& proto, const Place& place) {
    SpotLightDescription spot;
    spot.position = Point(proto.has_position(), proto.position(), {&place, "position"});
    spot.direction = Direction(proto.has_direction(), proto.direction(), {&place, "direction"});
    spot.power = Values(proto.power());
    const char* const wanted = "a number from 0 to pi, in radians,";
    spot.cone_angle = Number(proto.has_cone_angle(), proto.cone_angle(), {&place, "coneAngle"}, wanted);
    spot.edge_angle = Number(proto.has_edge_angle(), proto.edge_angle(), {&place, "edgeAngle"}, wanted);
    return spot;
  }

  static SpectrumValues Values(const google::protobuf::RepeatedField<double>& values) {
    return {values.begin(), values.end()};
  }

  double Number(bool given, double value, const Place& place, const char* wanted) {
    if (given) return value;
    diagnostics_.Add(place.Path(), std::string("is missing; ") + wanted + " is needed");
    return kMissing;
  }

  // The two numbers of a point or of a direction.
  template <typename Proto>
  Point2 Pair(bool given, const Proto& proto, const Place& place, const char* wanted) {
    if (!given) {
      diagnostics_.Add(place.Path(), std::string("is missing; ") + wanted + " is needed");
      return {kMissing, kMissing};
    }
    const double x = Number(proto.has_x(), proto.x(), {&place, "x"}, "a number");
    const double y = Number(proto.has_y(), proto.y(), {&place, "y"}, "a number");
    return {x, y};
  }

  Point2 Point(bool given, const v1::Point2& proto, const Place& place) {
    return Pair(given, proto, place, "an object with x and y, in metres,");
  }

  Vector2 Direction(bool given, const v1::Vector2& proto, const Place& place) {
    const Point2 pair = Pair(given, proto, place, "an object with x and y, a direction,");
    return {pair.x, pair.y};
  }

  Diagnostics& diagnostics_;
};

}  // namespace

SceneDescription DescribeScene(const v1::Scene& proto, Diagnostics& diagnostics) {
  SceneDescription scene;
  scene.name = proto.name();
  if (!proto.has_plane()) diagnostics.Add("plane", "is missing; an object with materials and curves is needed");
  Describer describer(diagnostics);
  const v1::Plane& plane = proto.plane();
  const Place plane_place{nullptr, "plane"};
  for (int i = 0; i < plane.materials_size(); ++i) {
    scene.materials.push_back(describer.Describe(plane.materials(i), Place{&plane_place, "materials", i}));
  }
  scene.curves.reserve(static_cast<std::size_t>(plane.curves_size()));
  for (int i = 0; i < plane.curves_size(); ++i) {
    scene.curves.push_back(describer.Describe(plane.curves(i), Place{&plane_place, "curves", i}));
  }
  for (int i = 0; i < plane.lights_size(); ++i) {
    scene.lights.push_back(describer.Describe(plane.lights(i), Place{&plane_place, "lights", i}));
  }
  if (plane.has_environment()) {
    const auto& radiance = plane.environment().radiance();
    scene.environment = EnvironmentDescription{{radiance.begin(), radiance.end()}};
  }
  for (int i = 0; i < proto.probes_size(); ++i) {
    scene.probes.push_back(describer.Describe(proto.probes(i), Place{nullptr, "probes", i}));
  }
  return scene;
}

}  // namespace flatlight
