// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/npy.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include "client/cli/formats/result_columns.h"

namespace flatlight {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says '<'");

template <class Number>
void Append(Number value, std::string& out) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

// Magic, version, length and a Python dictionary, padded so that the data start at a multiple of 64.
std::string Header(const std::string& fields, std::size_t rows) {
  constexpr std::size_t kFixed = 10;
  std::string text = "{'descr': [" + fields + "], 'fortran_order': False, 'shape': (" + std::to_string(rows) + ",), }";
  text.append(63 - (kFixed + text.size()) % 64, ' ');
  text += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  Append(static_cast<std::uint16_t>(text.size()), header);
  return header + text;
}

}  // namespace

std::string ResultToNpy(const v1::RenderResult& result, const std::function<bool()>& stop) {
  const std::vector<ResultColumn> columns = ResultColumnsOf(result);
  const int channels = ResultChannels(result);
  std::string fields = "('probe', '<i4'), ('index', '<i4')";
  for (const ResultColumn& column : columns)
    fields += ", ('" + column.name + "', '<f8'" + (column.spectral() && channels == 3 ? ", (3,)" : "") + ")";

  std::size_t rows = 0;
  for (const v1::ProbeResult& probe : result.probes()) rows += probe.count();
  std::string npy = Header(fields, rows);
  for (int number = 0; number < result.probes_size(); ++number) {
    const v1::ProbeResult& probe = result.probes(number);
    for (int point = 0; point < static_cast<int>(probe.count()); ++point) {
      if (point % kPointsBetweenStops == 0 && stop()) return npy;
      Append(static_cast<std::int32_t>(number), npy);
      Append(static_cast<std::int32_t>(point), npy);
      for (const ResultColumn& column : columns)
        for (int channel = 0; channel < (column.spectral() ? channels : 1); ++channel)
          Append(HasValue(column, probe, point) ? ColumnValue(column, probe, point, channel)
                                                : std::numeric_limits<double>::quiet_NaN(),
                 npy);
    }
  }
  return npy;
}

}  // namespace flatlight
