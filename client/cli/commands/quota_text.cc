// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/quota_text.h"

#include <cmath>
#include <vector>

#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

using Format = std::string (*)(double value);

std::string Whole(double value) { return FormatExactly(std::round(value)); }

std::vector<std::string> Row(const std::string& name, const v1::Quota& quota, Format format, const std::string& more) {
  return {name, format(quota.used()), quota.has_limit() ? format(quota.limit()) : "no limit", more};
}

}  // namespace

std::string QuotaText(const v1::Quotas& quotas) {
  const std::string refill =
      quotas.requests_per_second() > 0 ? FormatValue(quotas.requests_per_second(), 3) + " more a second" : "";
  return Printable(quotas.user()) + ", " + Printable(quotas.role()) + "\n\n" +
         FormatTable({{"", "USED", "ALLOWED", ""},
                      Row("jobs", quotas.jobs(), Whole, "that have not ended"),
                      Row("processor time", quotas.cpu_seconds(), FormatSeconds,
                          "today; the next day begins in " + FormatSeconds(quotas.day_ends_in())),
                      Row("watches", quotas.watches(), Whole, ""),
                      Row("storage", quotas.storage_bytes(), FormatBytes, "scenes and jobs"),
                      Row("requests", quotas.requests(), Whole, refill)});
}

}  // namespace flatlight
