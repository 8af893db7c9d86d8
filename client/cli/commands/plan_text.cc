// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/plan_text.h"

#include <vector>

#include "client/cli/formats/settings_text.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string DecisionText(v1::Plan::Skip::Decision decision) {
  switch (decision) {
    case v1::Plan::Skip::TAKEN:
      return "left out";
    case v1::Plan::Skip::DISABLED:
      return "kept by --no-skip";
    default:
      return "needed";
  }
}

Rows PassRows(const v1::Plan& plan) {
  Rows rows;
  for (const v1::Plan::Pass& pass : plan.passes()) {
    std::vector<std::string> row = {Printable(pass.name()), Plural(pass.points(), "point")};
    row.push_back(pass.samples() > 0 ? FormatExactly(pass.samples()) + " paths a point" : "");
    row.push_back(pass.expected_rays() > 0 ? "about " + FormatCount(pass.expected_rays()) + " rays" : "");
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::string ShortPlanText(const v1::Plan& plan) {
  std::string text = "plan      " + Printable(plan.summary()) + '\n';
  Rows rows;
  for (const v1::Plan::Skip& skip : plan.skips())
    if (skip.decision() == v1::Plan::Skip::TAKEN) rows.push_back({Printable(skip.name()), Printable(skip.reason())});
  if (rows.empty()) return text;
  rows[0].insert(rows[0].begin(), "left out");
  for (std::size_t i = 1; i < rows.size(); ++i) rows[i].insert(rows[i].begin(), "");
  return text + FormatTable(rows);
}

std::string PlanText(const v1::Plan& plan) {
  Rows skips;
  for (const v1::Plan::Skip& skip : plan.skips())
    skips.push_back({Printable(skip.name()), DecisionText(skip.decision()), Printable(skip.reason())});
  std::string text = Printable(plan.summary()) + "\n\nsettings\n  " + SettingsText(plan.settings()) + '\n';
  if (plan.passes_size() > 0) text += "\npasses\n" + FormatTable(PassRows(plan), "  ");
  if (!skips.empty()) text += "\nwork that can be left out\n" + FormatTable(skips, "  ");
  return text;
}

}  // namespace flatlight
