// SPDX-License-Identifier: Apache-2.0
#include "client/cli/outputs/tone_mapping.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace flatlight {
namespace {

constexpr double kMiddleGrey = 0.18;
constexpr double kWhiteShare = 0.99;  // Of all pixels, this many are below white.

// IEC 61966-2-1.
float Encoded(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

// Rec. 709 luminance of each pixel.
std::vector<double> Luminances(const Picture& picture) {
  const auto channels = static_cast<std::size_t>(picture.channels);
  std::vector<double> luminances(picture.pixels.size() / channels);
  for (std::size_t i = 0; i < luminances.size(); ++i) {
    const float* p = &picture.pixels[i * channels];
    luminances[i] = channels == 3 ? 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2] : p[0];
  }
  return luminances;
}

}  // namespace

Picture ToneMapped(const Picture& picture) {
  const std::vector<double> luminances = Luminances(picture);
  std::vector<double> lit;
  double log_sum = 0;
  for (const double y : luminances) {
    if (!(y > 0)) continue;
    lit.push_back(y);
    log_sum += std::log(y);
  }
  Picture mapped = picture;
  if (lit.empty()) return mapped;
  const double exposure = kMiddleGrey / std::exp(log_sum / static_cast<double>(lit.size()));
  const auto white_at = lit.begin() + static_cast<std::ptrdiff_t>(kWhiteShare * static_cast<double>(lit.size() - 1));
  std::nth_element(lit.begin(), white_at, lit.end());
  const double white = std::max(1.0, exposure * *white_at);
  const auto channels = static_cast<std::size_t>(picture.channels);
  for (std::size_t i = 0; i < luminances.size(); ++i) {
    const double y = exposure * luminances[i];
    const double scale = exposure * (1 + y / (white * white)) / (1 + y);
    for (std::size_t c = 0; c < channels; ++c) {
      float& value = mapped.pixels[i * channels + c];
      value = Encoded(scale * static_cast<double>(value));
    }
  }
  return mapped;
}

}  // namespace flatlight
