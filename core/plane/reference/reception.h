// SPDX-License-Identifier: Apache-2.0
// Irradiance from panels at one point, with its derivatives and what an error of the panels' light makes of it.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_RECEPTION_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_RECEPTION_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "core/plane/reference/error_sum.h"
#include "core/plane/reference/outlook.h"
#include "core/plane/reference/panel_light.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/plane/reference/row.h"
#include "core/plane/reference/specular_gather.h"
#include "core/plane/reference/stretch.h"
#include "core/scene/spectrum.h"

namespace flatlight {

// Slope, by a panel's place in [-1, 1], of what an error of light of size 1 leaves after a reflection: it is smooth
// then (Markov's inequality for cubics).
inline constexpr double kErrorSlope = 9;

// What is known of the error of a light.
struct LightErrors {
  PanelLight residual;        // By how much the light's own reflection differs from it. Irradiance has it in its value.
  std::vector<double> size;   // The largest residual, and
  std::vector<double> steep;  // the largest slope of it, by the panel's place in [-1, 1].
  std::vector<double> missed;  // What it may be off by itself, where it is not smooth: the mean, on any panel;
  std::vector<double> mean, in_all, root_mean_square, most;  // and as seen between events.
  // Bounds on how far the true light is from that reflection: by panel, then channel.
  std::vector<double> value;
  std::vector<double> slope;  // Of its derivative by arc length.
  Spectrum brightest;         // The largest radiance anywhere.

  // What a receiver gets of what is missed, at most. `weights`: integrals of what it weighs the panel with, which is
  // not negative, times Legendre polynomials, kLightCoefficients of them.
  double Missed(std::size_t index, const double* weights) const;
  // Sets the panel's slopes to those of errors that are smooth on it, where others would take long: what comes over
  // mirrors and through glass asks for slopes in its turn.
  void GuessSlopes(const Chart& chart, const Panel& panel, std::size_t i, std::size_t channels);
};

// Reflected irradiance and its derivatives along the receiver.
struct Received {
  Spectrum value[3];
  Spectrum error[3];  // Bounds, where errors of the light are given.
  // Bounds on rounding, of coordinates too, but for errors of the light.
  Spectrum rounding[3];
  Spectrum unfollowed;  // The part of rounding[0] that is less where ways over mirrors and glass are followed further.
  Spectrum indirect;    // The part of error[0] that comes of LightErrors::value.
};

// Holds working memory: one for each thread.
class Reception {
 public:
  // `specular`: absent where nothing is a mirror or glass.
  Reception(const RayCaster& caster, const std::vector<Chart>& charts,
            const std::optional<SpecularViewOptions>& specular)
      : scene_(caster.scene()),
        charts_(charts),
        count_(kLightCoefficients + 2, kKernelDigits),
        high_count_(count_, PointCount(kResidualCoefficients - 1, kKernelDigits / 2)),
        outlook_(caster, charts),
        end_errors_(caster.scene()) {
    if (specular) specular_.emplace(caster, charts, *specular);
  }

  // As in SpecularViewOptions, for calls to come.
  void set_least_share(double least_share) {
    if (specular_) specular_->set_least_share(least_share);
  }

  // What panels reflect and, over mirrors and through glass, what emits. `errors` may be null. `derivatives` 0, 1 or 2.
  // `sight`: what is seen so, if it is known already; where
  // it holds nothing it is found, and filled. Null: it is found.
  Received At(const Receiver& receiver, const PanelMesh& mesh, const PanelLight& light, const LightErrors* errors,
              int derivatives, std::optional<SpecularSight>* sight = nullptr);
  // What each panel's errors add to that of irradiance at the receiver of the last call.
  struct Share {
    std::size_t panel = 0;
    double of_residual = 0;  // In the channel where it is largest.
    double weight = 0;       // Of LightErrors::value.
  };
  const std::vector<Share>& shares() const { return shares_; }

 private:
  void AddPiece(const Receiver& receiver, const PanelMesh& mesh, const PanelLight& light, const LightErrors* errors,
                int derivatives, const VisiblePiece& piece, Received& sum);
  void AddSpecular(const Receiver& receiver, const PanelMesh& mesh, const PanelLight& light, const LightErrors* errors,
                   const SpecularSight& sight, Received& sum);
  // The same with derivatives.
  void AddMovingSpecular(const Receiver& receiver, const PanelMesh& mesh, const PanelLight& light,
                         const LightErrors* errors, int derivatives, const SpecularSight& sight, Received& sum);
  void AddEnd(const Receiver& receiver, const PanelMesh& mesh, const PanelLight& light, const LightErrors* errors,
              int derivatives, const VisiblePiece& piece, bool is_end, Received& sum);

  const Scene& scene_;
  const std::vector<Chart>& charts_;
  PointCount count_, high_count_;
  Outlook outlook_;
  std::optional<SpecularGather> specular_;
  std::vector<Share> shares_;
  ErrorSum of_residuals_[3][kMaxChannels];  // By derivative.
  EndErrors end_errors_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_RECEPTION_H_
