// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_LIMITS_H_
#define FLATLIGHT_SERVER_SERVICE_LIMITS_H_

#include <cstddef>
#include <cstdint>

namespace flatlight {

// What a server accepts; announced by GetCapabilities.
struct Limits {
  std::size_t max_message_bytes = 4u << 20;  // Of a request.
  std::uint64_t max_scene_bytes = 512ull << 20;
  std::uint32_t max_curves = 4'000'000;  // Each piece of a polyline counts.
  std::uint32_t max_probe_points = 1'000'000;
  std::uint32_t max_pixels = 2u << 20;  // A picture of all channels takes 200 bytes a pixel while it is rendered.
  std::uint32_t max_running_jobs = 200;
  std::uint32_t max_jobs = 10'000;
  std::uint32_t max_watches = 2000;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_LIMITS_H_
