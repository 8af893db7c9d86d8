// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_STATISTICS_SAMPLE_RANGE_H_
#define FLATLIGHT_CORE_STATISTICS_SAMPLE_RANGE_H_

#include <algorithm>
#include <limits>

namespace flatlight {

// The smallest and the largest of some samples.
struct SampleRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Add(double sample) {
    low = std::min(low, sample);
    high = std::max(high, sample);
  }
  void Add(const SampleRange& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.low, self.high);
  }
  // 0 if there is no sample.
  double Width() const { return std::max(high - low, 0.0); }
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_STATISTICS_SAMPLE_RANGE_H_
