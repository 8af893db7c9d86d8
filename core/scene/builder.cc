// SPDX-License-Identifier: Apache-2.0
#include "core/scene/builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>

#include "core/math/tolerances.h"
#include "core/math/trig.h"
#include "core/scene/bezier_chain.h"
#include "core/scene/hash.h"
#include "core/scene/overlap.h"
#include "core/scene/validate.h"

namespace flatlight {
namespace {

constexpr double kQuarter = 0x1.921fb54442d18p+0;

Spectrum ToSpectrum(const SpectrumValues& values) {
  return values.size() == 1 ? Spectrum::Grey(values[0]) : Spectrum{{values[0], values[1], values[2]}};
}

struct ToMaterial {
  Material operator()(std::monostate) const { return Lambertian{}; }
  Material operator()(const LambertianDescription& from) const { return Lambertian{ToSpectrum(from.reflectance)}; }
  Material operator()(const MirrorDescription& from) const { return Mirror{ToSpectrum(from.reflectance)}; }
  Material operator()(const DielectricDescription& from) const { return Dielectric{from.ior}; }
  Material operator()(const PhongDescription& from) const {
    // cos^0 would stop at pi/2 from the mirror direction (THEORY 17 A5).
    if (from.exponent == 0) return Lambertian{ToSpectrum(from.reflectance)};
    return Phong{ToSpectrum(from.reflectance), from.exponent};
  }
  Material operator()(const ConductorDescription& from) const {
    if (from.roughness == 0) return Mirror{ToSpectrum(from.reflectance)};
    return Conductor{ToSpectrum(from.reflectance), from.roughness * from.roughness};
  }
};

// Whether some spectrum has three values.
struct HasColours {
  bool operator()(std::monostate) const { return false; }
  bool operator()(const LambertianDescription& from) const { return from.reflectance.size() == 3; }
  bool operator()(const MirrorDescription& from) const { return from.reflectance.size() == 3; }
  bool operator()(const DielectricDescription&) const { return false; }
  bool operator()(const PhongDescription& from) const { return from.reflectance.size() == 3; }
  bool operator()(const ConductorDescription& from) const { return from.reflectance.size() == 3; }
  bool operator()(const PointLightDescription& from) const { return from.power.size() == 3; }
  bool operator()(const SpotLightDescription& from) const { return from.power.size() == 3; }
  bool operator()(const DirectionalLightDescription& from) const { return from.irradiance.size() == 3; }
};

// What counts as radiance when the frame is chosen: the light's irradiance at a distance of `size`.
struct Brightness {
  double size;
  double operator()(std::monostate) const { return 0; }
  double operator()(const PointLightDescription& light) const { return ToSpectrum(light.power).Max() / size; }
  double operator()(const SpotLightDescription& light) const {
    return ToSpectrum(light.power).Max() / (light.cone_angle + light.edge_angle) / size;
  }
  double operator()(const DirectionalLightDescription& light) const { return ToSpectrum(light.irradiance).Max(); }
};

struct Box {
  double low_x = std::numeric_limits<double>::infinity(), low_y = low_x, high_x = -low_x, high_y = -low_x;
  void Add(Point2 p) {
    low_x = std::min(low_x, p.x), low_y = std::min(low_y, p.y);
    high_x = std::max(high_x, p.x), high_y = std::max(high_y, p.y);
  }
};

// Pieces of at most a quarter; the count depends on the angle alone.
int ArcPieces(double sweep_angle) {
  return std::max(1, static_cast<int>(std::ceil(std::abs(sweep_angle) / kQuarter - 1e-9)));
}

Vector2 Radial(const ArcDescription& arc, double fraction) {
  // Not of the sum of the angles: it would round as the angles are large.
  const SinCosValue start = SinCos(arc.start_angle), turn = SinCos(fraction * arc.sweep_angle);
  return {start.cos * turn.cos - start.sin * turn.sin, start.sin * turn.cos + start.cos * turn.sin};
}

// From an arc's a to its b; `middle` is the radial direction halfway.
Vector2 Chord(const Element& arc, Vector2 middle) {
  return 2 * arc.radius * SinCos(0.5 * arc.sweep_angle).sin * Left(middle);
}

void AddShape(const CurveDescription& curve, Box& box) {
  if (const auto* segment = std::get_if<SegmentDescription>(&curve.shape)) {
    box.Add(segment->a), box.Add(segment->b);
  } else if (const auto* polyline = std::get_if<PolylineDescription>(&curve.shape)) {
    for (const Point2& point : polyline->points) box.Add(point);
  } else if (const auto* from = std::get_if<BezierDescription>(&curve.shape)) {
    const Bezier bezier{{from->p0, from->p1, from->p2, from->p3}};
    // With room for the arcs that follow it.
    const double room = bezier.IsStraight() ? 0 : 2 * kBezierShare * bezier.Extent();
    for (const Point2& p : bezier.Extremes()) box.Add({p.x - room, p.y - room}), box.Add({p.x + room, p.y + room});
  } else {
    const auto& arc = std::get<ArcDescription>(curve.shape);
    const int corners = 2 * ArcPieces(arc.sweep_angle);
    // Every other corner of a polygon around the arc: it is enclosed, with little to spare.
    const double outer = arc.radius / SinCos(arc.sweep_angle / corners).cos;
    for (int i = 0; i <= corners; ++i) {
      box.Add(arc.center + (i % 2 == 0 ? arc.radius : outer) * Radial(arc, static_cast<double>(i) / corners));
    }
  }
}

// The smallest power of two that is >= value > 0.
double PowerOfTwoAbove(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(1, mantissa == 0.5 ? exponent - 1 : exponent);
}

}  // namespace

SceneBuilder::SceneBuilder(const SceneDescription& description, Diagnostics& diagnostics)
    : description_(description), diagnostics_(diagnostics), scene_(std::make_shared<Scene>()) {}

std::shared_ptr<const Scene> SceneBuilder::Build() {
  ValidateScene(description_, SceneLimits{}, diagnostics_);
  if (!diagnostics_.empty()) return nullptr;
  scene_->name_ = description_.name;
  Normalise();
  AddCurves();
  if (!diagnostics_.empty()) return nullptr;
  scene_->elements_ = RemoveOverlaps(pieces_, kOverlapDistance / kTouchDistance * scene_->touch_distance_);
  std::size_t next = 0;
  for (std::size_t c = 0; c < scene_->curves_.size(); ++c) {
    Curve& curve = scene_->curves_[c];
    curve.first_element = static_cast<std::uint32_t>(next);
    while (next < scene_->elements_.size() && static_cast<std::size_t>(scene_->elements_[next].curve) == c) ++next;
    curve.element_count = static_cast<std::uint32_t>(next) - curve.first_element;
  }
  AddLights();
  AddProbes();
  Summarise();
  return scene_;
}

void SceneBuilder::Normalise() {
  Box box;
  for (const CurveDescription& curve : description_.curves) AddShape(curve, box);
  if (description_.curves.empty()) {
    for (const ProbeDescription& probe : description_.probes)
      for (const ProbePointDescription& point : probe.points) box.Add(point.position);
    for (const ProbeDescription& probe : description_.probes)
      if (probe.fluence) box.Add(*probe.fluence->min), box.Add(*probe.fluence->max);
    for (const ProbeDescription& probe : description_.probes)
      if (probe.camera) box.Add(probe.camera->position);
    for (const LightDescription& light : description_.lights) {
      if (const auto* point = std::get_if<PointLightDescription>(&light.kind)) box.Add(point->position);
      if (const auto* spot = std::get_if<SpotLightDescription>(&light.kind)) box.Add(spot->position);
    }
  }
  Frame& frame = scene_->frame_;
  const Point2 middle{0.5 * box.low_x + 0.5 * box.high_x, 0.5 * box.low_y + 0.5 * box.high_y};
  const double size =
      std::max({box.high_x - middle.x, middle.x - box.low_x, box.high_y - middle.y, middle.y - box.low_y});
  // No coordinate rounds: a scene around or near the world's origin keeps it, and from a farther one every difference
  // is exact (Sterbenz 1974: for numbers of one sign within a factor of 2).
  const auto origin = [&](double center) { return std::abs(center) < 2 * size ? 0 : center; };
  frame.origin = {origin(middle.x), origin(middle.y)};
  const double half = std::max({box.high_x - frame.origin.x, frame.origin.x - box.low_x, box.high_y - frame.origin.y,
                                frame.origin.y - box.low_y});
  frame.scale = half > 0 ? PowerOfTwoAbove(half) : 1;
  const double farthest = std::max(std::abs(frame.origin.x), std::abs(frame.origin.y));
  scene_->touch_distance_ = kTouchDistance * (1 + farthest / frame.scale);
  double radiance = 0;
  for (const CurveDescription& curve : description_.curves) {
    if (curve.emission) radiance = std::max(radiance, ToSpectrum(curve.emission->radiance).Max());
  }
  for (const LightDescription& light : description_.lights) {
    radiance = std::max(radiance, std::visit(Brightness{frame.scale}, light.kind));
  }
  if (description_.environment) radiance = std::max(radiance, ToSpectrum(description_.environment->radiance).Max());
  frame.radiance_scale = radiance > 0 ? PowerOfTwoAbove(radiance) : 1;
}

Spectrum SceneBuilder::ToNormalised(const SpectrumValues& values, double unit) const {
  Spectrum spectrum = ToSpectrum(values);
  for (double& value : spectrum.value) value /= unit;
  return spectrum;
}

Point2 SceneBuilder::ToFrame(Point2 world) {
  const Frame& frame = scene_->frame_;
  const Point2 p{(world.x - frame.origin.x) / frame.scale, (world.y - frame.origin.y) / frame.scale};
  // What the subtraction rounded away (Knuth's TwoSum), to know how well coordinates are known.
  const auto residual = [&](double value, double origin) {
    const double difference = value - origin;
    const double shifted = difference - value;
    return std::abs(((value - (difference - shifted)) + (-origin - shifted)) / frame.scale);
  };
  scene_->coordinate_error_ =
      std::max({scene_->coordinate_error_, residual(world.x, frame.origin.x), residual(world.y, frame.origin.y)});
  return p;
}

void SceneBuilder::AddCurves() {
  std::unordered_map<std::string, const MaterialDescription*> materials;
  for (const MaterialDescription& material : description_.materials) materials.emplace(material.name, &material);
  for (std::size_t c = 0; c < description_.curves.size(); ++c) {
    const CurveDescription& from = description_.curves[c];
    Curve curve;
    curve.name = from.name;
    curve.material = std::visit(ToMaterial(), materials.at(from.material)->kind);
    curve.reflectance = LargestAlbedo(curve.material);
    if (from.emission) {
      curve.radiance = ToNormalised(from.emission->radiance, scene_->frame_.radiance_scale);
      curve.two_sided = from.emission->two_sided;
    }
    first_piece_.push_back(static_cast<std::uint32_t>(pieces_.size()));
    if (const auto* segment = std::get_if<SegmentDescription>(&from.shape)) {
      AddPiece(c, ToFrame(segment->a), ToFrame(segment->b));
    } else if (const auto* polyline = std::get_if<PolylineDescription>(&from.shape)) {
      const std::size_t count = polyline->points.size();
      for (std::size_t i = 0; i + 1 < count + (polyline->closed ? 1 : 0); ++i) {
        AddPiece(c, ToFrame(polyline->points[i]), ToFrame(polyline->points[(i + 1) % count]));
      }
    } else if (const auto* bezier = std::get_if<BezierDescription>(&from.shape)) {
      AddBezier(c, *bezier);
    } else {
      AddArc(c, std::get<ArcDescription>(from.shape));
    }
    for (std::size_t i = first_piece_.back(); i < pieces_.size(); ++i) {
      pieces_[i].arc_begin = curve.length;
      curve.length += pieces_[i].length;
    }
    scene_->curves_.push_back(std::move(curve));
  }
  first_piece_.push_back(static_cast<std::uint32_t>(pieces_.size()));
}

void SceneBuilder::AddPiece(std::size_t curve, Point2 a, Point2 b) {
  Element piece;
  piece.curve = static_cast<CurveId>(curve);
  piece.carrier = static_cast<std::uint32_t>(pieces_.size());
  piece.a = a;
  piece.b = b;
  piece.length = Length(b - a);
  if (LengthSquared(b - a) < 1e-280) {
    diagnostics_.Add("plane.curves[" + std::to_string(curve) + "]",
                     "has a piece too short to be told from a point beside the size and place of the whole scene");
  }
  pieces_.push_back(piece);
}

void SceneBuilder::AddArc(std::size_t curve, const ArcDescription& arc) {
  const int count = ArcPieces(arc.sweep_angle);
  Element piece;
  piece.kind = Element::Kind::kArc;
  piece.curve = static_cast<CurveId>(curve);
  piece.center = ToFrame(arc.center);
  piece.radius = arc.radius / scene_->frame_.scale;
  piece.carrier =
      circles_.try_emplace({piece.center.x, piece.center.y, piece.radius}, static_cast<std::uint32_t>(pieces_.size()))
          .first->second;
  piece.sweep_angle = arc.sweep_angle / count;
  piece.length = std::abs(piece.sweep_angle) * piece.radius;
  const bool closed = std::abs(arc.sweep_angle) >= 4 * kQuarter;
  const Vector2 first = Radial(arc, 0);
  const auto on_circle = [&](Vector2 radial) { return piece.center + piece.radius * radial; };
  piece.radial_b = first;
  piece.b = on_circle(first);
  for (int i = 0; i < count; ++i) {
    piece.a = piece.b;
    piece.radial_a = piece.radial_b;
    piece.radial_b = closed && i + 1 == count ? first : Radial(arc, (i + 1.0) / count);
    // From the centre of a wide arc, which may be as far away as its radius, both ends would round on their own: by
    // more than the arc bulges.
    piece.b = piece.radius > 1 ? piece.a + Chord(piece, Radial(arc, (i + 0.5) / count)) : on_circle(piece.radial_b);
    pieces_.push_back(piece);
  }
  if (LengthSquared(piece.b - piece.a) < 1e-280) {
    diagnostics_.Add("plane.curves[" + std::to_string(curve) + "].arc",
                     "is too short to be told from a point beside the size and place of the whole scene");
  }
}

void SceneBuilder::AddBezier(std::size_t curve, const BezierDescription& description) {
  const Bezier bezier{
      {ToFrame(description.p0), ToFrame(description.p1), ToFrame(description.p2), ToFrame(description.p3)}};
  const double size = bezier.Extent();
  if (size < 1e-60) {  // Third powers of it are needed.
    diagnostics_.Add("plane.curves[" + std::to_string(curve) + "].bezier",
                     "is too short to be told from a point beside the size and place of the whole scene");
    return;
  }
  const auto number = static_cast<std::uint32_t>(scene_->beziers_.size());
  scene_->beziers_.push_back(bezier);
  // Runs of all curves have numbers of their own.
  const std::uint32_t runs = scene_->bezier_pieces_.empty() ? 0 : scene_->bezier_pieces_.back().run;
  BezierChain chain = MakeBezierChain(bezier, std::max(kBezierShare * size, 8 * scene_->touch_distance_));
  for (BezierChain::Piece& piece : chain.pieces) {
    piece.element.curve = static_cast<CurveId>(curve);
    piece.element.carrier = static_cast<std::uint32_t>(pieces_.size());
    piece.element.bezier_piece = static_cast<std::uint32_t>(scene_->bezier_pieces_.size());
    piece.on.bezier = number;
    piece.on.run += runs;
    scene_->bezier_distance_ = std::max(scene_->bezier_distance_, piece.on.distance);
    scene_->bezier_tilt_ = std::max(scene_->bezier_tilt_, piece.on.tilt);
    scene_->bezier_pieces_.push_back(piece.on);
    pieces_.push_back(piece.element);
  }
}

void SceneBuilder::AddLights() {
  const Frame& frame = scene_->frame_;
  const auto direction = [](Vector2 v) { return Normalized(v / std::max(std::abs(v.x), std::abs(v.y))); };
  for (const LightDescription& description : description_.lights) {
    Light light;
    light.name = description.name;
    if (const auto* directional = std::get_if<DirectionalLightDescription>(&description.kind)) {
      light.kind = DirectionalLight{direction(directional->direction),
                                    ToNormalised(directional->irradiance, frame.radiance_scale)};
    } else if (const auto* spot = std::get_if<SpotLightDescription>(&description.kind)) {
      const double radians = spot->cone_angle + spot->edge_angle;  // As many in the full intensity give the same flux.
      light.kind =
          PointLight{ToFrame(spot->position), ToNormalised(spot->power, radians * frame.scale * frame.radiance_scale),
                     direction(spot->direction), spot->cone_angle, spot->edge_angle};
    } else {
      const auto& point = std::get<PointLightDescription>(description.kind);
      const double unit = 4 * kQuarter * frame.scale * frame.radiance_scale;
      PointLight all_around;
      all_around.position = ToFrame(point.position);
      all_around.intensity = ToNormalised(point.power, unit);
      light.kind = all_around;
    }
    scene_->lights_.push_back(std::move(light));
  }
  if (description_.environment) {
    scene_->environment_ = ToNormalised(description_.environment->radiance, frame.radiance_scale);
  }
}

PixelGrid SceneBuilder::PictureOf(const FluenceDescription& description) {
  PixelGrid grid;
  grid.width = *description.width;
  grid.height = *description.height;
  if (description.min) {
    grid.low = ToFrame(*description.min), grid.high = ToFrame(*description.max);
    return grid;
  }
  // Everything, in square pixels.
  constexpr double kMargin = 0.03;  // Of the longer side, all around.
  Box box;
  for (const CurveDescription& curve : description_.curves) AddShape(curve, box);
  const Point2 low = ToFrame({box.low_x, box.low_y}), high = ToFrame({box.high_x, box.high_y});
  const Vector2 size = high - low;
  const double margin = 2 * kMargin * std::max(size.x, size.y);
  const double pixel = std::max((size.x + margin) / grid.width, (size.y + margin) / grid.height);
  const Vector2 half{0.5 * pixel * grid.width, 0.5 * pixel * grid.height};
  const Point2 middle = low + 0.5 * size;
  grid.low = middle - half, grid.high = middle + half;
  return grid;
}

void SceneBuilder::Summarise() {
  Scene& scene = *scene_;
  bool colours = false;
  for (const MaterialDescription& material : description_.materials) colours |= std::visit(HasColours(), material.kind);
  for (const CurveDescription& curve : description_.curves)
    colours |= curve.emission && curve.emission->radiance.size() == 3;
  for (const LightDescription& light : description_.lights) colours |= std::visit(HasColours(), light.kind);
  colours |= description_.environment && description_.environment->radiance.size() == 3;
  scene.channels_ = colours ? 3 : 1;

  SceneTraits& traits = scene.traits_;
  traits.curves = scene.curves_.size();
  traits.elements = scene.elements_.size();
  for (const Curve& curve : scene.curves_) {
    traits.emitting_curves += curve.Emits() ? 1 : 0;
    traits.max_reflectance = std::max(traits.max_reflectance, curve.reflectance.Max());
    traits.grey = traits.grey && curve.reflectance.IsGrey() && curve.radiance.IsGrey();
    traits.lambertian &= curve.reflectance.IsBlack() || std::holds_alternative<Lambertian>(curve.material);
  }
  traits.lights = scene.lights_.size();
  for (const Light& light : scene.lights_) {
    const auto* point = std::get_if<PointLight>(&light.kind);
    traits.grey &= (point ? point->intensity : std::get<DirectionalLight>(light.kind).irradiance).IsGrey();
  }
  traits.environment = !scene.environment_.IsBlack();
  traits.grey &= scene.environment_.IsGrey();
  for (const Element& element : scene.elements_) traits.has_arcs |= element.kind == Element::Kind::kArc;
  for (const BezierPiece& piece : scene_->bezier_pieces_) traits.has_beziers |= piece.bends;
  // Rounding of receivers, and of the points of arcs, comes on top of the shift's.
  scene.coordinate_error_ += (traits.has_arcs ? 6 : 2) * kUnitRoundoff;
  // A point of an arc of large radius is a small difference of large numbers.
  double largest_radius = 0;
  for (const Element& element : scene.elements_)
    // Arcs of Béziers are known by their ends and tangents.
    if (element.bezier_piece == Element::kNoBezier) largest_radius = std::max(largest_radius, element.radius);
  if (largest_radius > 1) scene.coordinate_error_ += 4 * kUnitRoundoff * largest_radius;
  for (const Probe& probe : scene.probes_) {
    traits.probe_points += probe.receivers.size();
    traits.camera_pixels += probe.camera ? probe.receivers.size() : 0;
    traits.pixels += probe.picture ? probe.picture->pixels() : 0;
  }
  scene.world_hash_ = HashWorld(description_);
  scene.probe_hash_ = HashProbes(description_);
}

std::shared_ptr<const Scene> BuildScene(const SceneDescription& description, Diagnostics& diagnostics) {
  return SceneBuilder(description, diagnostics).Build();
}

}  // namespace flatlight
