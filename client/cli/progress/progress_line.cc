// SPDX-License-Identifier: Apache-2.0
#include "client/cli/progress/progress_line.h"

#include <algorithm>
#include <cmath>

#include "client/cli/formats/timestamp.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr std::size_t kBarWidth = 24;

double Fraction(const v1::Progress& progress) {
  return std::isfinite(progress.fraction()) ? std::clamp(progress.fraction(), 0.0, 1.0) : 0;
}

std::string Bar(double fraction) {
  const auto done = static_cast<std::size_t>(fraction * kBarWidth);
  return "[" + std::string(done, '#') + std::string(kBarWidth - done, '-') + "]";
}

// Whole percents, of which 100 is kept for the end.
std::string Percent(const v1::Job& job) {
  const int percent = static_cast<int>(100 * Fraction(job.progress()));
  const std::string text = std::to_string(job.state() == v1::Job::RUNNING ? std::min(percent, 99) : percent);
  return std::string(3 - std::min<std::size_t>(3, text.size()), ' ') + text + " %";
}

std::string Details(const v1::Job& job) {
  const v1::Progress& progress = job.progress();
  std::string text;
  if (progress.has_relative_error()) text += "  error " + FormatPercent(progress.relative_error());
  if (progress.records() > 0)
    text += "  " + FormatCount(progress.records()) + (progress.records() == 1 ? " record" : " records");
  if (progress.rays() > 0 && progress.elapsed_seconds() > 0)
    text += "  " + FormatCount(progress.rays() / progress.elapsed_seconds()) + " rays/s";
  if (progress.has_remaining_seconds() && job.state() == v1::Job::RUNNING)
    text += "  " + FormatSeconds(progress.remaining_seconds()) + " left";
  return text;
}

std::string QueueText(const v1::Job& job) {
  if (!job.has_queue()) return "waiting for its turn";
  if (job.queue().reason() == v1::QueuePlace::DAY_USED_UP) {
    return "rests: today's processor time is used up; goes on in " +
           FormatSeconds(std::max(0.0, SecondsOf(job.queue().expected_start()) - SecondsNow()));
  }
  std::string text = job.queue().reason() == v1::QueuePlace::OWN_JOBS ? "waiting for jobs of the same owner"
                                                                      : "waiting: the server is full";
  text += ", " + (job.queue().ahead() > 0 ? FormatExactly(job.queue().ahead()) + " ahead" : std::string("next"));
  if (job.queue().has_expected_start()) {
    const double wait = SecondsOf(job.queue().expected_start()) - SecondsNow();
    text += ", begins in about " + FormatSeconds(std::max(0.0, wait));
  }
  return text;
}

}  // namespace

std::string ProgressLine(const v1::Job& job, std::size_t width) {
  const std::string scene = job.scene().empty() ? job.name() : Printable(job.scene());
  if (job.state() == v1::Job::QUEUED) {
    const std::string line = scene + "  " + QueueText(job);
    return width == 0 ? line : CutToWidth(line, width);
  }
  const std::string rest = Percent(job) + Details(job) + (job.state() == v1::Job::PAUSED ? "  paused" : "");
  if (width == 0) return scene + " " + rest;
  const std::string with_bar = scene + " " + Bar(Fraction(job.progress())) + " " + rest;
  return TextWidth(with_bar) <= width ? with_bar : CutToWidth(scene + " " + rest, width);
}

}  // namespace flatlight
