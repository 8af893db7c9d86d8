// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_FLUENCE_RENDERING_H_
#define FLATLIGHT_CORE_RENDER_FLUENCE_RENDERING_H_

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/plane/light_tracing/fluence_image.h"
#include "core/plane/light_tracing/light_tracer.h"
#include "core/plane/ray_caster.h"
#include "core/render/rendering.h"
#include "core/statistics/replicates.h"

namespace flatlight {

// The pictures of a scene, by light tracing. Each replicate has images of its own, and adds its paths to them in their
// order: a picture depends on the number of paths alone.
class FluenceRendering final : public Rendering {
 public:
  // The caster's scene has the world of `scene`; it may be null where nothing emits.
  FluenceRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster, const Plan& plan);

  void Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  bool done() const override { return end_reason_.has_value(); }
  EndReason end_reason() const override { return *end_reason_; }
  RenderProgress Progress() const override;
  // Of probes that are no pictures nothing.
  std::shared_ptr<const Field> Snapshot() const override;
  std::string Checkpoint(std::size_t most_bytes) const override;
  bool Resume(std::string_view checkpoint) override;

 private:
  struct Replicate {
    std::vector<FluenceImage> images;  // Of each picture.
    std::uint64_t paths = 0;
    double rays = 0;

    template <class Self, class Stream>
    static void State(Self& self, Stream& stream) {
      stream.Filled(self.images);
      stream(self.paths, self.rays);
    }
  };

  // What a checkpoint consists of, beside the time since the start.
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.replicates_, self.next_test_, self.worst_error_, self.seconds_, self.end_reason_);
  }
  // `paths` more of every replicate; false if cancelled before all had them.
  bool AddPaths(std::uint32_t paths, Executor& executor, const Cancellation& cancellation);
  void DecideEnd(Clock::Time now);
  // Of one picture.
  ProbeField FieldOf(std::size_t picture, const PixelGrid& grid) const;
  double WorstError() const;

  std::shared_ptr<const Scene> scene_;
  std::optional<LightTracer> tracer_;  // Absent in the dark.
  std::uint32_t seed_;
  int channels_;  // Computed.
  int max_threads_;
  std::uint64_t most_paths_;  // Of a replicate.
  std::size_t pixels_ = 1;    // Of the largest picture.
  std::optional<double> target_error_;
  std::optional<double> time_limit_;
  std::vector<PixelGrid> grids_;
  std::array<Replicate, kReplicates> replicates_;
  std::uint64_t next_test_ = 64;  // Paths of a replicate.
  std::optional<double> worst_error_;
  std::optional<Clock::Time> start_;
  std::optional<Clock::Duration::rep> resumed_;  // Time since the start, until the first Advance after it.
  Clock::Time now_;                              // At the last decision.
  double seconds_ = 0;                           // Spent so far.
  double seconds_per_path_ = 0;                  // Of all replicates together; measured, leaves no trace in results.
  std::optional<EndReason> end_reason_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_FLUENCE_RENDERING_H_
