// SPDX-License-Identifier: Apache-2.0
// Irradiance from what is seen over mirrors and through glass: adaptive quadrature in angle.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_SPECULAR_GATHER_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_SPECULAR_GATHER_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/plane/chains/beam_cuts.h"
#include "core/plane/reference/chart.h"
#include "core/plane/reference/panel_light.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/plane/reference/specular_view.h"
#include "core/scene/scene.h"

namespace flatlight {

// What is emitted there.
Spectrum EmittedBy(const Scene& scene, const SpecularPiece& piece);

// Holds working memory: one for each thread. The caster and the charts must outlive it.
class SpecularGather {
 public:
  SpecularGather(const RayCaster& caster, const std::vector<Chart>& charts, const SpecularViewOptions& options)
      : scene_(caster.scene()), charts_(charts), view_(caster, options) {
    set_least_share(options.least_share);
  }

  SpecularView& view() { return view_; }
  // Of irradiance per radiance, over the whole half circle.
  double tolerance() const { return tolerance_; }
  void set_least_share(double least_share) {
    // What is less is rounding of places: halves of a stretch would differ by it however short they were.
    constexpr double kLeastTolerance = 1e-13;
    tolerance_ = std::max(least_share, kLeastTolerance);
    view_.set_least_share(least_share);
  }

  // Irradiance at the receiver from Legendre polynomials on a panel, in a part of a piece.
  struct Moments {
    std::array<double, kResidualCoefficients> value{};
    double error = 0;  // Of any of them, about.
  };

  // Irradiance from radiance 1 everywhere on the piece, but for the tint: value[0].
  Moments OfPiece(const Receiver& receiver, const SpecularPiece& piece) const;
  // Calls add(panel, moments) for the panels in the piece, in the order of theta; a panel may come more than once.
  // moments() are those of `count` polynomials.
  template <typename Add>
  void OfPanels(const Receiver& receiver, const SpecularPiece& piece, const PanelMesh& mesh, std::size_t count,
                const Add& add) const {
    VisitPanels(receiver, piece, mesh, [&](std::size_t panel, const Cuts::Cut& begin, const Cuts::Cut& end) {
      add(panel, [&] { return Of(receiver, piece, &mesh.panels()[panel], count, begin.at, end.at); });
    });
  }
  // Calls visit(panel, begin, end) for them: the numbers between which a panel is seen; what has no mark there is an
  // end of the piece.
  template <typename Visit>
  void VisitPanels(const Receiver& receiver, const SpecularPiece& piece, const PanelMesh& mesh,
                   const Visit& visit) const {
    if (piece.element == ElementId::kNone) return;
    const PanelMesh::Range range = mesh.On(piece.element, piece.side);
    if (range.first == range.last) return;
    const Chart& chart = charts_[static_cast<std::size_t>(piece.element)];
    Cuts cuts(piece.begin, piece.end);
    for (std::size_t i = range.first + 1; i < range.last; ++i)
      cuts.AddPassing(piece.lines, {chart.At(mesh.panels()[i].low).position});
    // Lines may pass the place where panels meet without ending there.
    std::size_t panel = range.last;
    Cuts::Cut begin{piece.begin, {}}, end = begin;
    const auto finish = [&] {
      if (panel != range.last) visit(panel, begin, end);
    };
    cuts.VisitCuts([&](const Cuts::Cut& from, const Cuts::Cut& to) {
      const std::size_t next = PanelAt(receiver, piece, mesh, 0.5 * (from.at + to.at));
      if (next != panel) {
        finish();
        panel = next, begin = from;
      }
      end = to;
    });
    finish();
  }

 private:
  using Values = std::array<double, kResidualCoefficients>;

  // Where a ray of the piece ends, by the element's chart; absent if rounding lets it miss.
  std::optional<double> PlaceOf(const Receiver& receiver, const SpecularPiece& piece, const SpecularRay& ray) const;
  std::size_t PanelAt(const Receiver& receiver, const SpecularPiece& piece, const PanelMesh& mesh, double x) const;
  // panel: null for radiance 1.
  Moments Of(const Receiver& receiver, const SpecularPiece& piece, const Panel* panel, std::size_t count, double from,
             double to) const;

  const Scene& scene_;
  const std::vector<Chart>& charts_;
  double tolerance_ = 0;
  SpecularView view_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_SPECULAR_GATHER_H_
