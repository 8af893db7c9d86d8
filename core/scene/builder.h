// SPDX-License-Identifier: Apache-2.0
// The steps from a valid description to a Scene, in order.
#ifndef FLATLIGHT_CORE_SCENE_BUILDER_H_
#define FLATLIGHT_CORE_SCENE_BUILDER_H_

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "core/scene/description.h"
#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"

namespace flatlight {

class SceneBuilder {
 public:
  SceneBuilder(const SceneDescription& description, Diagnostics& diagnostics);
  std::shared_ptr<const Scene> Build();

 private:
  // Chooses the frame: the box around all curves goes to [-1, 1]^2, the largest radiance to [1/2, 1].
  void Normalise();
  Point2 ToFrame(Point2 world);
  Spectrum ToNormalised(const SpectrumValues& values, double unit) const;
  // Cuts curves into elements, before overlaps are taken out.
  void AddCurves();
  void AddPiece(std::size_t curve, Point2 a, Point2 b);
  void AddArc(std::size_t curve, const ArcDescription& arc);
  void AddBezier(std::size_t curve, const BezierDescription& bezier);
  void AddLights();
  void AddProbes();
  PixelGrid PictureOf(const FluenceDescription& description);
  void AddCurveProbe(const ProbeDescription& description, Probe& probe) const;
  // The element of a curve at an arc length; kNone where another curve covers it.
  ElementId ElementAt(const Curve& curve, double arc_length) const;
  // Bound on what arc length along a Bézier is off by; 0 of other curves.
  double LengthError(std::size_t curve) const;
  void AddCamera(const CameraDescription& camera, Probe& probe);
  void AddPointProbe(const ProbeDescription& description, Probe& probe);
  void Summarise();

  const SceneDescription& description_;
  Diagnostics& diagnostics_;
  std::shared_ptr<Scene> scene_;
  std::vector<Element> pieces_;             // Of all curves, overlapping or not.
  std::vector<std::uint32_t> first_piece_;  // Of each curve, and one past the last.
  // Carriers by centre and radius: arcs of one circle share theirs, whatever curves they belong to.
  std::map<std::array<double, 3>, std::uint32_t> circles_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_BUILDER_H_
