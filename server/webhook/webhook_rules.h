// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_RULES_H_
#define FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_RULES_H_

#include <sys/socket.h>

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace flatlight {

// Where webhooks may go: to hosts that the server's keeper has named, and from there no further. So that nobody makes
// the server ask what only it can reach (server-side request forgery).
class WebhookRules {
 public:
  // "HOST" (of http port 80, of https 443) or "HOST:PORT"; an IPv6 address stands in brackets. INVALID_ARGUMENT.
  absl::Status Allow(const std::string& text);

  // Whether a job may name this URL. FAILED_PRECONDITION with WEBHOOKS_OFF if no host is allowed; else
  // INVALID_ARGUMENT: allowed are at most 2048 printable ASCII characters, http or https, no user or password, no
  // fragment, a host of Allow.
  absl::Status Check(const std::string& url) const;
  // Whether what a host's name stands for may be connected to: addresses of the public internet (RFC 6890), and others
  // that Allow has named themselves. Names are looked up only when something is sent, by whoever answers for them.
  bool AllowsAddress(const sockaddr& address) const;

  // As Allow was given them.
  const std::vector<std::string>& hosts() const { return hosts_; }

 private:
  struct Host {
    std::string name;         // Lower case; addresses as inet_ntop writes them.
    std::optional<int> port;  // Absent: 80 and 443, as the scheme has it.
  };
  bool Allows(const std::string& host, int port, int usual_port) const;

  std::vector<std::string> hosts_;
  std::vector<Host> allowed_;
};

// Of a URL, without brackets; empty if it is none.
std::string WebhookHost(const std::string& url);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_RULES_H_
