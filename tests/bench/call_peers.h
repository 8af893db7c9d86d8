// SPDX-License-Identifier: Apache-2.0
// What benches of calls measure a flatlightd with users against: a server of the bench itself that does nothing.
#ifndef FLATLIGHT_TESTS_BENCH_CALL_PEERS_H_
#define FLATLIGHT_TESTS_BENCH_CALL_PEERS_H_

#include <sys/types.h>

#include <string>
#include <vector>

#include "tests/bench/bench_daemon.h"

namespace flatlight {

// If this program was started as BenchDaemon starts a server (PROGRAM --listen ADDRESS ...): serves GetCapabilities,
// each answered at once by an empty message, without interceptors, tokens or work, until its standard input ends.
// Returns the exit status; -1: it was started otherwise.
int MaybeServeEcho(int argc, char** argv);

// An echo server of this program, and a flatlightd with a folder and one user, both on Unix sockets.
class CallPeers {
 public:
  // `self`: argv[0] of the bench. `requests`: how many a second, in the long run, the user may make.
  CallPeers(const std::string& self, int requests);

  BenchDaemon& echo() { return echo_; }
  BenchDaemon& daemon() { return daemon_; }
  // "Bearer TOKEN" of the user, a student.
  const std::string& authorization() const { return authorization_; }
  // Of that user, in a state that does not change any more.
  std::string EndedJob();

 private:
  const TemporaryFolder folder_;
  const TemporaryFolder echo_folder_;
  const std::string data_;
  const std::string authorization_;
  BenchDaemon echo_;
  BenchDaemon daemon_;
};

// A row of the table of a bench of calls: the name, the number of turns, the quartiles of `rates` (calls a second, by
// turn), `more`, the median of rate over that of the empty call in the same turn (%), the goal, and whether it is met.
// For the empty call itself, whose rates are `empty_rates`: without a goal.
std::vector<std::string> CallRow(const std::string& name, const std::vector<double>& rates,
                                 const std::vector<double>& empty_rates, const std::vector<std::string>& more = {});

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_CALL_PEERS_H_
