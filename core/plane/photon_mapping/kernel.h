// SPDX-License-Identifier: Apache-2.0
// Kernels of density estimation along a line (THEORY 5, 18 B11).
#ifndef FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_KERNEL_H_
#define FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_KERNEL_H_

#include <array>
#include <cstdint>

namespace flatlight {

// Even functions of u = distance / bandwidth in [-1, 1] with integral 1.
enum class Kernel : std::uint8_t { kBox, kTriangle, kEpanechnikov, kBiweight };

// 0 outside [-1, 1].
double KernelValue(Kernel kernel, double u);

// The integral of u^2 K.
double SecondMoment(Kernel kernel);
// The integral of K^2: variance is in proportion.
double Roughness(Kernel kernel);

// The integrals of K, u K, u^2 K and u^3 K over [a, b], what lies outside [-1, 1] left out.
std::array<double, 4> PartialMoments(Kernel kernel, double a, double b);

// A kernel that ends with the line it lies on: (constant + slope u) K(u) on [a, b], zero elsewhere, such that densities
// that are constant or linear are told without bias, right up to the line's ends (local linear estimation; Jones 1993,
// "Simple boundary correction for kernel density estimation").
struct EndedKernel {
  Kernel kernel = Kernel::kBox;
  double constant = 1;
  double slope = 0;
  double second_moment = 0;  // Of the whole: bias is half of it times bandwidth^2 times the second derivative.

  // [a, b] must hold 0 and be no point.
  EndedKernel(Kernel kernel, double a, double b);
  double operator()(double u) const { return (constant + slope * u) * KernelValue(kernel, u); }
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_KERNEL_H_
