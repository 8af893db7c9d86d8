// SPDX-License-Identifier: Apache-2.0
// How far a record may be used: estimates of the error of extrapolation.
#ifndef FLATLIGHT_CORE_CACHE_ERROR_CONTROL_H_
#define FLATLIGHT_CORE_CACHE_ERROR_CONTROL_H_

#include <cstddef>
#include <cstdint>

#include "core/cache/record.h"

namespace flatlight {

enum class ErrorControl : std::uint8_t {
  // Distance over the mean distance of what is seen (Ward et al. 1988; in the plane the split circle, THEORY 7).
  kSplitSphere,
  // The same, and at least as fast as the gradient says, and as one over the track's length.
  kBoundedSplitSphere,
  // The second derivative: by the motion of what is seen alone (Jarosz et al. 2012),
  kRadiometricHessian,
  // the same with equal radiance everywhere, so that black walls count,
  kGeometricHessian,
  // or with what is covered and uncovered (Schwarzhaupt et al. 2012), at least 1 % of what its terms add up to without
  // their signs; of the surroundings alone where it is dark.
  kOcclusionHessian,
  // The next two derivatives beyond those that extrapolate, and what is not known of jumps at visibility events.
  kVisibilityEvents,
};

// `mean`: of irradiance along the track. Errors are relative to the record's own irradiance, at least to 1 % of the
// mean; if `of_mean`, to the mean itself. `extent`: of the track's points. Sets what CacheRecord names.
struct ErrorScale {
  double mean = 0;
  bool of_mean = false;
  double extent = 0;
};
void SetErrors(ErrorControl control, std::size_t degree, const ErrorScale& scale, CacheRecord& record);

// The lowest power of the distance with which errors grow.
std::size_t GrowthPower(ErrorControl control, std::size_t degree);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_CACHE_ERROR_CONTROL_H_
