// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_CLIENT_CLI_FORMATS_SAMPLE_RESULT_H_
#define FLATLIGHT_TESTS_CLIENT_CLI_FORMATS_SAMPLE_RESULT_H_

#include <string>

#include "flatlight/v1/result.pb.h"

namespace flatlight {

// A probe "name" with points (i, 0), normals (0, 1), arc length i + 0.5 and irradiance 1/(k+1) at position k of the
// array.
inline v1::ProbeResult& AddProbe(v1::RenderResult& result, const std::string& name, int count, int channels = 1) {
  v1::ProbeResult& probe = *result.add_probes();
  probe.set_name(name);
  probe.set_quantity(v1::ProbeResult::IRRADIANCE);
  probe.set_count(static_cast<unsigned>(count));
  probe.set_channels(static_cast<unsigned>(channels));
  for (int i = 0; i < count; ++i) {
    probe.add_positions(i);
    probe.add_positions(0);
    probe.add_normals(0);
    probe.add_normals(1);
    probe.add_arc_length(i + 0.5);
    for (int channel = 0; channel < channels; ++channel) probe.add_irradiance(1.0 / (probe.irradiance_size() + 1));
  }
  return probe;
}

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_CLIENT_CLI_FORMATS_SAMPLE_RESULT_H_
