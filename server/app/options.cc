// SPDX-License-Identifier: Apache-2.0
#include "server/app/options.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "server/store/user_store.h"

namespace flatlight {
namespace {

// An option that may repeat, of one value each time, which `set` takes or refuses. `texts` must outlive the parsing.
void AddRepeated(CLI::App& app, const std::string& name, const std::string& type, const std::string& help,
                 std::vector<std::string>& texts, const std::function<absl::Status(const std::string&)>& set) {
  app.add_option(name, texts, help)
      ->type_name(type)
      ->allow_extra_args(false)
      ->each([name, set](const std::string& text) {
        const absl::Status done = set(text);
        if (!done.ok()) throw CLI::ValidationError(name, std::string(done.message()));
      });
}

}  // namespace

std::variant<DaemonOptions, int> ParseDaemonOptions(int argc, char** argv, int processors, const std::string& version) {
  constexpr int kMaxThreads = 1024;
  constexpr int kBadUsage = 2;
  DaemonOptions options;
  options.threads = processors;
  CLI::App app("The Flatlight server: renders plane scenes and streams what it has so far.");
  app.set_version_flag("--version", "flatlightd " + version);
  app.add_option("--listen", options.listen,
                 "HOST:PORT on this machine (port 0: any free one), or unix:PATH; with TLS 0.0.0.0 and the like too")
      ->capture_default_str();
  CLI::Option* tls_cert = app.add_option("--tls-cert", options.tls_cert,
                                         "speak TLS: a PEM file with the server's certificate and those between it and "
                                         "its root; replaced files are taken while the server runs");
  CLI::Option* tls_key = app.add_option("--tls-key", options.tls_key, "the certificate's private key, a PEM file");
  CLI::Option* tls_client_ca =
      app.add_option("--tls-client-ca", options.tls_client_ca,
                     "a PEM file: callers must show a certificate that one of these has signed (mTLS)");
  for (CLI::Option* file : {tls_cert, tls_key, tls_client_ca}) {
    file->check([](const std::string& path) { return path.empty() ? "a file is needed" : ""; });
  }
  tls_cert->needs(tls_key);
  tls_key->needs(tls_cert);
  tls_client_ca->needs(tls_cert);
  app.add_option("--threads", options.threads, "threads for rendering")
      ->capture_default_str()
      ->check(CLI::Range(1, kMaxThreads));
  app.add_option("--token-file", options.token_file,
                 "a file holding the token that callers must present; default: the variable FLATLIGHT_TOKEN, or none");
  app.add_option("--data", options.data,
                 "a folder for jobs, results and scenes, made if it is missing; default: they end with the server");
  app.add_option("--checkpoint-interval", options.checkpoint_interval,
                 "seconds between checkpoints of a job, at least (with --data)")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 3600.0));
  app.add_option("--metrics", options.metrics,
                 "HOST:PORT on this machine: serve metrics for Prometheus at http://HOST:PORT/metrics");
  app.add_option("--log", options.log, "a file that gets a line of JSON for each call, or - for standard error");
  std::vector<std::string> quotas, keep, webhook_hosts;
  AddRepeated(app, "--quota", "ROLE.LIMIT=VALUE",
              "what each user of a role may have, as student.jobs=50 or grader.watches=none; may repeat. Limits: " +
                  QuotaNames(),
              quotas, [&options](const std::string& text) { return options.quotas.Set(text); });
  AddRepeated(app, "--keep", "CLASS=DURATION",
              "how long ended jobs of a class (interactive, graded, regrade) are kept, as interactive=7d or "
              "graded=none (for ever); may repeat; default: interactive=30d, the others for ever",
              keep, [&options](const std::string& text) { return options.retention.Set(text); });
  AddRepeated(app, "--webhook-allow", "HOST[:PORT]",
              "a host that may be told of the end of jobs (ports 80 and 443, or the one given); may repeat; default: "
              "none. A name must stand for a public address, or for one that is itself allowed so",
              webhook_hosts, [&options](const std::string& text) { return options.webhook_rules.Allow(text); });
  app.add_flag("--exit-with-parent", options.exit_with_parent, "end when standard input ends");
  CLI::App* backup =
      app.add_subcommand("backup", "copy the folder of a server, which may be running: --data DIR BACKUP");
  backup->add_option("BACKUP", options.back_up_to, "a new folder")->required();
  CLI::App* restore = app.add_subcommand("restore", "make a new folder from a backup: --data DIR BACKUP");
  restore->add_option("BACKUP", options.restore_from, "what backup made")->required();
  CLI::App* user = app.add_subcommand(
      "user", "who may use a server, which may be running: with its first user it asks everybody for a token");
  user->require_subcommand(1);
  CLI::App* add = user->add_subcommand("add", "add a user, or those of a roster, and print their tokens, this once");
  CLI::Option* name = add->add_option("NAME", options.user.name, "1 to 64 of a-z, 0-9 and . _ - @");
  CLI::Option* role = add->add_option("--role", options.user.role, "what the user may do")
                          ->default_str(std::string(RoleName(Role::kStudent)))
                          ->check(CLI::IsMember(RoleNames()));
  CLI::Option* group = add->add_option("--group", options.user.groups, "a group that the user is in; may repeat")
                           ->allow_extra_args(false);
  CLI::Option* roster = add->add_option("--roster", options.user.roster,
                                        "a CSV file of users: the columns name and, if wanted, role and groups (a;b)");
  for (CLI::Option* of_one : {name, role, group}) roster->excludes(of_one);
  add->callback([&options, name, roster] {
    options.user.action = UserCommand::Action::kAdd;
    if (name->empty() && roster->empty()) throw CLI::RequiredError("NAME or --roster");
  });
  CLI::App* list = user->add_subcommand("list", "print the users as CSV, without their tokens");
  list->callback([&options] { options.user.action = UserCommand::Action::kList; });
  CLI::App* revoke = user->add_subcommand("revoke", "make a user's token worth nothing, at once");
  revoke->add_option("NAME", options.user.name, "of the user")->required();
  revoke->callback([&options] { options.user.action = UserCommand::Action::kRevoke; });
  for (CLI::App* command : {add, list, revoke}) command->fallthrough();
  for (CLI::App* command : {backup, restore, user}) {
    command->fallthrough();
    command->final_callback([&options] {
      if (options.data.empty()) throw CLI::RequiredError("--data");
    });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadUsage;
  }
  return options;
}

}  // namespace flatlight
