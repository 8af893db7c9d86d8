// SPDX-License-Identifier: Apache-2.0
// What a point receives from each panel of a mesh: a row of the radiosity matrix.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_ROW_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_ROW_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/plane/exact/edge.h"
#include "core/plane/reference/outlook.h"
#include "core/plane/reference/panel_light.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/plane/reference/specular_gather.h"
#include "core/plane/reference/stretch.h"
#include "core/scene/spectrum.h"

namespace flatlight {

struct Row {
  // What of an element's side is seen, in its chart.
  struct Stretch {
    ElementId element = ElementId::kNone;
    Side side = Side::kFront;
    double low = 0;
    double high = 1;
  };

  Spectrum direct;                 // Irradiance straight from emitters, lights and the environment.
  double coordinates = 0;          // What it is off by, as coordinates are, for light of radiance 1.
  Spectrum brightest;              // Radiance of what emits in its sight, the largest.
  std::vector<Stretch> stretches;  // Of what has panels, in the order of theta; each is seen once.
  // What is seen over mirrors and through glass; what of it is not known, as irradiance per radiance.
  std::vector<SpecularPiece> specular;
  double lost = 0;
  // Of the entries, which come in the order of stretches, then of specular pieces. A panel may come more than once.
  std::vector<std::uint32_t> panels;
  std::vector<Spectrum> tints;        // Empty: all are white.
  std::vector<std::uint32_t> pieces;  // 0: of a stretch; i: of the i-th specular piece. Empty: all are of stretches.
  // Irradiance from each Legendre polynomial on each of them: kLightCoefficients, and the rest up to
  // kResidualCoefficients, of which few digits count.
  std::vector<double> low;
  std::vector<float> high;

  double Tint(std::size_t p, std::size_t channel) const { return tints.empty() ? 1 : tints[p].value[channel]; }
  // Irradiance from a polynomial of kLightCoefficients on the p-th entry's panel, but for its tint.
  double TimesLight(std::size_t p, const double* coefficients) const {
    static_assert(kLightCoefficients == 8);
    // In four sums, which need not wait for each other.
    const double* m = &low[p * kLightCoefficients];
    const double* c = coefficients;
    return ((m[0] * c[0] + m[4] * c[4]) + (m[1] * c[1] + m[5] * c[5])) +
           ((m[2] * c[2] + m[6] * c[6]) + (m[3] * c[3] + m[7] * c[7]));
  }
  // The same of kResidualCoefficients.
  double Times(std::size_t p, const double* coefficients) const {
    double sum = TimesLight(p, coefficients);
    constexpr std::size_t kRest = kResidualCoefficients - kLightCoefficients;
    for (std::size_t k = 0; k < kRest; ++k)
      sum += static_cast<double>(high[p * kRest + k]) * coefficients[kLightCoefficients + k];
    return sum;
  }
};

class RowBuilder {
 public:
  // `specular`: absent where nothing is a mirror or glass.
  RowBuilder(const RayCaster& caster, const std::vector<Chart>& charts,
             const std::optional<SpecularViewOptions>& specular)
      : scene_(caster.scene()),
        charts_(charts),
        count_(kLightCoefficients - 1, kKernelDigits),
        high_count_(kResidualCoefficients - 1, kKernelDigits / 2),
        outlook_(caster, charts) {
    if (specular) specular_.emplace(caster, charts, *specular);
  }

  // As in SpecularViewOptions; for rows to come that have none before.
  void set_least_share(double least_share) {
    if (specular_) specular_->set_least_share(least_share);
  }
  // `before`, if not null: the row of the same receiver with the mesh that this one was made of. What is in it already,
  // and what is seen from there, is not computed again; it is left empty. Without `high` the row has no high
  // coefficients.
  void Build(const PanelMesh& mesh, const Receiver& receiver, bool high, Row* before, Row& row);

 private:
  void AddStretch(const PanelMesh& mesh, const Receiver& receiver, const Row::Stretch& stretch, bool high, Row& row);
  void AddWhole(const Chart& chart, const Panel& panel, const Receiver& receiver, double roundness, bool high,
                double* moments) const;
  // Adds what is emitted over mirrors and through glass.
  void AddEmission(const Receiver& receiver, Row& row);
  void AddSpecular(const PanelMesh& mesh, const Receiver& receiver, bool high, Row& row);
  void AddEntry(const double* moments, std::size_t count, Row& row) const;
  // Copies the panel's entry, if there was one.
  bool Copy(const Panel& panel, std::uint32_t piece, bool high, Row& row);

  const Scene& scene_;
  const std::vector<Chart>& charts_;
  PointCount count_, high_count_;
  Outlook outlook_;
  std::optional<SpecularGather> specular_;
  const Row* before_ = nullptr;
  std::size_t next_before_ = 0;  // Entries come in one order in both rows.
};

// Whether a receiver lies on the circle of an element, inside; then that circle's radius, else 0.
double OwnRadius(const Scene& scene, const Receiver& receiver, ElementId element);

// What the end of a piece adds to the error of an integral over sines, for light of radiance 1, as coordinates are
// known and as elements follow Béziers. Where one element of a Bézier ends and the next begins light goes on, and what
// both ends are off by cancels, but for the light's own change along the curve (THEORY 18 B6, by parts): the largest of
// all those counts, not the sum.
class EndErrors {
 public:
  explicit EndErrors(const Scene& scene) : scene_(&scene) {}
  // Of one end, without what is known of all joints together.
  EdgeErrors Add(const Receiver& receiver, ElementId element, const PieceEnd& end, double radiance);
  double joints() const { return 4 * joints_; }
  // Whether the piece is not known to be seen at all: rounding lets light through between two curves that meet.
  bool IsDoubtful(const Receiver& receiver, const VisiblePiece& piece) const;

 private:
  const Scene* scene_;
  double joints_ = 0;
};

// The sine of the direction to a place of an element; 0 if the receiver is there.
double SineTo(const Chart& chart, const Receiver& receiver, double u);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_ROW_H_
