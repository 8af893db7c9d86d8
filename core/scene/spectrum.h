// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SCENE_SPECTRUM_H_
#define FLATLIGHT_CORE_SCENE_SPECTRUM_H_

#include <algorithm>
#include <array>

namespace flatlight {

inline constexpr int kMaxChannels = 3;

// One value a channel: linear Rec. 709, or three equal values for grey.
struct Spectrum {
  std::array<double, kMaxChannels> value{};

  static constexpr Spectrum Grey(double v) { return {{v, v, v}}; }
  constexpr double Max() const { return std::max(value[0], std::max(value[1], value[2])); }
  // Of differences, whose values may be negative.
  constexpr double MaxSize() const {
    double size = 0;
    for (const double v : value) size = std::max(size, v < 0 ? -v : v);
    return size;
  }
  constexpr bool IsBlack() const { return Max() == 0; }
  constexpr bool IsGrey() const { return value[0] == value[1] && value[1] == value[2]; }
  constexpr double operator[](int channel) const { return value[static_cast<size_t>(channel)]; }
  constexpr double& operator[](int channel) { return value[static_cast<size_t>(channel)]; }
  friend bool operator==(const Spectrum&, const Spectrum&) = default;
};

constexpr Spectrum operator+(const Spectrum& a, const Spectrum& b) { return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}}; }
constexpr Spectrum operator-(const Spectrum& a, const Spectrum& b) { return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}}; }
constexpr Spectrum operator*(const Spectrum& a, const Spectrum& b) { return {{a[0] * b[0], a[1] * b[1], a[2] * b[2]}}; }
constexpr Spectrum operator*(double k, const Spectrum& a) { return {{k * a[0], k * a[1], k * a[2]}}; }

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_SPECTRUM_H_
