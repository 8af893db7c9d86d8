// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_PHOTON_MAPPING_RENDERING_H_
#define FLATLIGHT_CORE_RENDER_PHOTON_MAPPING_RENDERING_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/plane/exact/exact.h"
#include "core/plane/exact/light_solver.h"
#include "core/plane/light_tracing/light_tracer.h"
#include "core/plane/photon_mapping/final_gather.h"
#include "core/plane/photon_mapping/photon_maps.h"
#include "core/plane/photon_mapping/photon_tracer.h"
#include "core/plane/photon_mapping/stretches.h"
#include "core/plane/photon_mapping/width_choice.h"
#include "core/plane/ray_caster.h"
#include "core/plane/ray_tracing/ray_tree.h"
#include "core/render/idle_pool.h"
#include "core/render/ordered_work.h"
#include "core/render/photon_trace.h"
#include "core/render/rendering.h"
#include "core/statistics/replicates.h"

namespace flatlight {

// In passes: photons are traced and sorted into maps, one a replicate, and irradiance at the points is told from them:
// by the density of photons there, or by a final gather of rays that look up the density where they arrive, added to
// direct light in closed form. Passes are averaged, weighed by their photons, and each resolves more finely than those
// before, so that the error goes to 0 though memory is bounded.
class PhotonMappingRendering final : public Rendering {
 public:
  // The caster's scene has the world of `scene`; it may be null where nothing emits.
  PhotonMappingRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster, const Plan& plan);

  void Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  bool done() const override { return end_reason_.has_value(); }
  EndReason end_reason() const override { return *end_reason_; }
  RenderProgress Progress() const override;
  std::shared_ptr<const Field> Snapshot() const override;
  // Of whole passes; none before there is another one.
  std::string Checkpoint(std::size_t most_bytes) const override;
  bool Resume(std::string_view checkpoint) override;

  // Photons of a pass, all replicates together, at most.
  static constexpr std::uint64_t kMostPassPhotons = std::uint64_t{1} << 18;

 private:
  enum Quantity : std::size_t { kIrradiance, kBias, kGradient, kGradientBias, kGatherBias, kQuantities };
  // Widths of densities that are kept at each point, to choose from when all photons are known.
  static constexpr std::size_t kWidths = 16;
  static constexpr std::size_t kFewWidths = 8;

  struct Point {
    const Receiver* receiver = nullptr;
    SidePlace place;        // Of meaning where it lies on a curve.
    ExactValue direct;      // Beside what photons tell.
    double chain_rays = 0;  // Cast for that.
    double widest = 0;      // Of its densities.
    double step = 0;        // What all replicates may have missed alike, for a path of unit flux: per length.
    double next_step = 0;   // Of the pass under way.
    template <class Self, class Stream>
    static void State(Self& self, Stream& stream) {
      stream(self.widest, self.step);
    }
  };
  struct Pass {
    std::uint32_t rays = 0;  // Of a replicate's gather.
    PhotonTrace trace;
    std::unique_ptr<const PhotonMaps> maps;  // Of reflectors if rays gather, else of curves with points.
    std::vector<MapIrradiance> known;        // By replicate, then those of bias.
    std::vector<RayTree> trees;              // Likewise.
    OrderedWork look{0};
  };
  struct Value {
    std::array<Spectrum, kQuantities> value, error;
  };

  std::uint64_t AllPhotons() const;
  bool OpenEnded() const { return settings_.target_error || settings_.time_limit || !settings_.photons; }
  void BeginPass();
  void AddChained(const Receiver& receiver, const std::vector<ChainedLight>& ways, Spectrum& irradiance,
                  Spectrum& gradient) const;
  bool FindDirect(std::size_t first, std::size_t last, const Cancellation& cancellation);
  void MakeMaps(Executor& executor, int threads);
  bool LookUp(std::size_t first, std::size_t last, const Cancellation& cancellation);
  bool LookUpAt(std::size_t point, std::size_t replicate, const Cancellation& cancellation);
  void EndPass(Clock::Time now);
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream);
  void DecideEnd(Clock::Time now);
  // Where a replicate's sum of a quantity of a point begins: channel after channel.
  std::size_t Index(std::size_t point, std::size_t replicate, std::size_t quantity) const {
    return ((point * kReplicates + replicate) * quantities_ + quantity) * channels_;
  }
  // By probe; of no use where widths are given.
  std::vector<WidthChooser> Choosers() const;
  Value ValueAt(std::size_t point, const std::vector<WidthChooser>& choosers) const;
  WidthLadder LadderAt(std::size_t point) const;
  void AddDensity(std::size_t point, const WidthChooser& chooser, Value& value) const;
  MeanEstimate MeanOf(std::size_t point, std::size_t quantity, std::size_t channel, double step) const;
  double WorstError() const;

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const RayCaster> caster_;
  Settings settings_;
  bool gathers_;
  bool chooses_widths_ = false;  // Quantities of a point are its densities with several widths.
  int derivatives_;
  bool reflects_ = false;  // There is more than direct light.
  double brightest_ = 0;   // Radiance that rays may find by mirrors and glass, or gloss.
  std::size_t channels_;
  std::size_t quantities_;
  int max_threads_;
  DensityOptions density_;
  std::uint64_t key_;
  std::optional<Stretches> stretches_;
  std::optional<LightTracer> light_;
  std::optional<PhotonTracer> tracer_;
  std::optional<RayTree> tree_;
  std::optional<LightSolver> lights_;
  ExactOptions exact_;
  IdlePool<ExactSolver> solvers_;
  std::vector<Point> points_;
  std::vector<Receiver> gather_from_;
  std::vector<std::size_t> probe_of_point_;
  std::vector<double> sums_;  // Over whole passes, weighed by paths; see Index.
  std::vector<double> next_;  // Of the pass under way.
  std::vector<double> cast_;  // Rays of each point in it.
  OrderedWork direct_{0};
  Pass pass_;
  std::uint64_t photons_done_ = 0;  // Of whole passes.
  double gathered_rays_ = 0;        // Of a point: of all replicates and whole passes.
  std::optional<double> worst_error_;
  double rays_ = 0;
  std::optional<Clock::Time> start_;
  double seconds_ = 0;
  double chain_rays_ = 0;                        // Beside these: for light of chains.
  double pass_rays_ = 0;                         // Of `rays_`: of the pass under way.
  std::uint64_t resumed_photons_ = 0;            // Of whole passes, that were done when this was resumed.
  std::optional<Clock::Duration::rep> resumed_;  // The time that it had taken; set until it goes on.
  Clock::Time now_;                              // When it last worked.
  std::optional<EndReason> end_reason_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PHOTON_MAPPING_RENDERING_H_
