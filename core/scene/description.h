// SPDX-License-Identifier: Apache-2.0
// A scene as its author wrote it: world units, names, nothing checked. BuildScene checks it.
#ifndef FLATLIGHT_CORE_SCENE_DESCRIPTION_H_
#define FLATLIGHT_CORE_SCENE_DESCRIPTION_H_

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/math/vec.h"

namespace flatlight {

enum class Side : std::uint8_t { kFront, kBack };

// Authors give one value (grey) or three.
using SpectrumValues = std::vector<double>;

struct LambertianDescription {
  SpectrumValues reflectance;
};

struct MirrorDescription {
  SpectrumValues reflectance;
};

struct DielectricDescription {
  double ior = 0;
};

struct PhongDescription {
  SpectrumValues reflectance;
  double exponent = 0;
};

struct ConductorDescription {
  SpectrumValues reflectance;
  double roughness = 0;
};

struct MaterialDescription {
  std::string name;
  std::variant<std::monostate, LambertianDescription, MirrorDescription, DielectricDescription, PhongDescription,
               ConductorDescription>
      kind;
};

struct SegmentDescription {
  Point2 a;
  Point2 b;
};

struct PolylineDescription {
  std::vector<Point2> points;
  bool closed = false;
};

struct ArcDescription {
  Point2 center;
  double radius = 0;
  double start_angle = 0;
  double sweep_angle = 0;
};

// Cubic, from p0 to p3.
struct BezierDescription {
  Point2 p0;
  Point2 p1;
  Point2 p2;
  Point2 p3;
};

struct EmissionDescription {
  SpectrumValues radiance;
  bool two_sided = false;
};

struct CurveDescription {
  std::string name;
  std::variant<std::monostate, SegmentDescription, PolylineDescription, ArcDescription, BezierDescription> shape;
  std::string material;
  std::optional<EmissionDescription> emission;
};

struct PointLightDescription {
  Point2 position;
  SpectrumValues power;
};

struct SpotLightDescription {
  Point2 position;
  Vector2 direction;
  SpectrumValues power;
  double cone_angle = 0;
  double edge_angle = 0;
};

struct DirectionalLightDescription {
  Vector2 direction;
  SpectrumValues irradiance;
};

struct LightDescription {
  std::string name;
  std::variant<std::monostate, PointLightDescription, SpotLightDescription, DirectionalLightDescription> kind;
};

struct EnvironmentDescription {
  SpectrumValues radiance;
};

struct ProbePointDescription {
  Point2 position;
  Vector2 normal;
};

struct FluenceDescription {
  // Both or neither.
  std::optional<Point2> min;
  std::optional<Point2> max;
  std::optional<std::uint32_t> width;
  std::optional<std::uint32_t> height;
};

struct CameraDescription {
  Point2 position;
  Point2 target;
  std::optional<Vector2> up;
  double field_of_view = 0;
  std::optional<std::uint32_t> width;
};

struct ProbeDescription {
  std::string name;
  std::optional<std::string> curve;
  std::optional<std::uint32_t> count;
  std::optional<double> from;
  std::optional<double> to;
  std::optional<Side> side;
  std::vector<ProbePointDescription> points;
  std::optional<FluenceDescription> fluence;
  std::optional<CameraDescription> camera;
};

struct SceneDescription {
  std::string name;
  std::vector<MaterialDescription> materials;
  std::vector<CurveDescription> curves;
  std::vector<LightDescription> lights;
  std::optional<EnvironmentDescription> environment;
  std::vector<ProbeDescription> probes;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_DESCRIPTION_H_
