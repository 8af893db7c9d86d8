// SPDX-License-Identifier: Apache-2.0
// A result as a table with a row a point: what the CSV and NPY writers have in common.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_RESULT_COLUMNS_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_RESULT_COLUMNS_H_

#include <string>
#include <vector>

#include "flatlight/v1/result.pb.h"

namespace flatlight {

// How often a writer of a long table asks whether to stop.
inline constexpr int kPointsBetweenStops = 4096;

using DoubleArray = google::protobuf::RepeatedField<double>;

struct ResultColumn {
  std::string name;                                      // As in the JSON form: "arcLength".
  const DoubleArray& (*values)(const v1::ProbeResult&);  // Empty if the probe does not have it.
  int stride = 1;  // Numbers a point in the array, or 0: as many as the probe has channels.
  int offset = 0;  // Of the column's number among them.
  bool spectral() const { return stride == 0; }  // One number a channel.
};

// All columns that a result can have: x, y, nx, ny, arcLength, irradiance, standardError, gradient, gradientError,
// hessian, hessianError, samples.
const std::vector<ResultColumn>& AllResultColumns();

// Those that at least one probe of the result has.
std::vector<ResultColumn> ResultColumnsOf(const v1::RenderResult& result);

// Largest number of channels of a probe; at least 1.
int ResultChannels(const v1::RenderResult& result);

// Whether anything is known of the point: false where a time limit left it without samples.
bool IsKnown(const v1::ProbeResult& probe, int point);

// Whether the column says something of the point: all do that the probe has, but values of points that are not known.
bool HasValue(const ResultColumn& column, const v1::ProbeResult& probe, int point);

// The value at a point of a probe that has the column. A grey probe has the same value in every channel.
double ColumnValue(const ResultColumn& column, const v1::ProbeResult& probe, int point, int channel);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_RESULT_COLUMNS_H_
