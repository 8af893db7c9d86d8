// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_POINT_SAMPLER_H_
#define FLATLIGHT_CORE_RENDER_POINT_SAMPLER_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/execution/cancellation.h"
#include "core/statistics/replicates.h"

namespace flatlight {

// An unbiased estimator of non-negative values at points, one sample at a time.
class PointSampler {
 public:
  // One sample of each replicate.
  static constexpr std::size_t kBlockSamples = kReplicates;

  virtual ~PointSampler() = default;
  virtual std::size_t channels() const = 0;
  // What all samples of a point may have in common without showing it.
  struct Doubt {
    double step = 0;       // The largest change of one sample that stratification may hide (see EstimateMean).
    double brightest = 0;  // What a rare sample may have above the common ones, about.
    double rounding = 0;   // Of a sample's arithmetic.

    template <class Self, class Stream>
    static void State(Self& self, Stream& stream) {
      stream(self.step, self.brightest, self.rounding);
    }
  };
  // Of each channel.
  virtual void Doubts(std::size_t point, std::span<Doubt> doubts) const = 0;
  // The samples of one point; a caller that wants many asks for this once.
  class Source {
   public:
    virtual ~Source() = default;
    // Adds sample `block` of every replicate to `sums` (channel after channel, kReplicates each), and rays cast to
    // `rays`. A pure function of point and block; of no use once cancelled.
    virtual void AddBlock(std::uint32_t block, const Cancellation& cancellation, std::span<double> sums,
                          double& rays) const = 0;
  };
  // Safe to call from several threads.
  virtual std::unique_ptr<const Source> At(std::size_t point) const = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_POINT_SAMPLER_H_
