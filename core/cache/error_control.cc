// SPDX-License-Identifier: Apache-2.0
#include "core/cache/error_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flatlight {
namespace {

constexpr double kDarkest = 0.01;   // Of the mean.
constexpr double kAbsolute = 0.01;  // Of the sum of a Hessian's terms without their signs.
constexpr double kFactorial[] = {1, 1, 2, 6, 24};

// Where there is no light at all nothing is known of how much there could be.
double Over(double size, double scale) {
  return size == 0 ? 0 : scale > 0 ? size / scale : std::numeric_limits<double>::infinity();
}

}  // namespace

std::size_t GrowthPower(ErrorControl control, std::size_t degree) {
  switch (control) {
    case ErrorControl::kSplitSphere:
    case ErrorControl::kBoundedSplitSphere:
      return 1;
    case ErrorControl::kRadiometricHessian:
    case ErrorControl::kGeometricHessian:
    case ErrorControl::kOcclusionHessian:
      return 2;
    case ErrorControl::kVisibilityEvents:
      return degree + 1;
  }
  return 1;
}

void SetErrors(ErrorControl control, std::size_t degree, const ErrorScale& scale, CacheRecord& record) {
  const Surroundings& seen = record.surroundings;
  record.scale = std::max(record.Irradiance(), kDarkest * scale.mean);
  record.degree = degree;
  record.least = 0;
  if (control == ErrorControl::kVisibilityEvents) {
    if (scale.of_mean) record.scale = scale.mean;
    if (!scale.of_mean) record.least = kDarkest * scale.mean;
  }
  record.growth = {};
  record.goes_on = control == ErrorControl::kVisibilityEvents;
  switch (control) {
    case ErrorControl::kSplitSphere:
      record.growth[1] = seen.inverse_distance.value_or(0);
      break;
    case ErrorControl::kBoundedSplitSphere:
      record.growth[1] =
          std::max({seen.inverse_distance.value_or(0), Over(record.derivative[1].MaxSize(), record.scale),
                    scale.extent > 0 ? 1 / scale.extent : 0});
      break;
    case ErrorControl::kRadiometricHessian:
      record.growth[2] = 0.5 * Over(seen.radiometric.MaxSize(), record.scale);
      break;
    case ErrorControl::kGeometricHessian:
      record.growth[2] = 0.5 * seen.geometric;
      break;
    case ErrorControl::kOcclusionHessian:
      record.growth[2] = record.Irradiance() > 0 ? 0.5 * std::max(Over(record.derivative[2].MaxSize(), record.scale),
                                                                  kAbsolute * 0.5 * seen.turning)
                                                 : 0.5 * seen.geometric;
      break;
    case ErrorControl::kVisibilityEvents:
      // The next two; where those are not known, the last ones that are.
      for (std::size_t k = std::min(degree + 2, record.known - 1), used = 0;
           k >= std::min<std::size_t>(degree + 1, 2) && used < 2; --k, ++used) {
        record.growth[k] = Over(record.derivative[k].MaxSize(), record.scale) / kFactorial[k];
      }
      break;
  }
}

}  // namespace flatlight
