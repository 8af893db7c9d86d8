// SPDX-License-Identifier: Apache-2.0
#include "core/plane/light_tracing/fluence_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flatlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Keeps of [begin, end] what lies in the slab low <= from + t * along <= high.
void Clip(double from, double along, double low, double high, double& begin, double& end) {
  if (along == 0) {
    if (from < low || from > high) end = -1;
    return;
  }
  const double a = (low - from) / along, b = (high - from) / along;
  begin = std::max(begin, std::min(a, b));
  end = std::min(end, std::max(a, b));
}

// Along one axis, in pixels: where the line is, and where it comes to the next pixel.
struct Axis {
  std::ptrdiff_t step;  // In the array.
  std::ptrdiff_t left;  // Pixels until the line leaves the image.
  double next = kInfinity;
  double every = kInfinity;

  Axis(double at, double along, std::uint32_t count, std::ptrdiff_t stride, double begin, std::ptrdiff_t& index)
      : step(along < 0 ? -stride : stride) {
    const double place = std::clamp(std::floor(at), 0.0, count - 1.0);
    index += stride * static_cast<std::ptrdiff_t>(place);
    left = along < 0 ? static_cast<std::ptrdiff_t>(place) : static_cast<std::ptrdiff_t>(count - 1 - place);
    if (along == 0) return;
    every = 1 / std::abs(along);
    next = begin + std::max(0.0, along < 0 ? at - place : place + 1 - at) * every;
  }
};

}  // namespace

FluenceImage::FluenceImage(const PixelGrid& grid, int channels)
    : grid_(grid),
      channels_(channels),
      pixels_per_unit_{grid.width / (grid.high.x - grid.low.x), grid.height / (grid.high.y - grid.low.y)},
      inverse_area_(pixels_per_unit_.x * pixels_per_unit_.y),
      sums_(grid.pixels() * static_cast<std::size_t>(channels)) {}

void FluenceImage::AddLine(Point2 from, Point2 to, const Spectrum& flux) {
  const Vector2 along = to - from;
  double begin = 0, end = 1;
  Clip(from.x, along.x, grid_.low.x, grid_.high.x, begin, end);
  Clip(from.y, along.y, grid_.low.y, grid_.high.y, begin, end);
  if (!(begin < end)) return;
  const Spectrum per_t = Length(along) * inverse_area_ * flux;
  if (channels_ == 1) {
    AddInside<1>(from, along, begin, end, per_t);
  } else {
    AddInside<kMaxChannels>(from, along, begin, end, per_t);
  }
}

// After Amanatides and Woo 1987, "A fast voxel traversal algorithm for ray tracing".
template <int kChannels>
void FluenceImage::AddInside(Point2 from, Vector2 along, double begin, double end, const Spectrum& per_t) {
  const Point2 at = from + begin * along;
  std::ptrdiff_t index = 0;
  Axis x((at.x - grid_.low.x) * pixels_per_unit_.x, along.x * pixels_per_unit_.x, grid_.width, kChannels, begin, index);
  Axis y((at.y - grid_.low.y) * pixels_per_unit_.y, along.y * pixels_per_unit_.y, grid_.height,
         static_cast<std::ptrdiff_t>(grid_.width) * kChannels, begin, index);
  float* const sums = sums_.data();
  double t = begin;
  while (true) {
    Axis& axis = x.next < y.next ? x : y;
    const double until = std::min(axis.next, end);
    for (std::ptrdiff_t c = 0; c < kChannels; ++c) {
      sums[index + c] += static_cast<float>((until - t) * per_t.value[static_cast<std::size_t>(c)]);
    }
    if (axis.next >= end || axis.left == 0) return;
    t = until;
    index += axis.step;
    --axis.left;
    axis.next += axis.every;
  }
}

}  // namespace flatlight
