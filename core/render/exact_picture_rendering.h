// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_EXACT_PICTURE_RENDERING_H_
#define FLATLIGHT_CORE_RENDER_EXACT_PICTURE_RENDERING_H_

#include <cstddef>
#include <memory>
#include <vector>

#include "core/plane/exact/fluence_solver.h"
#include "core/plane/ray_caster.h"
#include "core/plane/triangulation/triangulation.h"
#include "core/render/idle_pool.h"
#include "core/render/ordered_work.h"
#include "core/render/rendering.h"

namespace flatlight {

// The pictures of a scene's direct light. First the fluence in the middle of every pixel, exact; then the mean over
// those in whose neighbourhood it is not nearly linear. Elsewhere the middle has the mean: fluence of straight emitters
// is a harmonic function between visibility events.
class ExactPictureRendering final : public Rendering {
 public:
  // As for ExactRendering.
  ExactPictureRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                        std::shared_ptr<const Triangulation> triangulation, const Plan& plan);

  void Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  bool done() const override { return middles_.done() && means_.done(); }
  EndReason end_reason() const override { return EndReason::kConverged; }
  RenderProgress Progress() const override;
  // Empty before the middles are there; of probes that are no pictures nothing.
  std::shared_ptr<const Field> Snapshot() const override;

 private:
  struct Picture {
    PixelGrid grid;
    Vector2 box;            // Of a pixel.
    std::size_t first = 0;  // Of its pixels among all.
    Spectrum least;         // Errors count as if no pixel were darker.
  };

  // The picture of a pixel.
  const Picture& PictureOf(std::size_t pixel) const;
  Point2 Middle(const Picture& picture, std::size_t pixel) const;
  void FindMiddle(FluenceSolver& solver, std::size_t pixel);
  void FindMean(FluenceSolver& solver, std::size_t pixel);
  // How far a pixel's neighbours are from linear; infinite at the border.
  Spectrum Bent(const Picture& picture, std::size_t pixel) const;
  void SetLeast();

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const RayCaster> caster_;
  std::shared_ptr<const Triangulation> triangulation_;
  ExactOptions options_;
  int max_threads_;
  std::vector<Picture> pictures_;
  std::vector<Spectrum> at_middles_;  // By pixel of all pictures.
  std::vector<BoxMean> values_;
  IdlePool<FluenceSolver> solvers_;
  OrderedWork middles_;
  OrderedWork means_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_EXACT_PICTURE_RENDERING_H_
