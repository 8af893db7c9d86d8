// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_APP_OPTIONS_H_
#define FLATLIGHT_SERVER_APP_OPTIONS_H_

#include <optional>
#include <string>
#include <variant>

#include "server/app/user_commands.h"
#include "server/quota/quotas.h"
#include "server/store/retention.h"
#include "server/webhook/webhook_rules.h"

namespace flatlight {

// The command line of flatlightd.
struct DaemonOptions {
  std::string listen = "127.0.0.1:7000";
  std::string tls_cert;  // PEM files; empty: no TLS.
  std::string tls_key;
  std::string tls_client_ca;  // Empty: callers need no certificate.
  int threads = 1;
  std::string token_file;          // Empty: the environment's FLATLIGHT_TOKEN, if there is one.
  std::string data;                // Empty: nothing outlives the process.
  double checkpoint_interval = 3;  // s.
  std::string back_up_to;          // A new folder: copy `data` there, and serve nothing.
  std::string restore_from;        // A backup: make `data` from it, and serve nothing.
  UserCommand user;                // Unless its action is none: do that on `data`, and serve nothing.
  std::string metrics;             // HOST:PORT for Prometheus; empty: none.
  std::string log;                 // A file of calls, or "-"; empty: none.
  QuotaTable quotas;               // What each user may have.
  Retention retention;             // How long ended jobs are kept.
  WebhookRules webhook_rules;      // Who may be told of the end of jobs.
  bool exit_with_parent = false;   // End when standard input does.
};

// The options, or the exit status of a program that is done already (help, version: 0; bad usage: 2).
std::variant<DaemonOptions, int> ParseDaemonOptions(int argc, char** argv, int processors, const std::string& version);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_APP_OPTIONS_H_
