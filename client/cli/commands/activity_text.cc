// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/activity_text.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "client/cli/formats/enum_names.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr std::size_t kUserColumns = 12;

// Right-aligned in its column.
std::string Right(const std::string& text, std::size_t width) {
  const std::size_t taken = TextWidth(text);
  return taken < width ? std::string(width - taken, ' ') + text : text;
}

std::string Count(double value) { return FormatCount(value); }

std::string StateText(const v1::Job& job) {
  if (job.queue().reason() == v1::QueuePlace::DAY_USED_UP) return "tomorrow";
  if (job.state() == v1::Job::QUEUED && job.has_queue()) return Count(job.queue().ahead()) + " ahead";
  return OptionName(job.state());
}

using RaysOf = std::map<std::string, double>;

std::string JobTable(const v1::GetActivityResponse& now, const RaysOf& rays_before, double seconds) {
  std::vector<std::vector<std::string>> rows = {
      {"JOB", "USER", "CLASS", "STATE", " DONE", "  TIME", "  RAYS/S", "SCENE", "METHOD"}};
  for (const v1::JobActivity& activity : now.jobs()) {
    const v1::Job& job = activity.job();
    const auto before = rays_before.find(job.name());
    const double rays = before == rays_before.end() ? 0 : std::max(0.0, job.progress().rays() - before->second);
    rows.push_back({job.name().substr(job.name().find('/') + 1, 8),
                    CutToWidth(Printable(activity.owner()), kUserColumns), OptionName(job.job_class()), StateText(job),
                    Right(std::to_string(static_cast<int>(100 * job.progress().fraction())) + " %", 5),
                    Right(FormatSeconds(job.progress().elapsed_seconds()), 6),
                    Right(seconds > 0 && rays > 0 ? Count(rays / seconds) : "-", 8), Printable(job.scene()),
                    OptionName(activity.method())});
  }
  return FormatTable(rows);
}

std::string UserTable(const v1::GetActivityResponse& now) {
  std::vector<std::vector<std::string>> rows = {{"USER", "RUNNING", "WAITING", "PAUSED", "    TIME"}};
  for (const v1::UserActivity& user : now.users()) {
    rows.push_back({CutToWidth(Printable(user.user()), 24), Right(std::to_string(user.running()), 7),
                    Right(std::to_string(user.waiting()), 7), Right(std::to_string(user.paused()), 6),
                    Right(FormatSeconds(user.cpu_seconds()), 8)});
  }
  return FormatTable(rows);
}

}  // namespace

std::string ActivityText(const std::string& server, const v1::GetCapabilitiesResponse& capabilities,
                         const v1::GetActivityResponse& before, const v1::GetActivityResponse& now, std::size_t width,
                         std::size_t height) {
  const double seconds = now.uptime_seconds() - before.uptime_seconds();
  const auto rate = [&](double a, double b) { return seconds > 0 ? std::max(0.0, (b - a) / seconds) : 0; };
  double running = 0;
  double waiting = 0;
  double paused = 0;
  for (const v1::UserActivity& user : now.users()) {
    running += user.running();
    waiting += user.waiting();
    paused += user.paused();
  }
  RaysOf rays_before;
  for (const v1::JobActivity& job : before.jobs()) rays_before[job.job().name()] = job.job().progress().rays();

  std::string text = "flatlightd " + Printable(capabilities.version()) + " at " + Printable(server) + ", up " +
                     FormatSeconds(now.uptime_seconds()) + '\n';
  text +=
      FormatTable({{"jobs", Count(running) + " running, " + Count(waiting) + " waiting, " + Count(paused) +
                                " paused; " + Count(now.watches()) + (now.watches() == 1 ? " watch" : " watches")},
                   {"work", Count(rate(before.rays(), now.rays())) + " rays/s on " +
                                FormatFixed(rate(before.job_cpu_seconds(), now.job_cpu_seconds()), 2) + " of " +
                                Plural(capabilities.processors(), "processor") + "; all else takes " +
                                FormatFixed(std::max(0.0, rate(before.cpu_seconds(), now.cpu_seconds()) -
                                                              rate(before.job_cpu_seconds(), now.job_cpu_seconds())),
                                            2)},
                   {"memory", FormatBytes(now.resident_bytes())}});
  if (now.users_size() > 0) text += '\n' + UserTable(now);
  if (now.jobs_size() > 0) text += '\n' + JobTable(now, rays_before, seconds);
  const double unnamed = running + waiting + paused - now.jobs_size();
  if (unnamed > 0) text += "and " + Plural(unnamed, "other job") + '\n';

  std::istringstream lines(text);
  std::string fitting;
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line) && (height == 0 || count < height); ++count) {
    fitting += CutToWidth(line, width) + '\n';
  }
  return fitting;
}

}  // namespace flatlight
