// SPDX-License-Identifier: Apache-2.0
// A result as comma-separated values (RFC 4180): a header, then a row a point.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_CSV_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_CSV_H_

#include <functional>
#include <string>

#include "flatlight/v1/result.pb.h"

namespace flatlight {

// Columns: probe (name), index (from 0 in each probe), then those of AllResultColumns() that the result has. A coloured
// result has irradianceR, irradianceG, irradianceB instead of irradiance, and so on. Numbers have the digits they need
// to be read back exactly; what a probe does not have is empty.
// Ends early, with what is there, when `stop` says so; it is asked every few thousand points.
std::string ResultToCsv(const v1::RenderResult& result, const std::function<bool()>& stop);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_CSV_H_
