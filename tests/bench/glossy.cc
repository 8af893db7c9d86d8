// SPDX-License-Identifier: Apache-2.0
// `glossy`: random rooms with phong lobes by the reference: how long they take, and whether bounds hold against a
// solution that is 30 times finer.  glossy [ROOMS [TARGET [FIRST ROOM]]]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "tests/core/plane/glossy/glossy_rooms.h"

namespace flatlight {
namespace {

constexpr int kThreads = 2;
constexpr double kFiner = 1.0 / 30;

void Run(std::uint64_t rooms, double target, std::uint64_t first) {
  std::printf("room,seconds,rounds,cells,bound,beyond,compared,least,median\n");
  std::size_t values = 0, beyond = 0, unreached = 0;
  std::vector<double> all, seconds;
  for (std::uint64_t seed = first; seed < first + rooms; ++seed) {
    const auto scene = GlossyRoom(seed);
    const auto start = std::chrono::steady_clock::now();
    const SolvedGloss coarse = SolveGloss(scene, target, kThreads);
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    const SolvedGloss fine = SolveGloss(scene, kFiner * target, kThreads);
    std::size_t here = 0;
    std::vector<double> cautions;
    for (std::size_t i = 0; i < coarse.values.size(); ++i) {
      const double error = std::abs(coarse.values[i].irradiance[0] - fine.values[i].irradiance[0]);
      const double bound = coarse.values[i].irradiance_error[0], of_fine = fine.values[i].irradiance_error[0];
      here += error > bound + of_fine ? 1 : 0;
      if (error > of_fine) cautions.push_back(bound / error);
    }
    values += coarse.values.size(), beyond += here;
    unreached += coarse.state == GlossySolver::State::kReached ? 0 : 1;
    std::sort(cautions.begin(), cautions.end());
    all.insert(all.end(), cautions.begin(), cautions.end());
    std::printf("%llu,%.2f,%d,%zu,%.2g,%zu,%zu,%.3g,%.3g\n", static_cast<unsigned long long>(seed), seconds.back(),
                coarse.rounds, coarse.cells, coarse.relative_error, here, cautions.size(),
                cautions.empty() ? 0 : cautions.front(), cautions.empty() ? 0 : cautions[cautions.size() / 2]);
    std::fflush(stdout);
  }
  std::sort(all.begin(), all.end());
  std::sort(seconds.begin(), seconds.end());
  const auto part = [](const std::vector<double>& sorted, double share) {
    return sorted.empty() ? 0 : sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  std::printf(
      "# %zu values, %zu beyond their bound, %zu rooms not to the target; bound over error, of %zu values that "
      "tell: least %.3g, median %.3g, 90th percentile %.3g; seconds: median %.2f, most %.2f\n",
      values, beyond, unreached, all.size(), part(all, 0), part(all, 0.5), part(all, 0.9), part(seconds, 0.5),
      part(seconds, 1));
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  const std::uint64_t rooms = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 12;
  const double target = argc > 2 ? std::strtod(argv[2], nullptr) : 1e-2;
  flatlight::Run(rooms, target, argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1);
}
