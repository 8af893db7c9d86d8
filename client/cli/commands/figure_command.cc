// SPDX-License-Identifier: Apache-2.0
// The experiments of the papers, each one command.
#include <string>
#include <utility>
#include <vector>

#include "client/cli/commands/caching_figures.h"
#include "client/cli/commands/commands.h"
#include "client/cli/commands/figure_drawing.h"
#include "client/cli/comparison/comparison.h"
#include "client/cli/formats/enum_names.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

// Derivatives of direct light on the first probe of a gallery scene, exact and in all formulations.
struct DerivativesFigure {
  const char* name;
  const char* scene;
  const char* text;
};

constexpr DerivativesFigure kDerivatives[] = {
    {"derivatives", "unit-light", "nothing blocks the light: all formulations agree with exact light"},
    {"derivatives-occluded", "blocker",
     "a plate blocks the light: arc-length does not see its shadow move, the others agree with exact light"}};

struct ConvergenceFigure {
  const char* name = "convergence";
  std::vector<std::string> scenes = {"gallery:unit-light", "gallery:blocker", "gallery:penumbra", "gallery:ring"};
  std::vector<std::uint32_t> budgets = {256, 1024, 4096, 16384};
  std::uint32_t seeds = 4;
};

// Photons on the first probe of a gallery scene: their density, and what a final gather makes of the same map.
struct PhotonFigure {
  const char* name = "photon-map";
  const char* scene = "penumbra";
  std::uint32_t photons = 100;
  // m. The best of these and the default stands for the best that densities can do.
  std::vector<double> bandwidths = {0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.2, 2, 4};
};

// Rows of a table: how far a formulation's derivatives are from exact ones.
absl::Status AddRows(const std::string& name, const v1::RenderResult& found, const v1::RenderResult& exact,
                     std::vector<std::vector<std::string>>& rows) {
  const auto comparison = Compare(found, exact, std::nullopt);
  if (!comparison.ok()) return comparison.status();
  for (const QuantityComparison& quantity : comparison->quantities) {
    if (quantity.quantity == "irradiance") continue;
    rows.push_back({name, quantity.quantity, FormatValue(quantity.rms), Share(quantity.relative_rms),
                    FormatValue(quantity.largest)});
  }
  return absl::OkStatus();
}

CommandResult DrawDerivatives(const DerivativesFigure& figure, const FigureDrawing& drawing) {
  const v1::SceneSource source = GallerySource(figure.scene);
  v1::Settings settings;
  settings.set_method(v1::Settings::EXACT);
  const auto exact = drawing.RenderFirstProbe(source, settings);
  if (!exact.ok()) return exact.status();
  v1::RenderResult all = *exact;
  MakeCommon(figure.name, all);
  all.mutable_probes(0)->set_name("exact");
  std::vector<std::vector<std::string>> rows = {{"FORMULATION", "QUANTITY", "RMS ERROR", "RELATIVE", "LARGEST"}};
  settings = drawing.line.settings;
  settings.set_method(v1::Settings::RAY_TRACING);
  for (const auto formulation : {v1::Settings::STRATIFIED, v1::Settings::POLYLINE, v1::Settings::ARC_LENGTH}) {
    settings.set_formulation(formulation);
    const auto result = drawing.RenderFirstProbe(source, settings);
    if (!result.ok()) return result.status();
    const std::string name = OptionName(formulation);
    if (absl::Status added = AddRows(name, *result, *exact, rows); !added.ok()) return added;
    *all.add_probes() = result->probes(0);
    all.mutable_probes(all.probes_size() - 1)->set_name(name);
  }
  return drawing.Deliver(
      std::string(figure.name) + " (gallery:" + figure.scene + "): " + figure.text + "\n\n" + FormatTable(rows), all);
}

// How far a result's irradiance is from that of another.
absl::StatusOr<QuantityComparison> IrradianceError(const v1::RenderResult& found, const v1::RenderResult& truth) {
  const auto comparison = Compare(found, truth, std::nullopt);
  if (!comparison.ok()) return comparison.status();
  return comparison->quantities.front();
}

CommandResult DrawPhotonMap(const PhotonFigure& figure, const FigureDrawing& drawing) {
  const v1::SceneSource source = GallerySource(figure.scene);
  v1::Settings settings;
  settings.set_method(v1::Settings::REFERENCE);
  settings.set_derivatives(v1::Settings::NONE);
  const auto reference = drawing.RenderFirstProbe(source, settings);
  if (!reference.ok()) return reference.status();
  v1::RenderResult all = *reference;
  MakeCommon(figure.name, all);
  all.mutable_probes(0)->set_name("reference");
  std::vector<std::vector<std::string>> rows = {{"METHOD", "BANDWIDTH", "RMS ERROR", "RELATIVE", "LARGEST"}};
  const auto add = [&](const std::string& name, const std::string& bandwidth, const v1::RenderResult& result,
                       const QuantityComparison& error) {
    rows.push_back({name, bandwidth, FormatValue(error.rms), Share(error.relative_rms), FormatValue(error.largest)});
    *all.add_probes() = result.probes(0);
    all.mutable_probes(all.probes_size() - 1)->set_name(name);
  };
  settings = drawing.line.settings;
  settings.set_method(v1::Settings::PHOTON_MAPPING);
  if (!settings.has_photons()) settings.set_photons(figure.photons);
  v1::Settings density = settings;
  density.clear_samples();
  density.set_final_gather(false);
  const auto chosen = drawing.RenderFirstProbe(source, density);
  if (!chosen.ok()) return chosen.status();
  const auto chosen_error = IrradianceError(*chosen, *reference);
  if (!chosen_error.ok()) return chosen_error.status();
  add("density", "chosen at each point", *chosen, *chosen_error);
  v1::RenderResult best = *chosen;
  QuantityComparison best_error = *chosen_error;
  std::string best_name = "chosen at each point";
  for (const auto kernel :
       {v1::Settings::BOX, v1::Settings::TRIANGLE, v1::Settings::EPANECHNIKOV, v1::Settings::BIWEIGHT}) {
    for (const double bandwidth : figure.bandwidths) {
      density.set_kernel(kernel);
      density.set_bandwidth(bandwidth);
      const auto result = drawing.RenderFirstProbe(source, density);
      if (!result.ok()) return result.status();
      const auto error = IrradianceError(*result, *reference);
      if (!error.ok()) return error.status();
      if (error->rms >= best_error.rms) continue;
      best = *result;
      best_error = *error;
      best_name = FormatValue(bandwidth) + " m, " + OptionName(kernel);
    }
  }
  add("best density", best_name, best, best_error);
  settings.set_derivatives(v1::Settings::NONE);
  const auto gathered = drawing.RenderFirstProbe(source, settings);
  if (!gathered.ok()) return gathered.status();
  const auto gathered_error = IrradianceError(*gathered, *reference);
  if (!gathered_error.ok()) return gathered_error.status();
  add("final gather", "chosen", *gathered, *gathered_error);
  return drawing.Deliver(std::string(figure.name) + " (gallery:" + figure.scene +
                             "): " + std::to_string(settings.photons()) + " photons; a final gather has an RMS error " +
                             FormatValue(best_error.rms / gathered_error->rms) +
                             " times smaller than the best density of the same map\n\n" + FormatTable(rows),
                         all);
}

}  // namespace

std::vector<std::string> FigureNames() {
  std::vector<std::string> names;
  for (const DerivativesFigure& figure : kDerivatives) names.emplace_back(figure.name);
  names.emplace_back(PhotonFigure().name);
  names.emplace_back(ConvergenceFigure().name);
  for (const std::string& name : CachingFigureNames()) names.push_back(name);
  return names;
}

CommandResult Figure(const CommandLine& line, Interruption& interruption) {
  for (const DerivativesFigure& figure : kDerivatives) {
    if (line.figure == figure.name)
      return OpenAndDraw(line, interruption,
                         [&](const FigureDrawing& drawing) { return DrawDerivatives(figure, drawing); });
  }
  if (const auto drawn = DrawCachingFigure(line, interruption)) return *drawn;
  if (const PhotonFigure photons; line.figure == photons.name)
    return OpenAndDraw(line, interruption,
                       [&](const FigureDrawing& drawing) { return DrawPhotonMap(photons, drawing); });
  const ConvergenceFigure convergence;
  if (line.figure == convergence.name) {
    CommandLine bench = line;
    bench.bench.scenes = convergence.scenes;
    bench.bench.budgets = convergence.budgets;
    bench.bench.seeds = convergence.seeds;
    return BenchMethods(bench, interruption);
  }
  std::string known;
  for (const std::string& name : FigureNames()) known += (known.empty() ? "" : ", ") + name;
  return UsageError("there is no figure '" + Printable(line.figure) + "'; there are " + known);
}

}  // namespace flatlight
