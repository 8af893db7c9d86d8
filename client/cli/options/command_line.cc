// SPDX-License-Identifier: Apache-2.0
// The only file that includes CLI11, which takes long to compile.
#include "client/cli/options/command_line.h"

#include <CLI/CLI.hpp>
#include <limits>
#include <sstream>

#include "client/cli/formats/enum_names.h"
#include "client/cli/options/help_texts.h"
#include "client/cli/options/settings_options.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

struct Raw {
  CommandLine line;
  SettingsOptions settings;
  BenchTexts bench;
  RoomTexts room;
  std::optional<std::string> picture;
  std::optional<std::string> tolerance;
  std::optional<std::string> prune;
  std::optional<std::string> keep;
  std::optional<std::string> server;
};

CLI::App& AddCommand(CLI::App& app, const std::string& name, const std::string& description, const char* footer = "") {
  CLI::App& command = *app.add_subcommand(name, description);
  command.footer(footer);
  return command;
}

void AddServer(CLI::App& app, Raw& raw) {
  app.add_option("--server", raw.server, "HOST:PORT or unix:PATH (or FLATLIGHT_SERVER)");
  app.add_option("--token-file", raw.line.token_file, "a file whose first line is the token (or FLATLIGHT_TOKEN)")
      ->type_name("FILE");
  const auto not_empty = [](const std::string& text) { return text.empty() ? "is empty" : ""; };
  const auto add = [&](const std::string& name, std::string& value, const std::string& description,
                       const std::string& type) {
    app.add_option(name, value, description)->type_name(type)->check(not_empty);
  };
  TlsArguments& tls = raw.line.tls;
  add("--tls-ca", tls.ca, "TLS: who may vouch for the server, in PEM form (or FLATLIGHT_TLS_CA; else the system's)",
      "FILE");
  add("--tls-cert", tls.cert, "TLS: your own certificate, if the server asks for one (or FLATLIGHT_TLS_CERT)", "FILE");
  add("--tls-key", tls.key, "TLS: its private key (or FLATLIGHT_TLS_KEY)", "FILE");
  add("--tls-name", tls.name, "TLS: the server's name, if its address is another (or FLATLIGHT_TLS_NAME)", "NAME");
}

void AddJson(CLI::App& app, Raw& raw, const std::string& what) {
  app.add_flag("--json", raw.line.json, "print " + what + " as JSON on standard output");
}

void AddCancelOnDisconnect(CLI::App& app, Raw& raw) {
  app.add_flag("--cancel-on-disconnect", raw.line.cancel_on_disconnect,
               "the server cancels the job when it loses this command, however that ends");
}

void AddQuiet(CLI::App& app, Raw& raw) { app.add_flag("-q,--quiet", raw.line.quiet, "say nothing but errors"); }

void AddScene(CLI::App& app, Raw& raw) {
  app.add_option("SCENE", raw.line.scene, "a scene file, - (standard input) or gallery:NAME")->required();
}

void AddJob(CLI::App& app, Raw& raw) { app.add_option("JOB", raw.line.job, "the job")->required(); }

void AddOutputs(CLI::App& app, Raw& raw) {
  app.add_option("-o,--output", raw.line.outputs, "write the result to OUT; may be repeated")
      ->type_name("OUT")
      ->allow_extra_args(false);
}

void AddBounces(CLI::App& app, SettingsOptions& settings) {
  app.add_option("--max-bounces", settings.max_bounces, "reflections; 0 is direct light (default: all)")
      ->type_name("N");
}

void AddDerivatives(CLI::App& app, SettingsOptions& settings) {
  app.add_option("--derivatives", settings.derivatives, "none, gradient or hessian (default: all the method gives)")
      ->type_name("NAME");
}

void AddFormulation(CLI::App& app, SettingsOptions& settings) {
  app.add_option("--formulation", settings.formulation,
                 "of ray-tracing's derivatives: stratified (default), polyline or arc-length")
      ->type_name("NAME");
}

void AddCaching(CLI::App& app, SettingsOptions& settings) {
  app.add_option("--error-control", settings.error_control,
                 "of irradiance-caching: split-sphere, bounded-split-sphere, radiometric-hessian, geometric-hessian, "
                 "occlusion-hessian or visibility-events (default)")
      ->type_name("NAME");
  app.add_option("--gather", settings.gather,
                 "what is reflected: from-reference (default where it can), from-ray-tracing or from-photon-map")
      ->type_name("NAME");
  app.add_option("--extrapolation", settings.extrapolation, "degree from a record, 0 to 2 (default 2)")->type_name("N");
  app.add_option("--tolerance", settings.tolerance, "estimated relative error of irradiance-caching (default 0.01)")
      ->type_name("E");
  app.add_option("--max-records", settings.max_records, "in place of a tolerance: so many, where they help most")
      ->type_name("N");
}

void AddCachingExtras(CLI::App& app, SettingsOptions& settings) {
  app.add_flag("--neighbour-clamping", settings.neighbour_clamping,
               "a record counts no further than to another one and as far as that one does");
  app.add_flag("--overture", settings.overture,
               "place records for two thirds of the tolerance, use them up to all of it");
}

void AddPhotons(CLI::App& app, SettingsOptions& settings) {
  app.add_option("--photons", settings.photons, "of photon-mapping and from-photon-map, in all (default 65536)")
      ->type_name("N");
  app.add_option("--final-gather", settings.final_gather,
                 "true: rays look photons up; false: their density at the points (default: true if something reflects)")
      ->type_name("BOOL");
  app.add_option("--bandwidth", settings.bandwidth, "half the kernel's width, in m (default: narrows with photons)")
      ->type_name("H");
  app.add_option("--neighbours", settings.neighbours, "in place of a bandwidth: up to this nearest photon")
      ->type_name("K");
  app.add_option("--kernel", settings.kernel, "box, triangle, epanechnikov or biweight")->type_name("NAME");
}

void AddThreadsAndSkips(CLI::App& app, SettingsOptions& settings) {
  app.add_option("--threads", settings.threads, "at most so many (default: all the server's)")->type_name("N");
  app.add_option("--no-skip", settings.no_skip, "do work that could be left out, see explain; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
}

void AddSettings(CLI::App& app, Raw& raw) {
  SettingsOptions& settings = raw.settings;
  app.add_option("--method", settings.method,
                 "exact (direct light), path-tracing, ray-tracing, reference, irradiance-caching or photon-mapping")
      ->type_name("NAME");
  app.add_option(
         "--samples", settings.samples,
         "paths a point (default 1024), first rays a point of ray-tracing or photon-mapping (256) or a record (1024)")
      ->type_name("N");
  AddBounces(app, settings);
  app.add_option("--seed", settings.seed, "another seed, an independent result (default 0)")->type_name("N");
  AddDerivatives(app, settings);
  AddFormulation(app, settings);
  AddCaching(app, settings);
  AddCachingExtras(app, settings);
  AddPhotons(app, settings);
  app.add_option("--target-error", settings.target_error, "stop at this relative standard error, in (0, 1]")
      ->type_name("E");
  app.add_option("--time-limit", settings.time_limit, "stop after so many seconds")->type_name("S");
  AddThreadsAndSkips(app, settings);
}

void AddJobClass(CLI::App& command, Raw& raw) {
  command
      .add_option_function<std::string>(
          "--class",
          [&raw](const std::string& name) {
            raw.line.job_class = static_cast<v1::JobClass>(*OptionValue(*v1::JobClass_descriptor(), name));
          },
          "what the job is for, which decides whose turn it is: interactive (default), graded or regrade")
      ->check(CLI::IsMember(OptionNames(*v1::JobClass_descriptor())))
      ->type_name("CLASS");
}

void AddSceneCommands(CLI::App& app, Raw& raw) {
  for (const char* name : {"render", "submit", "explain"}) {
    const bool render = std::string(name) == "render";
    const bool submit = std::string(name) == "submit";
    CLI::App& command = AddCommand(app, name,
                                   render   ? "render a scene and wait for the result"
                                   : submit ? "start a job on a server"
                                            : "show the plan for a scene, with reasons and expected cost",
                                   render   ? kRenderHelp
                                   : submit ? kSubmitHelp
                                            : kExplainHelp);
    AddScene(command, raw);
    command.add_option("--picture", raw.picture, "a picture of the light in the whole scene, in place of its probes")
        ->type_name("WxH");
    AddSettings(command, raw);
    if (render || submit) {
      command
          .add_option("--records", raw.line.known_records,
                      "begin with the records of a result (JSON) or of an ended job of the server (jobs/UUID)")
          ->type_name("FILE");
      command.add_flag("--anew", raw.line.anew, "do the work, also if an equal job of the server has done it");
    }
    if (render) AddCancelOnDisconnect(command, raw);
    if (render) AddOutputs(command, raw);
    if (submit) {
      AddJobClass(command, raw);
      command
          .add_option("--webhook", raw.line.webhook,
                      "the server sends this URL a signed POST when the job has ended (see webhook-secret)")
          ->type_name("URL");
    }
    AddJson(command, raw, render ? "the result" : submit ? "the job" : "the plan");
    if (render || submit) AddQuiet(command, raw);
    AddServer(command, raw);
  }
  CLI::App& validate = AddCommand(app, "validate", "report every mistake of a scene");
  AddScene(validate, raw);
  AddJson(validate, raw, "the report");
  AddQuiet(validate, raw);
  AddServer(validate, raw);
  CLI::App& scenes = AddCommand(app, "scenes", "list the gallery and uploaded scenes, or print one", kScenesHelp);
  CLI::Option& name = *scenes.add_option("NAME", raw.line.scene, "print this scene file");
  scenes.add_flag("--delete", raw.line.remove, "delete the upload NAME (a hash, or the beginning of one) instead")
      ->needs(&name);
  CLI::Option& mine = *scenes.add_flag("--mine", raw.line.mine, "list your own uploads alone");
  CLI::Option& shared = *scenes.add_flag("--shared", raw.line.shared, "list those that others share with you");
  mine.excludes(&name, &shared);
  shared.excludes(&name);
  AddJson(scenes, raw, "the list");
  AddServer(scenes, raw);
}

void AddGrantees(CLI::App& command, Raw& raw) {
  command.add_option("--with", raw.line.grantees, "user:NAME, group:NAME or course (everybody); may be repeated")
      ->required()
      ->type_name("WHOM")
      ->allow_extra_args(false);
}

void AddSharing(CLI::App& app, Raw& raw) {
  for (const auto& [name, what] :
       {std::pair("share", "let others see a job or a scene"), std::pair("unshare", "end that")}) {
    const bool share = std::string(name) == "share";
    CLI::App& command = AddCommand(app, name, what, kShareHelp);
    command.add_option("WHAT", raw.line.job, "a job, or scenes/HASH")->required();
    AddGrantees(command, raw);
    if (share)
      command.add_flag("--control", raw.line.control,
                       "they may also cancel, pause and resume the job; delete the scene");
    AddJson(command, raw, "the job or the scene");
    AddQuiet(command, raw);
    AddServer(command, raw);
  }
}

void AddJobCommands(CLI::App& app, Raw& raw) {
  CLI::App& watch = AddCommand(app, "watch", "follow a job until it has ended", kWatchHelp);
  AddJob(watch, raw);
  AddJson(watch, raw, "the ended job");
  AddCancelOnDisconnect(watch, raw);
  watch.add_flag("--records", raw.line.records, "print cache records as they are made: JSON, one a line");
  AddQuiet(watch, raw);
  CLI::App& jobs = AddCommand(app, "jobs", "list the jobs of a server");
  AddJson(jobs, raw, "the list");
  CLI::Option& prune =
      *jobs.add_option("--prune", raw.prune, "delete your jobs that ended longer than AGE ago: 0, 90m, 12h, 30d");
  prune.type_name("AGE");
  CLI::Option& mine = *jobs.add_flag("--mine", raw.line.mine, "your own alone, also if you may see all");
  jobs.add_flag("--shared", raw.line.shared, "those of others that are shared with you")->excludes(&prune, &mine);
  CLI::App& top = AddCommand(app, "top", "show what a server does: jobs, users, rates", kTopHelp);
  top.add_flag("--once", raw.line.once, "show it once, in plain text");
  AddJson(top, raw, "the activity");
  CLI::App& quota = AddCommand(app, "quota", "show what you may have of a server, and what you have", kQuotaHelp);
  AddJson(quota, raw, "the same");
  CLI::App& secret = AddCommand(app, "webhook-secret",
                                "print with what webhooks of your jobs are signed; keep it secret", kSecretHelp);
  CLI::Option& rotate = *secret.add_flag("--rotate", raw.line.rotate, "make a new one, and print that");
  secret
      .add_option(
          "--keep-earlier", raw.keep,
          "with --rotate: for so long messages are signed with the earlier one too (default: 24h); 0: not at all")
      ->type_name("AGE")
      ->needs(&rotate);
  AddServer(secret, raw);
  CLI::App& health = AddCommand(app, "health", "ask a server whether it serves; needs no token", kHealthHelp);
  AddQuiet(health, raw);
  AddServer(health, raw);
  CLI::App& show = AddCommand(app, "show", "show a job", kJobHelp);
  AddJob(show, raw);
  AddJson(show, raw, "the job");
  CLI::App& fetch = AddCommand(app, "fetch", "get the result of an ended job", kFetchHelp);
  AddJob(fetch, raw);
  AddOutputs(fetch, raw);
  AddJson(fetch, raw, "the result");
  AddQuiet(fetch, raw);
  for (const auto& [name, what] :
       {std::pair("cancel", "stop a job"), std::pair("pause", "let a job rest; its time limit rests too"),
        std::pair("resume", "let a paused job go on")}) {
    CLI::App& control = AddCommand(app, name, what, kJobHelp);
    AddJob(control, raw);
    AddJson(control, raw, "the job");
    AddQuiet(control, raw);
    AddServer(control, raw);
  }
  for (CLI::App* command : {&watch, &jobs, &top, &quota, &show, &fetch}) AddServer(*command, raw);
  AddSharing(app, raw);
}

void AddRoomCommands(CLI::App& app, Raw& raw) {
  CLI::App& rooms = AddCommand(app, "room", "review a job together: one shows, all write notes", kRoomHelp);
  rooms.require_subcommand(1);
  const auto add = [&](const std::string& name, const std::string& what, bool of_room = true) -> CLI::App& {
    CLI::App& command = AddCommand(rooms, name, what);
    if (of_room) command.add_option("ROOM", raw.room.room, "rooms/UUID, the UUID, or its beginning")->required();
    AddServer(command, raw);
    return command;
  };
  CLI::App& create = add("create", "make a room", false);
  create.add_option("TITLE", raw.room.title, "what it is about")->required();
  CLI::App& list = add("list", "list the rooms that you may enter", false);
  CLI::App& show = add("show", "show a room and its notes");
  CLI::App& watch = add("watch", "follow a room until it is closed");
  watch.add_flag("--json", raw.line.json, "print each update as a line of JSON");
  CLI::App& note = add("note", "write a note");
  note.add_option("TEXT", raw.room.text, "the note")->required();
  note.add_option("--at", raw.room.at, "a place in the scene, in m")->type_name("X,Y");
  CLI::App& look = add("look", "change what all look at; what is not given stays");
  look.add_option("--job", raw.room.job, "a job that you may share; empty: none")->type_name("JOB");
  look.add_option("--probe", raw.room.probe, "one of its probes; empty: all")->type_name("NAME");
  look.add_option("--point", raw.room.point, "one of the probe's points, from 0")->type_name("N");
  look.add_option("--exposure", raw.room.exposure, "stops, -32 to 32")->type_name("S");
  look.add_option("--tone-mapping", raw.room.tone_mapping, "photographic or linear")->type_name("NAME");
  CLI::App& share = add("share", "let others in");
  CLI::App& unshare = add("unshare", "end that");
  for (CLI::App* command : {&share, &unshare}) AddGrantees(*command, raw);
  share.add_flag("--control", raw.line.control, "they may also change what is looked at");
  CLI::App& close = add("close", "end a room: it can be read, and nothing more");
  for (CLI::App* command : {&create, &share, &unshare, &look, &close}) AddJson(*command, raw, "the room");
  AddJson(list, raw, "the list");
  AddJson(show, raw, "room and notes");
  AddJson(note, raw, "the note");
  add("delete", "remove a room with its notes");
}

void AddCompare(CLI::App& app, Raw& raw) {
  CLI::App& compare = AddCommand(app, "compare", "error of one result against another", kCompareHelp);
  compare.add_option("RESULTS", raw.line.results, "A and B: two results in JSON form")->required()->expected(2);
  compare.add_option("--tolerance", raw.tolerance, "the largest relative difference")->type_name("X");
  AddJson(compare, raw, "the report");
  AddQuiet(compare, raw);
}

void AddFigure(CLI::App& app, Raw& raw) {
  CLI::App& figure =
      AddCommand(app, "figure", "repeat an experiment of the papers: key numbers, CSV, plot", kFigureHelp);
  figure.add_option("NAME", raw.line.figure, "one of those below")->required();
  figure.add_option("--samples", raw.settings.samples, "first rays a point (default 256)")->type_name("N");
  figure.add_option("--photons", raw.settings.photons, "of photon-map (default 100)")->type_name("N");
  figure.add_option("--seed", raw.settings.seed, "another seed (default 0)")->type_name("N");
  AddOutputs(figure, raw);
  AddJson(figure, raw, "the figure's data");
  AddQuiet(figure, raw);
  AddServer(figure, raw);
}

void AddBenchCompare(CLI::App& bench, Raw& raw) {
  CLI::App& compare =
      AddCommand(bench, "compare", "one benchmark against another, with the noise of both", kBenchCompareHelp);
  compare.add_option("BENCHES", raw.line.results, "A.csv and B.csv: two benchmarks")->required()->expected(2);
  compare.add_option("--least", raw.bench.least, "the smallest relative change that counts (default 0.05)")
      ->type_name("X");
  AddJson(compare, raw, "the report");
  AddQuiet(compare, raw);
}

void AddBench(CLI::App& app, Raw& raw) {
  CLI::App& bench = AddCommand(app, "bench", "run time against error of methods, scenes and budgets", kBenchHelp);
  BenchTexts& texts = raw.bench;
  SettingsOptions& settings = raw.settings;
  bench.add_option("SCENE", texts.scenes, "scene files or gallery:NAME");
  bench.add_flag("--gallery", texts.gallery, "all scenes of the gallery");
  bench.add_option("--methods", texts.methods, "exact,path-tracing,... (default: all the server has but reference)")
      ->type_name("NAMES");
  bench.add_option("--budgets", texts.budgets, "samples: 16,64,256,... (default: from 16 up, as time allows)")
      ->type_name("LIST");
  bench.add_option("--seeds", texts.seeds, "independent runs of a point (default 16)")->type_name("N");
  bench.add_option("--repeats", texts.repeats, "runs of each seed, for its time (default 1)")->type_name("N");
  bench
      .add_option("--time-limit", texts.time_limit,
                  "seconds for all runs together (default 60; none if --budgets is given)")
      ->type_name("S");
  bench.add_option("--truth", texts.truths, "a result to measure errors against; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  bench.add_option("--truth-samples", texts.truth_samples, "path tracing with so many samples is the truth")
      ->type_name("N");
  AddOutputs(bench, raw);
  bench.add_flag("--force", texts.force, "go on with a CSV file of another machine, build or other settings");
  AddBounces(bench, settings);
  bench.add_option("--seed", settings.seed, "other seeds (default 0)")->type_name("N");
  AddDerivatives(bench, settings);
  AddFormulation(bench, settings);
  AddThreadsAndSkips(bench, settings);
  AddJson(bench, raw, "the report");
  AddQuiet(bench, raw);
  AddServer(bench, raw);
  AddBenchCompare(bench, raw);
}

absl::StatusOr<CommandLine> Finish(const CLI::App& app, Raw& raw) {
  const CLI::App& command = *app.get_subcommands().front();
  raw.line.command = command.get_name();
  for (const CLI::App* part : command.get_subcommands()) raw.line.command += ' ' + part->get_name();
  absl::StatusOr<BenchOptions> bench = ParseBenchOptions(raw.bench);
  if (!bench.ok()) return bench.status();
  raw.line.bench = *std::move(bench);
  absl::StatusOr<RoomOptions> room = ParseRoomOptions(raw.room);
  if (!room.ok()) return room.status();
  raw.line.room = *std::move(room);
  absl::StatusOr<v1::Settings> settings = ParseSettings(raw.settings);
  if (!settings.ok()) return settings.status();
  if (raw.picture) {
    absl::StatusOr<v1::Probe> picture = ParsePicture(*raw.picture);
    if (!picture.ok()) return picture.status();
    raw.line.probes.push_back(*std::move(picture));
  }
  raw.line.settings = *std::move(settings);
  if (raw.server) {
    if (raw.server->empty()) return UsageError("--server: ''; must be HOST:PORT or unix:PATH");
    raw.line.server = *raw.server;
  }
  if (raw.prune) {
    const auto age = ParseAge("--prune", *raw.prune);
    if (!age.ok()) return age.status();
    raw.line.prune_seconds = *age;
  }
  if (raw.keep) {
    const auto age = ParseAge("--keep-earlier", *raw.keep);
    if (!age.ok()) return age.status();
    raw.line.keep_seconds = *age;
  }
  if (raw.tolerance) {
    const auto tolerance =
        ParseNumber("--tolerance", *raw.tolerance, Zero::kAllowed, std::numeric_limits<double>::max());
    if (!tolerance.ok()) return tolerance.status();
    raw.line.tolerance = *tolerance;
  }
  return raw.line;
}

}  // namespace

absl::StatusOr<CommandLine> ParseCommandLine(int argc, const char* const* argv, const std::string& version) {
  Raw raw;
  raw.line.version = version;
  CLI::App app("Flatlight: global illumination in the plane, with the error of every number.", "flatlight");
  app.get_formatter()->column_width(28);
  app.require_subcommand(1);
  app.footer(kMainHelp);
  app.set_version_flag("--version", "flatlight " + version, "print the version");
  AddServer(app, raw);
  AddSceneCommands(app, raw);
  AddJobCommands(app, raw);
  AddRoomCommands(app, raw);
  AddCompare(app, raw);
  AddFigure(app, raw);
  AddBench(app, raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, errors;
    if (app.exit(error, out, errors) == 0) {
      raw.line.text = out.str();
      return raw.line;
    }
    const auto chosen = app.get_subcommands();
    const std::string command = chosen.empty() ? "" : " " + chosen.front()->get_name();
    if (chosen.empty() && argc > 1 && argv[1][0] != '-')
      return UsageError("'" + std::string(argv[1]) + "' is not a command; see flatlight --help");
    if (chosen.empty() && argc < 2) return UsageError("a command is needed; see flatlight --help");
    return UsageError(std::string(error.what()) + "; see flatlight" + command + " --help");
  }
  return Finish(app, raw);
}

}  // namespace flatlight
