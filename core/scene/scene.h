// SPDX-License-Identifier: Apache-2.0
// The world that transport works on: validated, immutable, normalised.
//
// Coordinates are normalised: a point of the world is frame.origin + frame.scale * p with p in [-1, 1]^2 for every
// curve. The scale is a power of two, so normalising rounds nothing but the shift. Radiance is normalised by a power of
// two too.
#ifndef FLATLIGHT_CORE_SCENE_SCENE_H_
#define FLATLIGHT_CORE_SCENE_SCENE_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/math/bezier.h"
#include "core/math/vec.h"
#include "core/scene/description.h"
#include "core/scene/diagnostic.h"
#include "core/scene/light.h"
#include "core/scene/material.h"
#include "core/scene/spectrum.h"

namespace flatlight {

enum class CurveId : std::uint32_t { kNone = 0xffffffff };
enum class ElementId : std::uint32_t { kNone = 0xffffffff };

// A straight or arced piece of a curve, running from a to b; the front is on its left. Normalised coordinates.
// Arcs turn by at most a quarter. No two elements overlap: where curves do, the one listed first is there and the
// others are not.
struct Element {
  enum class Kind : std::uint8_t { kSegment, kArc };
  Kind kind = Kind::kSegment;
  CurveId curve = CurveId::kNone;
  Point2 a;
  Point2 b;
  double length = 0;
  double arc_begin = 0;  // Arc length from the curve's first point to a.
  // Arcs of one circle share a carrier: a ray that leaves one of them meets the circle again at one known place only.
  std::uint32_t carrier = 0;
  // What it stands for, if its curve is a Bézier: Scene::bezier_pieces().
  std::uint32_t bezier_piece = kNoBezier;
  static constexpr std::uint32_t kNoBezier = 0xffffffff;
  // Arcs only. The arc turns about center by sweep_angle (positive: counter-clockwise).
  Point2 center;
  double radius = 0;
  double sweep_angle = 0;
  Vector2 radial_a;  // Unit, from the centre to a. Neighbouring arcs of a circle share the bits at their common end.
  Vector2 radial_b;

  // +1 if the front faces the centre (counter-clockwise), -1 if it faces away, 0 if straight.
  double Orientation() const { return kind == Kind::kSegment ? 0 : sweep_angle > 0 ? 1 : -1; }
};

// The stretch of a Bézier curve that an element follows. The elements of one curve go over into each other without a
// corner, but at cusps.
struct BezierPiece {
  std::uint32_t bezier = 0;  // In Scene::beziers().
  std::uint32_t run = 0;     // Elements of one run bend to one side, by less than half a turn in all.
  double from = 0;           // Parameters.
  double to = 1;
  double distance = 0;  // The element is so far from the stretch, at most.
  double tilt = 0;      // Sine of the largest angle between them.
  bool bends = false;   // False if it is straight, or as good as a point: places and directions are the element's.
};

struct Curve {
  std::string name;
  Material material;
  Spectrum reflectance;  // No direction reflects (and transmits) more.
  Spectrum radiance;     // Normalised. Black if the curve does not emit.
  bool two_sided = false;
  std::uint32_t first_element = 0;
  std::uint32_t element_count = 0;
  double length = 0;

  bool Emits() const { return !radiance.IsBlack(); }
  // Radiance leaving one of the curve's sides.
  Spectrum EmittedRadiance(Side side) const { return side == Side::kFront || two_sided ? radiance : Spectrum{}; }
};

// A point at which light is wanted. Normalised coordinates.
struct Receiver {
  Point2 position;                       // On the piece.
  Vector2 offset;                        // From there to the point itself, if the piece stands for a Bézier.
  Vector2 normal;                        // Unit, toward the side that receives; of a pixel along its middle direction.
  Vector2 tangent;                       // Unit, along increasing arc length; (normal.y, -normal.x) for a free point.
  double curvature = 0;                  // kappa: d(tangent)/d(arc length) = kappa * normal.
  double curvature_change = 0;           // d(kappa)/d(arc length),
  double curvature_second = 0;           // and its derivative.
  ElementId element = ElementId::kNone;  // The piece it lies on.
  double arc_length = 0;
  double displaced = 0;  // How far from where the author put it: see kLiftTouches. On a Bézier, bound on it.
  // Bounds on errors beyond rounding, on a Bézier: of the tangent's angle, of the curvature, of its change.
  double tilt = 0;
  double curvature_error = 0;
  double curvature_change_error = 0;
  // 0: irradiance, from the half circle. In (0, pi/2]: radiance summed up by angle, so far to both sides of the normal.
  double half_angle = 0;
};

// A picture of a part of the plane. Normalised coordinates.
struct PixelGrid {
  Point2 low;
  Point2 high;
  std::uint32_t width = 0;  // Pixels. Row 0 is the lowest.
  std::uint32_t height = 0;

  std::size_t pixels() const { return std::size_t{width} * height; }
};

struct Probe {
  std::string name;
  CurveId curve = CurveId::kNone;  // kNone: free points.
  bool on_curve = false;           // Every point lies on a piece of `curve`, and looks to the same side of it.
  Point2 low;                      // All points lie in this box.
  Point2 high;
  std::vector<Receiver> receivers;
  std::optional<PixelGrid> picture;  // In place of receivers: fluence, averaged over each pixel.
  bool camera = false;               // Receivers are its pixels.

  // Of which there are values.
  std::size_t points() const { return picture ? picture->pixels() : receivers.size(); }
};

struct Frame {
  Point2 origin;
  double scale = 1;           // m per normalised unit of length.
  double radiance_scale = 1;  // W/(rad m) per normalised unit of radiance.
};

// What the planner asks.
struct SceneTraits {
  std::size_t curves = 0;
  std::size_t elements = 0;
  std::size_t emitting_curves = 0;
  std::size_t probe_points = 0;   // Pixels aside.
  std::size_t camera_pixels = 0;  // Among them.
  std::size_t pixels = 0;         // Of all pictures.
  std::size_t lights = 0;         // Without a surface.
  double max_reflectance = 0;
  bool lambertian = true;    // Nothing but Lambertian curves reflects.
  bool environment = false;  // Light comes from infinitely far away, all around.
  bool grey = true;          // All channels equal everywhere.
  bool has_arcs = false;
  bool has_beziers = false;  // That are not straight.
};

class Scene {
 public:
  const std::string& name() const { return name_; }
  int channels() const { return channels_; }
  const Frame& frame() const { return frame_; }
  // Normalised coordinates are known to this distance: rounding of the input and of the shift.
  double coordinate_error() const { return coordinate_error_; }
  // Curves this close touch: rays find no gap between them, a free point this close to a curve lies on it.
  double touch_distance() const { return touch_distance_; }
  const std::vector<Element>& elements() const { return elements_; }
  const std::vector<Curve>& curves() const { return curves_; }
  const std::vector<Bezier>& beziers() const { return beziers_; }
  const std::vector<BezierPiece>& bezier_pieces() const { return bezier_pieces_; }
  // Null if the element stands for itself.
  const BezierPiece* bezier_piece(const Element& element) const {
    return element.bezier_piece == Element::kNoBezier ? nullptr : &bezier_pieces_[element.bezier_piece];
  }
  // How far the elements of Béziers are from these, and the largest sine of an angle between both; 0 if there are none.
  double bezier_distance() const { return bezier_distance_; }
  double bezier_tilt() const { return bezier_tilt_; }
  const std::vector<Light>& lights() const { return lights_; }
  const Spectrum& environment() const { return environment_; }  // Normalised radiance, from all directions.
  const std::vector<Probe>& probes() const { return probes_; }
  const Element& element(ElementId id) const { return elements_[static_cast<std::size_t>(id)]; }
  const Curve& curve(CurveId id) const { return curves_[static_cast<std::size_t>(id)]; }
  const Curve& curve_of(ElementId id) const { return curve(element(id).curve); }
  const SceneTraits& traits() const { return traits_; }
  // SHA-256 over geometry, materials and lights, and over probes; 64 hexadecimal digits. Names don't count.
  const std::string& world_hash() const { return world_hash_; }
  const std::string& probe_hash() const { return probe_hash_; }

  Point2 ToWorld(Point2 p) const {
    return {frame_.origin.x + frame_.scale * p.x, frame_.origin.y + frame_.scale * p.y};
  }

 private:
  friend class SceneBuilder;
  std::string name_;
  int channels_ = 1;
  Frame frame_;
  double coordinate_error_ = 0;
  double touch_distance_ = 0;
  std::vector<Element> elements_;
  std::vector<Curve> curves_;
  std::vector<Bezier> beziers_;
  std::vector<BezierPiece> bezier_pieces_;
  double bezier_distance_ = 0;
  double bezier_tilt_ = 0;
  std::vector<Light> lights_;
  Spectrum environment_;
  std::vector<Probe> probes_;
  SceneTraits traits_;
  std::string world_hash_;
  std::string probe_hash_;
};

// Null if the description has mistakes; all of them are then in `diagnostics`.
std::shared_ptr<const Scene> BuildScene(const SceneDescription& description, Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_SCENE_H_
