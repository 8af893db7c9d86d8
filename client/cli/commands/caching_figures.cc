// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/caching_figures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "client/cli/commands/console.h"
#include "client/cli/commands/first_probe.h"
#include "client/cli/commands/record_error_figure.h"
#include "client/cli/commands/result_outputs.h"
#include "client/cli/commands/session.h"
#include "client/cli/comparison/comparison.h"
#include "client/cli/formats/enum_names.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr char kExtrapolation[] = "extrapolation";
constexpr char kWalls[] = "records-walls";
constexpr char kErrors[] = "records-errors";

std::string Share(const std::optional<double>& relative) { return relative ? FormatPercent(*relative) : "-"; }

v1::SceneSource GallerySource(const std::string& name) {
  v1::SceneSource source;
  source.set_name("scenes/" + name);
  return source;
}

// The result of several jobs: what speaks of one of them alone is left out.
void MakeCommon(const std::string& name, v1::RenderResult& result) {
  result.set_scene(name);
  result.clear_settings();
  result.clear_plan();
  result.clear_statistics();
  result.clear_records_seal();
}

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

CommandResult DrawExtrapolation(const CommandLine& line, const std::vector<Output>& outputs, Session& session,
                                Console& console, Interruption& interruption) {
  Console silent(Console::Answer::kMachine, true);
  v1::Settings settings;
  settings.set_method(v1::Settings::EXACT);
  auto exact = RenderFirstProbe(session, GallerySource("blocker"), settings, silent);
  if (!exact.ok()) return session.Explain(exact.status());
  const v1::ProbeResult truth = exact->probes(0);
  MakeCommon(line.figure, *exact);
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
  console.Say(line.figure + " (gallery:blocker): what a record's gradient and Hessian tell of its surroundings\n\n" +
              FormatTable(rows));
  if (absl::Status written = WriteResult(*exact, outputs, console, interruption); !written.ok()) return written;
  return ExitCode::kDone;
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

CommandResult DrawWalls(const CommandLine& line, const std::vector<Output>& outputs, Session& session, Console& console,
                        Interruption& interruption) {
  constexpr std::uint32_t kRecords = 10;
  Console silent(Console::Answer::kMachine, true);
  const auto white = WhiteWall(session);
  if (!white.ok()) return session.Explain(white.status());
  const std::pair<const char*, v1::SceneSource> scenes[] = {
      {"white wall", *white}, {"black wall", GallerySource("black-wall")}, {"no wall", GallerySource("no-wall")}};
  v1::RenderResult all;
  std::vector<std::vector<std::string>> rows = {{"WALL", "ERROR CONTROL", "RECORDS", "RMS ERROR", "RELATIVE"}};
  for (const auto& [wall, source] : scenes) {
    v1::Settings settings;
    settings.set_method(v1::Settings::REFERENCE);
    settings.set_derivatives(v1::Settings::NONE);
    auto truth = RenderFirstProbe(session, source, settings, silent);
    if (!truth.ok()) return session.Explain(truth.status());
    *all.add_probes() = truth->probes(0);
    all.mutable_probes(all.probes_size() - 1)->set_name(wall);
    settings.Clear();
    settings.set_method(v1::Settings::IRRADIANCE_CACHING);
    settings.set_extrapolation(1);
    settings.set_max_records(kRecords);
    for (const auto control : {v1::Settings::SPLIT_SPHERE, v1::Settings::OCCLUSION_HESSIAN}) {
      settings.set_error_control(control);
      auto found = RenderFirstProbe(session, source, settings, silent);
      if (!found.ok()) return session.Explain(found.status());
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
  MakeCommon(line.figure, all);
  console.Say(
      line.figure + ": where " + std::to_string(kRecords) +
      " records of a floor go that a lamp lights between two walls, of which one is white, black or left out\n\n" +
      FormatTable(rows));
  if (absl::Status written = WriteResult(all, outputs, console, interruption); !written.ok()) return written;
  return ExitCode::kDone;
}

}  // namespace

std::vector<std::string> CachingFigureNames() { return {kExtrapolation, kWalls, kErrors}; }

std::optional<CommandResult> DrawCachingFigure(const CommandLine& line, Interruption& interruption) {
  if (line.figure == kErrors) return DrawRecordErrors(line, interruption);
  if (line.figure != kExtrapolation && line.figure != kWalls) return std::nullopt;
  const auto outputs = OutputsOf(line.outputs, line.json);
  if (!outputs.ok()) return outputs.status();
  Console console = ConsoleFor(*outputs, line.quiet);
  const auto session = Session::Open(line, Session::WithoutServer::kStartOne, interruption);
  if (!session.ok()) return session.status();
  return line.figure == kWalls ? DrawWalls(line, *outputs, **session, console, interruption)
                               : DrawExtrapolation(line, *outputs, **session, console, interruption);
}

}  // namespace flatlight
