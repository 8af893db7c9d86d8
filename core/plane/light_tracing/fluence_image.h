// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_LIGHT_TRACING_FLUENCE_IMAGE_H_
#define FLATLIGHT_CORE_PLANE_LIGHT_TRACING_FLUENCE_IMAGE_H_

#include <cstddef>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/scene.h"
#include "core/scene/spectrum.h"

namespace flatlight {

// Sums up light on its way. Flux that goes a length through a pixel gives it the fluence flux * length / area (the
// integral of radiance over all directions, averaged over the pixel). Sums are of single precision: what that rounds is
// far below the noise of as many paths as would notice.
class FluenceImage {
 public:
  // channels: 1 or 3.
  FluenceImage(const PixelGrid& grid, int channels);

  // Light of `flux` (normalised) goes straight from one point to another.
  void AddLine(Point2 from, Point2 to, const Spectrum& flux);

  // Pixel after pixel, row 0 the lowest, then channel. Normalised radiance times radians.
  const std::vector<float>& sums() const { return sums_; }

  // For a stream of states (see core/render/state_stream.h): the sums.
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream.Filled(self.sums_);
  }

 private:
  template <int kChannels>
  void AddInside(Point2 from, Vector2 along, double begin, double end, const Spectrum& per_t);

  PixelGrid grid_;
  int channels_;
  Vector2 pixels_per_unit_;
  double inverse_area_;  // Of a pixel.
  std::vector<float> sums_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_LIGHT_TRACING_FLUENCE_IMAGE_H_
