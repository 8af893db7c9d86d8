// SPDX-License-Identifier: Apache-2.0
// Whether errors that are stated have the right size, over the gallery.
//
//   calibration [CSV [SCENE [METHOD]]]     the rows go to CSV (default: out/calibration.csv) as well; SCENE and
//                                          METHOD choose rows that have them in their names
//   calibration --check                    path tracing of all bounces alone, few seeds; status 1 if errors are stated
//                                          too small anywhere, or too large over the gallery
//
// z = (value - truth) / error, the error being the stated one and that of the truth together. The mean of z^2 is 1 if
// errors have the right size, and stands with its standard error from the scatter over seeds. *Beyond 3* is the share
// of |z| > 3: 0.6 % for values that are normal, as errors come from 16 replicates. Values known to rounding are counted
// apart: they are right if they are within 3 stated errors, and there is nothing else to learn from them; values of 0
// that are right do not count. Truth is exact light, the reference, or a long rendering by paths.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "core/execution/thread_pool.h"
#include "core/render/field.h"
#include "core/render/settings.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/named_scenes.h"
#include "tests/support/transport/render.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kPoints = 256;
constexpr std::uint32_t kSeeds = 4;
constexpr std::uint32_t kCheckedSeeds = 1;
constexpr std::uint32_t kCheckedSamples = 256;
constexpr std::uint32_t kTruthSamples = 1 << 14;
constexpr std::uint32_t kTruthSeed = 1'000'000;
constexpr double kRounding = 1e-9;  // Relative to the brightest point: values stated to be better hardly have noise.

struct Quantity {
  const char* name;
  std::vector<double> ProbeField::*value;
  std::vector<double> ProbeField::*error;
};
constexpr Quantity kQuantities[] = {
    {"irradiance", &ProbeField::irradiance, &ProbeField::standard_error},
    {"gradient", &ProbeField::gradient, &ProbeField::gradient_error},
    {"hessian", &ProbeField::hessian, &ProbeField::hessian_error},
};

class Calibration {
 public:
  void Add(double z, bool rounding, std::uint32_t seed) {
    if (rounding) {
      ++exact_;
      exact_beyond_ += std::abs(z) > 3 ? 1 : 0;
      return;
    }
    sum_ += z;
    squares_[seed] += z * z;
    counts_[seed] += 1;
    beyond_ += std::abs(z) > 3 ? 1 : 0;
    worst_ = std::max(worst_, std::abs(z));
  }

  double Count() const { return std::accumulate(counts_.begin(), counts_.end(), 0.0); }
  double Squares() const { return std::accumulate(squares_.begin(), squares_.end(), 0.0); }

  std::vector<std::string> Columns() const {
    const double count = Count(), squares = Squares();
    std::vector<std::string> columns = {Short(count), Short(exact_)};
    if (count == 0) {
      columns.insert(columns.end(), {"-", "-", "-", "-", "-"});
    } else {
      const double mean = squares / count;
      double scatter = 0;
      for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const double off = squares_[seed] - mean * counts_[seed];
        scatter += off * off;
      }
      for (const double x : {sum_ / count, mean, std::sqrt(scatter) / count, beyond_ / count, worst_})
        columns.push_back(Short(x));
    }
    columns.push_back(Short(exact_beyond_));
    return columns;
  }

 private:
  double sum_ = 0, beyond_ = 0, worst_ = 0, exact_ = 0, exact_beyond_ = 0;
  std::vector<double> squares_ = std::vector<double>(kSeeds), counts_ = std::vector<double>(kSeeds);
};

using Calibrations = std::map<std::string, Calibration>;  // By quantity.

Settings TruthSettings(const Scene& scene, bool direct, bool derivatives) {
  Settings settings;
  if (direct) {
    settings.method = Method::kExact;
    settings.max_bounces = 0;
    settings.derivatives = derivatives ? Derivatives::kHessian : Derivatives::kNone;
  } else if (scene.traits().lambertian) {
    settings.method = Method::kReference;
    settings.target_error = 1e-4;
    settings.time_limit = 10;
    settings.derivatives = derivatives ? Derivatives::kGradient : Derivatives::kNone;
  } else {
    settings = Sampled(kTruthSamples, kTruthSeed);
  }
  return settings;
}

double Brightest(const std::vector<double>& values) {
  double brightest = 0;
  for (const double value : values) brightest = std::max(brightest, std::abs(value));
  return brightest;
}

void Compare(const Field& field, const Field& truth, std::uint32_t seed, Calibrations& into) {
  for (std::size_t p = 0; p < field.probes.size(); ++p) {
    for (const Quantity& quantity : kQuantities) {
      const std::vector<double>& a = field.probes[p].*quantity.value;
      const std::vector<double>& b = truth.probes[p].*quantity.value;
      const std::vector<double>& error = field.probes[p].*quantity.error;
      if (a.size() != b.size() || error.size() != a.size()) continue;
      const std::vector<double>& noise = truth.probes[p].*quantity.error;
      const std::vector<double>& bound = truth.probes[p].irradiance_error;
      const bool bounded = noise.empty() && &(truth.probes[p].*quantity.value) == &truth.probes[p].irradiance;
      const double brightest = Brightest(b);
      for (std::size_t i = 0; i < a.size(); ++i) {
        if (!std::isfinite(b[i])) continue;
        const double doubt = !noise.empty() ? noise[i] : bounded && !bound.empty() ? bound[i] / 8 : 0;
        const double stated = std::hypot(error[i], doubt);
        if (a[i] == 0 && b[i] == 0) continue;  // Darkness: what is stated there is caution.
        // Truths that are not much better than what they judge tell nothing.
        if (!noise.empty() && doubt > error[i]) continue;
        const double z = stated > 0 ? (a[i] - b[i]) / stated : a[i] == b[i] ? 0 : 1e9;
        into[quantity.name].Add(z, error[i] <= kRounding * brightest, seed);
      }
    }
  }
}

// What a method states of a scene in `seeds` renderings.
Calibrations Calibrate(const NamedScene& scene, const Field& truth, Settings settings, std::uint32_t seeds,
                       Executor& executor) {
  Calibrations calibrations;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    settings.seed = seed;
    Compare(*Render(scene.scene, settings, executor).field, truth, seed, calibrations);
  }
  return calibrations;
}

void Measure(const NamedScene& scene, bool direct, const std::string& only_method, BenchTable& table) {
  ThreadPool pool(ThreadPool::AvailableProcessors());
  const SceneTraits& traits = scene.scene->traits();
  const bool has_gradients = direct || (traits.lambertian && !traits.has_beziers);
  const std::shared_ptr<const Field> truth =
      Render(scene.scene, TruthSettings(*scene.scene, direct, has_gradients), pool).field;
  for (const Method method : {Method::kPathTracing, Method::kRayTracing}) {
    const bool rays = method == Method::kRayTracing;
    const std::string name = rays ? "ray-tracing" : "path-tracing";
    if (name.find(only_method) == std::string::npos) continue;
    for (const std::uint32_t samples : {16u, 64u, 256u, 1024u}) {
      // Ray tracing begins with 256.
      if (rays && samples < 256) continue;
      Settings settings = Sampled(samples);
      settings.method = method;
      if (rays) settings.derivatives = direct ? Derivatives::kHessian : Derivatives::kGradient;
      if (direct) settings.max_bounces = 0;
      const std::uint32_t seeds = rays && !direct ? 1 : kSeeds;
      for (const auto& [quantity, calibration] : Calibrate(scene, *truth, settings, seeds, pool)) {
        std::vector<std::string> row = {scene.name, direct ? "direct" : "all", name, quantity, std::to_string(samples)};
        const std::vector<std::string> columns = calibration.Columns();
        row.insert(row.end(), columns.begin(), columns.end());
        table.Add(row);
      }
    }
  }
}

int Run(const std::string& csv, const std::string& scene_name, const std::string& method) {
  BenchTable table({"scene", "light", "method", "quantity", "samples", "values", "exact", "mean z", "mean z^2", "+-",
                    "beyond 3", "largest", "exact beyond 3"});
  for (const NamedScene& scene : GalleryScenes(kPoints)) {
    if (scene.name.find(scene_name) == std::string::npos) continue;
    Measure(scene, true, method, table);
    if (scene.scene->traits().max_reflectance > 0) Measure(scene, false, method, table);
  }
  return table.Report(csv) ? 0 : 1;
}

// Where neighbours share what they know of their errors, the mean of z^2 over a scene has the scatter of its values
// alone: 2 of each, and channels are no independent ones. At 5 standard deviations a right program fails once in 10^6.
bool TooSmall(double squares, double values, double channels) {
  return squares / values > 1 + 5 * std::sqrt(2 * channels / values);
}

int Check() {
  constexpr double kLeast = 0.75;  // Over the gallery. Where nothing was found caution makes errors too large.
  ThreadPool pool(ThreadPool::AvailableProcessors());
  double all_squares = 0, all_values = 0;
  bool right = true;
  for (const NamedScene& scene : GalleryScenes(kPoints)) {
    if (scene.scene->traits().max_reflectance == 0) continue;
    const std::shared_ptr<const Field> truth =
        Render(scene.scene, TruthSettings(*scene.scene, false, false), pool).field;
    const Calibrations calibrations = Calibrate(scene, *truth, Sampled(kCheckedSamples), kCheckedSeeds, pool);
    const auto found = calibrations.find("irradiance");
    if (found == calibrations.end() || found->second.Count() == 0) continue;
    const double squares = found->second.Squares(), values = found->second.Count();
    if (squares < 1e-6 * values) continue;  // No noise.
    all_squares += squares, all_values += values;
    std::printf("%s: mean z^2 %.3f of %.0f values\n", scene.name.c_str(), squares / values, values);
    if (!TooSmall(squares, values, scene.scene->channels())) continue;
    std::printf("  errors are stated too small\n");
    right = false;
  }
  std::printf("gallery: mean z^2 %.3f\n", all_squares / all_values);
  right = right && !TooSmall(all_squares, all_values, kMaxChannels) && all_squares > kLeast * all_values;
  return right ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  const auto argument = [&](int i, const char* otherwise) { return std::string(argc > i ? argv[i] : otherwise); };
  if (argument(1, "") == "--check") return flatlight::Check();
  return flatlight::Run(argument(1, "out/calibration.csv"), argument(2, ""), argument(3, ""));
}
