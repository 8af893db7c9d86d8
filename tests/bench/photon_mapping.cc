// SPDX-License-Identifier: Apache-2.0
// How the error of photon mapping falls with photons, what a final gather gains, and whether stated errors tell the
// truth.
//
//   photon_mapping [CSV]      the rows go to CSV (default: out/photon_mapping.csv) as well
//
// For each lambertian scene of the gallery and number of photons: many seeds, each compared with the reference. RMS
// errors are over seeds and points, relative to the mean irradiance. "bias" is that of the mean over seeds, less what
// noise makes of it; "stated" what results say of it. z is (value - truth) / standard error, as far as the difference
// is larger than the stated bias: honest errors give a mean square of about 1 or less. That of gradients is of the
// difference over the stated error, which has the bias in it. Printed too: to what power of photons errors go.
#include <algorithm>
#include <cmath>
#include <cstdio>
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

constexpr std::uint32_t kPoints = 128;

struct Measured {
  double rms = 0;     // Relative to the mean.
  double doubt = 0;   // Of the logarithm of that: its standard error by the scatter of the seeds.
  double bias = 0;    // Likewise, RMS over points.
  double stated = 0;  // Likewise.
  double z_square = 0;
  double gradient_z_square = 0;
  double seconds = 0;
};

std::vector<double> All(const Field& field, std::vector<double> ProbeField::*values) {
  std::vector<double> all;
  for (const ProbeField& probe : field.probes) all.insert(all.end(), (probe.*values).begin(), (probe.*values).end());
  return all;
}

Measured Measure(const std::shared_ptr<const Scene>& scene, const Field& reference, Settings settings,
                 std::uint32_t seeds) {
  const std::vector<double> truth = All(reference, &ProbeField::irradiance);
  const std::vector<double> slope = All(reference, &ProbeField::gradient);
  const std::size_t n = truth.size();
  std::vector<double> sum(n), squares(n), stated(n), of_seed(seeds);
  Measured measured;
  const double begin = ThreadSeconds();
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    settings.seed = seed;
    const std::shared_ptr<const Field> field = Render(scene, settings).field;
    const std::vector<double> value = All(*field, &ProbeField::irradiance);
    const std::vector<double> error = All(*field, &ProbeField::standard_error);
    const std::vector<double> bias = All(*field, &ProbeField::estimated_bias);
    const std::vector<double> gradient = All(*field, &ProbeField::gradient);
    const std::vector<double> gradient_error = All(*field, &ProbeField::gradient_error);
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      const double z = (gradient[i] - slope[i]) / gradient_error[i];
      measured.gradient_z_square += z * z / (static_cast<double>(n) * seeds);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double difference = value[i] - truth[i];
      sum[i] += difference;
      squares[i] += difference * difference;
      of_seed[seed] += difference * difference;
      stated[i] += bias[i] * bias[i];
      const double beyond = std::max(std::abs(difference) - bias[i], 0.0) / error[i];
      measured.z_square += beyond * beyond / (static_cast<double>(n) * seeds);
    }
  }
  measured.seconds = (ThreadSeconds() - begin) / seeds;
  double mean = 0, all = 0, biases = 0, statements = 0;
  for (std::size_t i = 0; i < n; ++i) {
    mean += truth[i] / static_cast<double>(n);
    all += squares[i] / seeds;
    statements += stated[i] / seeds;
    const double off = sum[i] / seeds, variance = (squares[i] / seeds - off * off) / (seeds - 1);
    biases += off * off - variance;
  }
  const auto relative = [&](double sum_of_squares) {
    return std::sqrt(std::max(sum_of_squares, 0.0) / static_cast<double>(n)) / mean;
  };
  measured.rms = relative(all);
  double scatter = 0;
  for (const double one : of_seed) scatter += (one - all) * (one - all);
  measured.doubt = 0.5 * std::sqrt(scatter / (seeds - 1.0) / seeds) / all;
  measured.bias = relative(biases);
  measured.stated = relative(statements);
  return measured;
}

struct Case {
  std::uint32_t photons, seeds;
};

void Add(const std::string& scene, const std::string& how, std::uint32_t photons, const Measured& m,
         const Measured* before, BenchTable& table) {
  const double slope = before ? std::log(m.rms / before->rms) / std::log(8.0) : 0;
  table.Add({scene, how, std::to_string(photons), Short(m.rms), before ? Short(slope) : "-", Short(m.bias),
             Short(m.stated), Short(m.z_square), m.gradient_z_square > 0 ? Short(m.gradient_z_square) : "-",
             Short(m.seconds)});
}

// Photons to what power errors go with, from the second number of photons on, each 8 times the one before, and that
// power's standard error.
void PrintFall(const std::string& scene, const std::vector<Measured>& densities) {
  const std::size_t count = densities.size() - 1;
  const double middle = 0.5 * static_cast<double>(count - 1);
  double slope = 0, squares = 0, variance = 0;
  for (std::size_t k = 0; k < count; ++k)
    squares += (static_cast<double>(k) - middle) * (static_cast<double>(k) - middle);
  for (std::size_t k = 0; k < count; ++k) {
    const double weight = (static_cast<double>(k) - middle) / squares / std::log(8.0);
    slope += weight * std::log(densities[k + 1].rms);
    variance += weight * weight * densities[k + 1].doubt * densities[k + 1].doubt;
  }
  std::printf("%s: errors of densities go with photons to the power of %.3f +- %.3f\n", scene.c_str(), slope,
              std::sqrt(variance));
}

// The error of direct light, which is what a gather is left with where no photon arrived, and of no light at all.
void PrintWithoutPhotons(const NamedScene& named, const Field& reference) {
  Settings settings;
  settings.method = Method::kExact;
  settings.max_bounces = 0;
  settings.derivatives = Derivatives::kNone;
  const std::vector<double> truth = All(reference, &ProbeField::irradiance);
  const std::vector<double> direct = All(*Render(named.scene, settings).field, &ProbeField::irradiance);
  double mean = 0, squares = 0, all = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    mean += truth[i], all += truth[i] * truth[i];
    squares += (direct[i] - truth[i]) * (direct[i] - truth[i]);
  }
  const double n = static_cast<double>(truth.size());
  std::printf("%s: RMS error of direct light alone %.3g, of no light %.3g: %.2f times as large\n", named.name.c_str(),
              std::sqrt(squares * n) / mean, std::sqrt(all * n) / mean, std::sqrt(all / squares));
}

void AddScene(const NamedScene& named, BenchTable& table) {
  Settings settings;
  settings.method = Method::kReference;
  settings.derivatives = Derivatives::kGradient;
  Diagnostics diagnostics;
  if (!MakePlan(*named.scene, settings, diagnostics)) return;
  settings.target_error = 1e-5;
  const std::shared_ptr<const Field> truth = Render(named.scene, settings).field;
  settings = {};
  settings.method = Method::kPhotonMapping;
  const bool reflects = named.scene->traits().max_reflectance > 0;
  if (reflects) PrintWithoutPhotons(named, *truth);
  std::vector<Measured> densities;
  std::optional<Measured> density, gather;
  double best = 0;
  for (const Case& c : {Case{100, 32}, Case{800, 32}, Case{6400, 16}, Case{51200, 16}, Case{409600, 8}}) {
    settings.photons = c.photons;
    settings.final_gather = false;
    // The best number of neighbours for all points, which nobody knows before.
    if (c.photons == 100) {
      for (const std::uint32_t k : {8, 12, 16, 24, 32, 48, 64, 90}) {
        Settings other = settings;
        other.neighbours = k;
        const double rms = Measure(named.scene, *truth, other, c.seeds).rms;
        if (best == 0 || rms < best) best = rms;
      }
      Measured of_best;
      of_best.rms = best;
      table.Add({named.name, "density, best", "100", Short(best), "-", "-", "-", "-", "-", "-"});
    }
    const Measured now = Measure(named.scene, *truth, settings, c.seeds);
    Add(named.name, "density", c.photons, now, density ? &*density : nullptr, table);
    density = now;
    densities.push_back(now);
    if (!reflects || c.photons > 51200) continue;
    settings.final_gather = true;
    settings.derivatives = Derivatives::kGradient;
    const Measured gathered = Measure(named.scene, *truth, settings, c.seeds);
    Add(named.name, "final gather", c.photons, gathered, gather ? &*gather : nullptr, table);
    gather = gathered;
    settings.derivatives.reset();
    if (c.photons == 100)
      std::printf("%s: of 100 photons a final gather is %.1f times better than the best density\n", named.name.c_str(),
                  best / gathered.rms);
  }
  PrintFall(named.name, densities);
}

int Run(const std::string& csv, const std::string& only) {
  BenchTable table({"SCENE", "METHOD", "PHOTONS", "RMS", "SLOPE", "BIAS", "STATED", "Z^2", "GRADIENT Z^2", "SECONDS"});
  for (const NamedScene& named : GalleryScenes(kPoints))
    if (only.empty() || named.name == only) AddScene(named, table);
  return table.Report(csv) ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  return flatlight::Run(argc > 1 ? argv[1] : "out/photon_mapping.csv", argc > 2 ? argv[2] : "");
}
