// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/caching_figures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "client/cli/commands/figure_drawing.h"
#include "client/cli/commands/record_error_figure.h"
#include "client/cli/comparison/comparison.h"
#include "client/cli/formats/enum_names.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr char kExtrapolation[] = "extrapolation";
constexpr char kWalls[] = "records-walls";
constexpr char kErrors[] = "records-errors";

// A polynomial of a degree from point `center`, over a share of the probe to each side.
v1::ProbeResult Extrapolated(const v1::ProbeResult& exact, int center, int degree) {
  constexpr double kReach = 0.18;
  const int count = static_cast<int>(exact.count()), reach = static_cast<int>(kReach * count);
  v1::ProbeResult out;
  out.set_quantity(v1::ProbeResult::IRRADIANCE);
  out.set_channels(1);
  for (int i = std::max(center - reach, 0); i <= std::min(center + reach, count - 1); ++i) {
    const double d = exact.arc_length(i) - exact.arc_length(center);
    out.add_arc_length(exact.arc_length(i));
    for (const int k : {2 * i, 2 * i + 1}) out.add_positions(exact.positions(k)), out.add_normals(exact.normals(k));
    const double bend = degree > 1 ? 0.5 * exact.hessian(center) * d * d : 0;
    out.add_irradiance(exact.irradiance(center) + d * exact.gradient(center) + bend);
  }
  out.set_count(static_cast<std::uint32_t>(out.irradiance_size()));
  return out;
}

// How far it is off where a record would be used, nearer than half of its reach, relative to the irradiance at the
// record.
std::vector<std::string> ExtrapolationRow(const v1::ProbeResult& exact, const v1::ProbeResult& found, int center,
                                          int degree) {
  double squares = 0, largest = 0;
  int points = 0, i = 0;
  while (exact.arc_length(i) != found.arc_length(0)) ++i;
  for (int k = 0; k < found.irradiance_size(); ++k, ++i) {
    if (2 * std::abs(i - center) > found.irradiance_size() / 2) continue;
    const double off = std::abs(found.irradiance(k) - exact.irradiance(i)) / exact.irradiance(center);
    squares += off * off, largest = std::max(largest, off), ++points;
  }
  return {FormatValue(exact.arc_length(center)), std::to_string(degree), FormatPercent(std::sqrt(squares / points)),
          FormatPercent(largest)};
}

CommandResult DrawExtrapolation(const FigureDrawing& drawing) {
  v1::Settings settings;
  settings.set_method(v1::Settings::EXACT);
  auto exact = drawing.RenderFirstProbe(GallerySource("blocker"), settings);
  if (!exact.ok()) return exact.status();
  const v1::ProbeResult truth = exact->probes(0);
  MakeCommon(drawing.line.figure, *exact);
  exact->mutable_probes(0)->set_name("exact");
  std::vector<std::vector<std::string>> rows = {{"RECORD AT", "DEGREE", "RMS ERROR", "LARGEST"}};
  for (const double place : {0.2, 0.8}) {
    const int center = static_cast<int>(place * truth.count());
    for (const int degree : {1, 2}) {
      v1::ProbeResult found = Extrapolated(truth, center, degree);
      found.set_name(FormatValue(truth.arc_length(center), 2) + " m, degree " + std::to_string(degree));
      rows.push_back(ExtrapolationRow(truth, found, center, degree));
      exact->mutable_probes(0)->clear_gradient();
      exact->mutable_probes(0)->clear_hessian();
      *exact->add_probes() = std::move(found);
    }
  }
  return drawing.Deliver(drawing.line.figure +
                             " (gallery:blocker): what a record's gradient and Hessian tell of its surroundings\n\n" +
                             FormatTable(rows),
                         *exact);
}

// gallery:black-wall with a white wall on the right.
absl::StatusOr<v1::SceneSource> WhiteWall(Session& session) {
  v1::GetSceneRequest request;
  request.set_name("scenes/black-wall");
  v1::GetSceneResponse response;
  Connection& connection = session.connection();
  if (absl::Status got = connection.Call(connection.scenes(), &v1::SceneService::Stub::GetScene, request, response);
      !got.ok())
    return got;
  v1::SceneSource source;
  v1::Scene& scene = *source.mutable_scene();
  scene = response.scene();
  v1::Material& white = *scene.mutable_plane()->add_materials();
  white.set_name("white");
  white.mutable_lambertian()->add_reflectance(0.8);
  for (v1::Curve& curve : *scene.mutable_plane()->mutable_curves())
    if (curve.name() == "right wall" || curve.name() == "floor") curve.set_material("white");
  return source;
}

CommandResult DrawWalls(const FigureDrawing& drawing) {
  constexpr std::uint32_t kRecords = 10;
  const auto white = WhiteWall(drawing.session);
  if (!white.ok()) return drawing.session.Explain(white.status());
  const std::pair<const char*, v1::SceneSource> scenes[] = {
      {"white wall", *white}, {"black wall", GallerySource("black-wall")}, {"no wall", GallerySource("no-wall")}};
  v1::RenderResult all;
  std::vector<std::vector<std::string>> rows = {{"WALL", "ERROR CONTROL", "RECORDS", "RMS ERROR", "RELATIVE"}};
  for (const auto& [wall, source] : scenes) {
    v1::Settings settings;
    settings.set_method(v1::Settings::REFERENCE);
    settings.set_derivatives(v1::Settings::NONE);
    auto truth = drawing.RenderFirstProbe(source, settings);
    if (!truth.ok()) return truth.status();
    *all.add_probes() = truth->probes(0);
    all.mutable_probes(all.probes_size() - 1)->set_name(wall);
    settings.Clear();
    settings.set_method(v1::Settings::IRRADIANCE_CACHING);
    settings.set_extrapolation(1);
    settings.set_max_records(kRecords);
    for (const auto control : {v1::Settings::SPLIT_SPHERE, v1::Settings::OCCLUSION_HESSIAN}) {
      settings.set_error_control(control);
      auto found = drawing.RenderFirstProbe(source, settings);
      if (!found.ok()) return found.status();
      const auto comparison = Compare(*found, *truth, 1.0);
      if (!comparison.ok()) return comparison.status();
      const QuantityComparison& irradiance = comparison->quantities.front();
      rows.push_back({wall, OptionName(control), std::to_string(found->records_size()), FormatValue(irradiance.rms),
                      Share(irradiance.relative_rms)});
      for (v1::CacheRecord& record : *found->mutable_records()) {
        record.set_curve(std::string(wall) + ", " + OptionName(control));
        *all.add_records() = std::move(record);
      }
    }
  }
  MakeCommon(drawing.line.figure, all);
  return drawing.Deliver(
      drawing.line.figure + ": where " + std::to_string(kRecords) +
          " records of a floor go that a lamp lights between two walls, of which one is white, black or left out\n\n" +
          FormatTable(rows),
      all);
}

}  // namespace

std::vector<std::string> CachingFigureNames() { return {kExtrapolation, kWalls, kErrors}; }

std::optional<CommandResult> DrawCachingFigure(const CommandLine& line, Interruption& interruption) {
  if (line.figure == kErrors) return DrawRecordErrors(line, interruption);
  if (line.figure == kExtrapolation) return OpenAndDraw(line, interruption, DrawExtrapolation);
  if (line.figure == kWalls) return OpenAndDraw(line, interruption, DrawWalls);
  return std::nullopt;
}

}  // namespace flatlight
