// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/rows/row_reader.h"

#include <algorithm>

#include "client/cli/bench/rows/row_columns.h"
#include "client/cli/formats/csv_syntax.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr int kMostMistakes = 10;

class Mistakes {
 public:
  explicit Mistakes(const std::string& label) : label_(label) {}

  void Add(const CsvField& place, const std::string& what) {
    if (++count_ > kMostMistakes) return;
    lines_ += (lines_.empty() ? "" : "\n") + label_ + ": " + PlaceOf(place) + ": " + what;
  }

  absl::Status status() const {
    if (count_ == 0) return absl::OkStatus();
    const int more = count_ - kMostMistakes;
    return UsageError(more > 0 ? lines_ + "\n" + label_ + ": " + Plural(more, "more mistake") : lines_);
  }

 private:
  const std::string& label_;
  int count_ = 0;
  std::string lines_;
};

std::string Shown(const std::string& text) {
  return "'" + Printable(TextWidth(text) > 40 ? CutToWidth(text, 40) + "..." : text) + "'";
}

// For each place of the header the column, by its number; complains about what is unknown, doubled or missing.
std::vector<std::size_t> ReadHeader(const std::vector<CsvField>& header, Mistakes& mistakes) {
  std::vector<std::size_t> order;
  const std::vector<RowColumn>& columns = RowColumns();
  for (const CsvField& field : header) {
    const auto known = std::find_if(columns.begin(), columns.end(),
                                    [&field](const RowColumn& column) { return column.name == field.text; });
    const auto number = static_cast<std::size_t>(known - columns.begin());
    if (known == columns.end()) {
      mistakes.Add(field, Shown(field.text) + " is no column of a benchmark");
    } else if (std::find(order.begin(), order.end(), number) != order.end()) {
      mistakes.Add(field, "the column " + known->name + " is there twice");
    }
    order.push_back(number);
  }
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (std::find(order.begin(), order.end(), i) == order.end())
      mistakes.Add(header[0], "the column " + columns[i].name + " is missing");
  return order;
}

// Columns are read in their own order, since some rely on earlier ones.
void ReadRow(const std::vector<CsvField>& fields, const std::vector<std::size_t>& places, BenchRow& row,
             Mistakes& mistakes) {
  const std::vector<RowColumn>& columns = RowColumns();
  if (fields.size() != columns.size()) {
    mistakes.Add(fields.back(), "the row ends with value " + std::to_string(fields.size()) + "; must have " +
                                    std::to_string(columns.size()) + ", as the first line");
    return;
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const CsvField& field = fields[places[i]];
    if (!columns[i].read(row, field.text))
      mistakes.Add(field, columns[i].name + " is " + Shown(field.text) + "; must be " + columns[i].allowed);
  }
}

}  // namespace

absl::StatusOr<std::vector<BenchRow>> RowsFromCsv(const std::string& bytes, const std::string& label) {
  const auto table = ParseCsv(bytes, label);
  if (!table.ok()) return table.status();
  std::vector<BenchRow> rows;
  if (table->empty()) return rows;
  Mistakes mistakes(label);
  const std::vector<std::size_t> order = ReadHeader(table->front(), mistakes);
  if (absl::Status status = mistakes.status(); !status.ok()) return status;
  std::vector<std::size_t> places(order.size());
  for (std::size_t place = 0; place < order.size(); ++place) places[order[place]] = place;
  for (std::size_t i = 1; i < table->size(); ++i) ReadRow((*table)[i], places, rows.emplace_back(), mistakes);
  if (absl::Status status = mistakes.status(); !status.ok()) return status;
  return rows;
}

}  // namespace flatlight
